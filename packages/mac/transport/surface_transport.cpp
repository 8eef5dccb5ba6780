#include "mac/transport/surface_transport.hpp"

#include <algorithm>

#include "geometry/simplex_queries.hpp"
#include "mac/state/surface_marks.hpp"

namespace lockstep {

namespace {

/// Rays up to this length look at the simplices gathered around their start alone [cells].
constexpr double longest_short_ray = 1.5;
/// How far before a surface a ray stops [cells].
constexpr double stand_off = 1e-3;

}  // namespace

template <int dim>
SurfaceTransport<dim>::SurfaceTransport(
    const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer,
    const UsableSamples<dim>& usable, const MovingSurface<dim>& surface,
    double largest_displacement, int stencil_reach, double friction_speed)
    : lattice_(lattice),
      tracer_(tracer),
      surface_(surface),
      interpolation_(grid, lattice, usable, surface, friction_speed),
      stencil_reach_(stencil_reach) {
  if (interpolation_.nearby().empty())
    return;
  const SurfaceSnapshot<dim>& before = *surface.before;
  const SurfaceSnapshot<dim>& after = surface.after ? *surface.after : before;
  const auto& from = before.mesh().vertices;
  const auto& to = after.mesh().vertices;
  for (std::size_t v = 0; v < from.size(); ++v)
    surface_displacement_ =
        std::max(surface_displacement_, (to[v] - from[v]).norm() / grid.spacing());
  swept_.resize(before.n_simplices());
  for (int s = 0; s < before.n_simplices(); ++s) {
    swept_[s] = before.bounds(s);
    swept_[s].extend(after.bounds(s));
    swept_[s] = widened<dim>(swept_[s], 2 * interpolation_.nearby().tolerance());
  }
  short_ray_ = std::min(longest_short_ray, largest_displacement + surface_displacement_ + 0.01);
  // What a ray crosses, and the samples around it, must be clear of surfaces.
  near_ =
      mark_within(grid, before,
                  (largest_displacement + stencil_reach + surface_displacement_) * grid.spacing());
  near_tiles_.resize(grid.n_owned_tiles());
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    const auto first = near_.begin() + tile * tile_volume<dim>;
    near_tiles_[tile] = std::find(first, first + tile_volume<dim>, 1) != first + tile_volume<dim>;
  }
}

template <int dim>
void SurfaceTransport<dim>::enter(const Index<dim>& begin, const Index<dim>& end) {
  Box<dim> box;
  for (int a = 0; a < dim; ++a) {
    box.min()[a] = begin[a];
    box.max()[a] = end[a];
  }
  interpolation_.enter(
      widened<dim>(box, 0.1 + stencil_reach_ + short_ray_ + surface_displacement_));
  const Box<dim> wide = interpolation_.physical(widened<dim>(box, surface_displacement_ + 0.01));
  const Box<dim> exact = interpolation_.physical(box);
  surface_.before->touching(wide, candidates_);
  around_.clear();
  for (const int s : candidates_)
    if (swept_[s].intersects(exact))
      around_.push_back(s);
}

template <int dim>
bool SurfaceTransport<dim>::swept(const Point<dim>& x) const {
  if (around_.empty())
    return false;
  const Point<dim> position = interpolation_.physical(x);
  candidates_.clear();
  for (const int s : around_)
    if (swept_[s].contains(position))
      candidates_.push_back(s);
  if (candidates_.empty())
    return false;
  const SurfaceSnapshot<dim>& before = *surface_.before;
  const SurfaceSnapshot<dim>& after = surface_.after ? *surface_.after : before;
  const double tolerance = interpolation_.nearby().tolerance();
  for (const int s : candidates_)
    if (closest_on_simplex<dim>(before.corners(s), position).distance <= tolerance ||
        closest_on_simplex<dim>(after.corners(s), position).distance <= tolerance)
      return true;
  return surface_displacement_ > 0 && swept_over<dim>(before, after, position, candidates_);
}

template <int dim>
bool SurfaceTransport<dim>::inside(const Point<dim>& x) const {
  return !interpolation_.nearby().empty() &&
         surface_.before->inside(interpolation_.physical(x)) >= 0;
}

template <int dim>
bool SurfaceTransport<dim>::clear(const Box<dim>& points, bool during_step, int reach) const {
  const double margin = during_step ? reach + surface_displacement_ : reach;
  return !interpolation_.nearby().touches(interpolation_.physical(widened<dim>(points, margin)));
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceTransport<dim>::hit_on_way(const Point<dim>& x,
                                                                   const Point<dim>& end) const {
  const NearbySurface<dim>& nearby = interpolation_.nearby();
  const Point<dim> a = interpolation_.physical(x), b = interpolation_.physical(end);
  return (end - x).cwiseAbs().maxCoeff() <= short_ray_ ? nearby.near_hit(a, b)
                                                       : nearby.first_hit(a, b);
}

template <int dim>
Ray<dim> SurfaceTransport<dim>::trace(const Point<dim>& x, std::optional<SurfacePoint<dim>>& hit) {
  interpolation_.look_around(x, short_ray_);
  const double scale = tracer_.cells_per_velocity();
  Point<dim> displacement = scale * interpolation_.velocity_at(x, tracer_.velocity());
  Ray<dim> half;
  half.end = x - 0.5 * displacement;
  tracer_.clip(x, half);
  if (!hit_on_way(x, half.end)) {
    const bool is_long = (half.end - x).cwiseAbs().maxCoeff() > short_ray_;
    if (is_long)
      interpolation_.look_around(half.end);
    displacement = scale * interpolation_.velocity_at(half.end, tracer_.velocity());
    if (is_long)
      interpolation_.look_around(x, short_ray_);
  }
  Ray<dim> ray;
  ray.middle = half.end;
  ray.end = x - displacement;
  tracer_.clip(x, ray);
  hit = hit_on_way(x, ray.end);
  if (hit) {
    const double length = hit->fraction * (ray.end - x).norm();
    const double stop = std::max(length - stand_off, 0.5 * length);
    if (length > 0)
      ray.end = x + (hit->fraction * stop / length) * (ray.end - x);
    else
      ray.end = x;
    ray.inflow_axis = -1;
    ray.inflow_share = 0;
  }
  return ray;
}

template <int dim>
std::optional<double> SurfaceTransport<dim>::look_up(const CarriedField<dim>& field,
                                                     const Point<dim>& x) {
  return field.kind == cell_centers ? interpolation_.scalar(x, field.values)
                                    : interpolation_.velocity(field.kind, x, field.velocity);
}

template <int dim>
std::optional<double> SurfaceTransport<dim>::carry(const CarriedField<dim>& field,
                                                   const Point<dim>& x) {
  std::optional<SurfacePoint<dim>> hit;
  const Ray<dim> ray = trace(x, hit);
  return fetch(field, x, ray, hit);
}

template <int dim>
std::optional<double> SurfaceTransport<dim>::fetch(const CarriedField<dim>& field,
                                                   const Point<dim>& x, Ray<dim> ray,
                                                   const std::optional<SurfacePoint<dim>>& hit) {
  if (!hit)
    tracer_.mix_inflow(field.kind, ray);
  if (ray.inflow_share > 0 && ray.inflow_share < 1) {
    Point<dim> entry = ray.end;
    entry[ray.inflow_axis] = ray.inflow_side * lattice_.n_cells()[ray.inflow_axis];
    if (hit_on_way(ray.end, entry))
      ray.inflow_share = 0;
  }
  if (ray.inflow_share == 1)
    return field.inflow(ray);
  const bool is_long = (ray.end - x).cwiseAbs().maxCoeff() > short_ray_;
  if (is_long)
    interpolation_.look_around(ray.end);
  auto value = look_up(field, ray.end);
  if (value && ray.inflow_share > 0)
    *value += ray.inflow_share * (field.inflow(ray) - *value);
  if (value)
    return value;
  if (is_long)
    interpolation_.look_around(x);
  value = look_up(field, x);
  if (!value && hit && field.kind != cell_centers)
    value = surface_.velocity(*hit)[field.kind];
  return value;
}

template <int dim>
double SurfaceTransport<dim>::carry_beside(const CarriedField<dim>& field, const Point<dim>& x,
                                           double own) {
  std::optional<SurfacePoint<dim>> hit;
  const Ray<dim> ray = trace(x, hit);
  const auto carried = fetch(field, x, ray, hit);
  interpolation_.look_around(x);
  const auto seen = look_up(field, x);
  // In a gap that no sample sees, what flows comes to rest at the surface.
  const double here = seen ? *seen : interpolation_.nearest_surface_velocity(x)[field.kind];
  const double way =
      std::max((ray.end - x).norm(), tracer_.cells_per_velocity() * std::abs(own - here));
  return (carried ? *carried : here) + std::max(0.0, 1 - way) * (own - here);
}

template class SurfaceTransport<2>;
template class SurfaceTransport<3>;

}  // namespace lockstep
