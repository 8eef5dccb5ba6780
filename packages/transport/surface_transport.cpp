#include "transport/surface_transport.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/simplex_queries.hpp"
#include "transport/largest_move.hpp"

namespace lockstep {

namespace {

/// Distance before a surface at which a ray stops [cells].
constexpr double stand_off = 1e-3;
/// Distance from a surface that followed points keep [cells].
constexpr double clearance_of_rays = 0.1;

}  // namespace

template <int dim>
SurfaceTransport<dim>::SurfaceTransport(const TiledGrid<dim>& grid, const RayTracer<dim>& tracer,
                                        const UsableSamples<dim>& usable,
                                        const MovingSurface<dim>& surface, KeptSurface<dim>& kept,
                                        const RayExtent& rays)
    : lattice_(tracer.lattice()),
      tracer_(tracer),
      surface_(surface),
      surface_displacement_(largest_move(surface) / grid.spacing()),
      // The way of a ray, and the samples around it, must be clear of surfaces.
      near_reach_(
          cells_reached(rays.largest_displacement + rays.stencil_reach + surface_displacement_)),
      interpolation_(grid, lattice_, usable, surface, rays.friction_speed,
                     kept.of(surface.before, grid, near_reach_ + 2)) {
  if (interpolation_.nearby().empty())
    return;
  const SurfaceSnapshot<dim>& before = *surface.before;
  const SurfaceSnapshot<dim>& after = surface.after ? *surface.after : before;
  Box<dim> region;
  swept_.reserve(before.n_simplices());
  for (int s = 0; s < before.n_simplices(); ++s) {
    const Box<dim> both = before.bounds(s).merged(after.bounds(s));
    swept_.push_back(widened<dim>(both, 2 * interpolation_.nearby().tolerance()));
    region.extend(swept_.back());
  }
  swept_bins_.build(swept_, region.intersection(interpolation_.nearby().reached()), grid.lower(),
                    0.5 * grid.spacing(), [](int, const Point<dim>&) { return true; });
}

template <int dim>
bool SurfaceTransport<dim>::within(const Point<dim>& x, int reach) const {
  const NearbySurface<dim>& nearby = interpolation_.nearby();
  if (nearby.empty())
    return false;
  Index<dim> cell;
  for (int a = 0; a < dim; ++a)
    cell[a] = static_cast<int>(std::floor(x[a]));
  return reach > NearbySurface<dim>::longest_reach || nearby.cells_to(cell) <= reach;
}

template <int dim>
bool SurfaceTransport<dim>::is_near_tile(const Index<dim>& tile_begin) const {
  Point<dim> x;
  for (int cell = 0; cell < tile_volume<dim>; ++cell) {
    for (int a = 0, rest = cell; a < dim; ++a, rest /= tile_width<dim>)
      x[a] = tile_begin[a] + rest % tile_width<dim>;
    if (is_near(x))
      return true;
  }
  return false;
}

template <int dim>
bool SurfaceTransport<dim>::swept(const Point<dim>& x) const {
  if (!may_be_swept(x))
    return false;
  const Point<dim> position = interpolation_.physical(x);
  candidates_.clear();
  for (const int s : swept_bins_.at(position))
    if (swept_[s].contains(position))
      candidates_.push_back(s);
  const SurfaceSnapshot<dim>& before = *surface_.before;
  const SurfaceSnapshot<dim>& after = surface_.after ? *surface_.after : before;
  const double tolerance = interpolation_.nearby().tolerance();
  const auto lies_on = [&](const std::array<Point<dim>, dim>& corners) {
    const Point<dim> area = area_vector<dim>(corners);
    return std::abs(area.dot(position - corners[0])) <= 2 * tolerance * area.norm() &&
           closest_on_simplex<dim>(corners, position).distance <= tolerance;
  };
  for (const int s : candidates_)
    if (lies_on(before.corners(s)) || lies_on(after.corners(s)))
      return true;
  return surface_displacement_ > 0 && !candidates_.empty() &&
         swept_over<dim>(before, after, position, candidates_);
}

template <int dim>
bool SurfaceTransport<dim>::inside(const Point<dim>& x, CellState cell) const {
  if (!may_be_swept(x))
    return false;
  // As the centre of its cell, unless a surface may lie between.
  const Point<dim> center = x.array().floor() + 0.5;
  const Box<dim> between(x.cwiseMin(center), x.cwiseMax(center));
  if (cell != CellState::outside && interpolation_.nearby().clear(interpolation_.physical(between)))
    return cell == CellState::solid;
  return surface_.before->inside(interpolation_.physical(x)) >= 0;
}

template <int dim>
bool SurfaceTransport<dim>::clear(const Box<dim>& points, bool during_step, int reach) const {
  const double margin = during_step ? reach + surface_displacement_ : reach;
  return !interpolation_.nearby().touches(interpolation_.physical(widened<dim>(points, margin)));
}

template <int dim>
bool SurfaceTransport<dim>::sees_all(SampleKind kind, const Point<dim>& x,
                                     const Ray<dim>& ray) const {
  const auto clear = [&](const Box<dim>& box) {
    return interpolation_.nearby().clear(interpolation_.physical(box));
  };
  const auto clear_around = [&](SampleKind samples, const Point<dim>& place) {
    const Point<dim> offset = sample_offset<dim>(samples);
    const Point<dim> lower = (place - offset).array().floor().matrix() + offset;
    return clear({lower, lower + Point<dim>::Ones()});
  };
  bool all = clear(Box<dim>(x).extend(ray.middle).extend(ray.end)) &&
             clear(widened<dim>(Box<dim>(x), 0.5)) && clear_around(kind, ray.end);
  for (int a = 0; a < dim; ++a)
    all = all && clear_around(a, ray.middle);
  return all;
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceTransport<dim>::hit_on_way(const Point<dim>& x,
                                                                   const Point<dim>& end) const {
  return interpolation_.nearby().first_hit(interpolation_.physical(x),
                                           interpolation_.physical(end));
}

template <int dim>
Ray<dim> SurfaceTransport<dim>::trace(const Point<dim>& x, std::optional<SurfacePoint<dim>>& hit) {
  const double scale = tracer_.cells_per_velocity();
  Point<dim> displacement = scale * interpolation_.velocity_at(x, tracer_.velocity());
  Ray<dim> half;
  half.end = x - 0.5 * displacement;
  tracer_.clip(x, half);
  if (!hit_on_way(x, half.end))
    displacement = scale * interpolation_.velocity_at(half.end, tracer_.velocity());
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
std::optional<double> SurfaceTransport<dim>::advect(const CarriedField<dim>& field,
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
    tracer_.mix_inflow(field.kind, ray, field.inflow_depth);
  if (ray.inflow_axis >= 0 && ray.inflow_share < 1) {
    Point<dim> entry = ray.end;
    entry[ray.inflow_axis] = ray.inflow_side * lattice_.n_cells()[ray.inflow_axis];
    if (hit_on_way(ray.end, entry)) {
      ray.inflow_axis = -1;
      ray.inflow_share = 0;
    }
  }
  if (ray.inflow_share == 1 && !field.enters)
    return field.inflow(ray);
  auto value = look_up(field, ray.end);
  if (value && ray.inflow_axis >= 0)
    value = field.enters ? field.enters(ray, *value)
                         : *value + ray.inflow_share * (field.inflow(ray) - *value);
  if (value)
    return value;
  value = look_up(field, x);
  if (!value && hit && field.kind != cell_centers)
    value = surface_.velocity(*hit)[field.kind];
  return value;
}

template <int dim>
double SurfaceTransport<dim>::advect_beside(const CarriedField<dim>& field, const Point<dim>& x,
                                            double own) {
  std::optional<SurfacePoint<dim>> hit;
  const Ray<dim> ray = trace(x, hit);
  const auto carried = fetch(field, x, ray, hit);
  const auto seen = look_up(field, x);
  // In a gap that no sample sees, what flows comes to rest at the surface.
  const double here = seen ? *seen : interpolation_.nearest_surface_velocity(x)[field.kind];
  const double way =
      std::max((ray.end - x).norm(), tracer_.cells_per_velocity() * std::abs(own - here));
  return (carried ? *carried : here) + std::max(0.0, 1 - way) * (own - here);
}

template <int dim>
bool SurfaceTransport<dim>::stays_clear(const Point<dim>& x, const Point<dim>& end,
                                        double distance) const {
  const Point<dim> a = interpolation_.physical(x), b = interpolation_.physical(end);
  const Box<dim> box = widened<dim>(Box<dim>(a).extend(b), distance);
  return interpolation_.nearby().reached().contains(box) && swept_bins_.clear(box);
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceTransport<dim>::passage(const Point<dim>& from,
                                                                const Point<dim>& to) const {
  const SurfaceSnapshot<dim>& before = *surface_.before;
  const SurfaceSnapshot<dim>& after = surface_.after ? *surface_.after : before;
  const Point<dim> a = interpolation_.physical(from), b = interpolation_.physical(to);
  const double tolerance = interpolation_.nearby().tolerance();
  const Box<dim> way = widened<dim>(Box<dim>(a).extend(b), tolerance);
  if (interpolation_.nearby().reached().contains(way)) {
    candidates_.clear();
    swept_bins_.visit(way, [&](const auto& list) {
      for (const int s : list)
        if (swept_[s].intersects(way))
          candidates_.push_back(s);
    });
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
  } else {
    const double reach = surface_displacement_ * interpolation_.spacing() + tolerance;
    before.touching(widened<dim>(Box<dim>(a).extend(b), reach), candidates_);
  }
  return candidates_.empty() ? std::nullopt : swept_over<dim>(before, after, a, b, candidates_);
}

template <int dim>
std::optional<Point<dim>> SurfaceTransport<dim>::follow(const Point<dim>& x) {
  const double scale = tracer_.cells_per_velocity();
  Point<dim> displacement = scale * interpolation_.velocity_at(x, tracer_.velocity());
  Ray<dim> half;
  half.end = x + 0.5 * displacement;
  tracer_.clip(x, half);
  if (!hit_on_way(x, half.end))
    displacement = scale * interpolation_.velocity_at(half.end, tracer_.velocity());
  Ray<dim> ray;
  ray.end = x + displacement;
  tracer_.clip(x, ray);
  const SurfaceSnapshot<dim>& before = *surface_.before;
  const SurfaceSnapshot<dim>& after = surface_.after ? *surface_.after : before;
  const double gap = clearance_of_rays * interpolation_.spacing();
  const double margin = gap + 2 * interpolation_.nearby().tolerance();
  if (stays_clear(x, ray.end, margin))
    return ray.end;
  Point<dim> end = interpolation_.physical(ray.end);
  if (const auto met = passage(x, ray.end)) {
    const auto from = before.corners(met->simplex), to = after.corners(met->simplex);
    const Point<dim> there = area_vector<dim>(from);
    const bool in_front = there.dot(interpolation_.physical(x) - from[0]) > 0;
    end.setZero();
    for (int k = 0; k < dim; ++k)
      end += met->barycentric[k] * to[k];
    end += (in_front ? gap : -gap) * area_vector<dim>(to).normalized();
  } else if (stays_clear(ray.end, ray.end, margin)) {
    return ray.end;
  } else if (const auto closest = after.closest(end, gap)) {
    const Point<dim> away = end - closest->position;
    if (away.squaredNorm() == 0)
      return std::nullopt;
    end = closest->position + gap * away.normalized();
  } else {
    return ray.end;
  }
  const Point<dim> stop = interpolation_.place_of(end);
  if (passage(x, stop) || after.inside(end) >= 0)
    return std::nullopt;
  return stop;
}

template class SurfaceTransport<2>;
template class SurfaceTransport<3>;

}  // namespace lockstep
