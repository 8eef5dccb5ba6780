#include "transport/visible_interpolation.hpp"

#include <algorithm>

namespace lockstep {

void WeightedMean::add(double weight, double value) {
  if (weight_ == 0)
    base_ = low_ = high_ = value;
  weight_ += weight;
  sum_ += weight * (value - base_);
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

std::optional<double> WeightedMean::value() const {
  if (weight_ == 0)
    return std::nullopt;
  return std::clamp(base_ + sum_ / weight_, low_, high_);
}

template <int dim>
bool VisibleInterpolation<dim>::is_clear(SampleKind kind, const Point<dim>& x) const {
  const Point<dim> offset = sample_offset<dim>(kind);
  const Point<dim> lower = (x - offset).array().floor().matrix() + offset;
  return nearby_->clear(physical(Box<dim>(lower, lower + Point<dim>::Ones())));
}

template <int dim>
bool VisibleInterpolation<dim>::all_count(SampleKind kind, const Point<dim>& x,
                                          const Stencil<dim>& stencil) const {
  // At a closed lower side the velocity is zero, whatever the field says.
  if (kind != cell_centers && usable_.closed_below[kind] && x[kind] < 1)
    return false;
  const char* usable = kind == cell_centers ? usable_.cells : usable_.faces[kind];
  for (const int id : stencil.id)
    if (id != Stencil<dim>::wall_sample && (id < 0 || !usable[id]))
      return false;
  return true;
}

template <int dim>
template <typename Function>
void VisibleInterpolation<dim>::for_each_sample(SampleKind kind, const Point<dim>& x, bool clear,
                                                const Function& f) const {
  const auto samples = lattice_.corners(kind, x);
  const Point<dim> eye = physical(x);
  Box<dim> around(eye);
  typename NearbySurface<dim>::Corners corners;
  for (int k = 0; k < 1 << dim; ++k) {
    const Point<dim> place = samples[k].weight != 0 ? physical(samples[k].position) : eye;
    around.extend(place);
    for (int a = 0; a < dim; ++a)
      corners[a][k] = place[a];
  }
  typename NearbySurface<dim>::Hits hits;
  if (!clear)
    nearby_->look_around(eye, around, corners, hits);
  for (int k = 0; k < 1 << dim; ++k)
    if (samples[k].weight != 0)
      f(samples[k], hits[k]);
}

template <int dim>
void VisibleInterpolation<dim>::look(int axis, const Point<dim>& x, const double* field) {
  Sight& sight = sight_[axis];
  sight.visible = {};
  sight.hidden.clear();
  const bool clear = is_clear(axis, x);
  if (clear) {
    const Stencil<dim> stencil = lattice_.locate(axis, x);
    if (all_count(axis, x, stencil))
      return sight.visible.add(1, interpolate<dim>(stencil, field));
  }
  for_each_sample(axis, x, clear, [&](const StencilCorner<dim>& corner, const auto& hit) {
    if (hit)
      sight.hidden.push_back({corner.weight, *hit});
    else if (corner.id == Stencil<dim>::wall_sample ||
             (usable_.closed_below[axis] && corner.position[axis] == 0))
      sight.visible.add(corner.weight, 0);
    else if (corner.id >= 0 && usable_.faces[axis][corner.id])
      sight.visible.add(corner.weight, field[corner.id]);
  });
}

template <int dim>
double VisibleInterpolation<dim>::slipping(int axis, const Point<dim>& seen,
                                           const SurfacePoint<dim>& hit) const {
  Point<dim> normal = area_vector<dim>(surface_.before->corners(hit.simplex));
  normal.normalize();
  const Point<dim> relative = surface_.velocity(hit) - seen;
  const Point<dim> along = relative - normal * normal.dot(relative);
  const double slip = along.norm();
  const double held = slip > friction_speed_ ? friction_speed_ / slip : 1;
  return seen[axis] + relative[axis] - (1 - held) * along[axis];
}

template <int dim>
std::optional<double> VisibleInterpolation<dim>::seen_velocity(int axis) const {
  WeightedMean mean = sight_[axis].visible;
  const std::vector<Hidden>& hidden = sight_[axis].hidden;
  if (hidden.empty())
    return mean.value();
  std::array<std::optional<double>, dim> visible;
  for (int a = 0; a < dim; ++a)
    visible[a] = sight_[a].visible.value();
  for (const Hidden& sample : hidden) {
    // A component of which nothing is visible is that of the surface before the sample.
    Point<dim> seen = surface_.velocity(sample.hit);
    for (int a = 0; a < dim; ++a)
      seen[a] = visible[a].value_or(seen[a]);
    mean.add(sample.weight, slipping(axis, seen, sample.hit));
  }
  return mean.value();
}

template <int dim>
std::optional<double> VisibleInterpolation<dim>::velocity(int axis, const Point<dim>& x,
                                                          const Velocity& field) {
  look(axis, x, field[axis]);
  if (!sight_[axis].hidden.empty())
    for (int k = 1; k < dim; ++k)
      look((axis + k) % dim, x, field[(axis + k) % dim]);
  return seen_velocity(axis);
}

template <int dim>
std::optional<double> VisibleInterpolation<dim>::scalar(const Point<dim>& x, const double* field) {
  const bool clear = is_clear(cell_centers, x);
  if (clear) {
    const Stencil<dim> stencil = lattice_.locate(cell_centers, x);
    if (all_count(cell_centers, x, stencil))
      return interpolate<dim>(stencil, field);
  }
  WeightedMean mean;
  for_each_sample(cell_centers, x, clear, [&](const StencilCorner<dim>& corner, const auto& hit) {
    if (!hit && corner.id >= 0 && usable_.cells[corner.id])
      mean.add(corner.weight, field[corner.id]);
  });
  return mean.value();
}

template <int dim>
Point<dim> VisibleInterpolation<dim>::velocity_at(const Point<dim>& x, const Velocity& field) {
  for (int a = 0; a < dim; ++a)
    look(a, x, field[a]);
  Point<dim> result;
  std::optional<Point<dim>> fallback;
  for (int a = 0; a < dim; ++a) {
    const auto component = seen_velocity(a);
    if (!component && !fallback)
      fallback = nearest_surface_velocity(x);
    result[a] = component ? *component : (*fallback)[a];
  }
  return result;
}

template <int dim>
Point<dim> VisibleInterpolation<dim>::nearest_surface_velocity(const Point<dim>& x) const {
  if (nearby_->empty())
    return Point<dim>::Zero();
  const auto closest = nearby_->snapshot().closest(physical(x), 3 * grid_.spacing());
  return closest ? surface_.velocity(*closest) : Point<dim>(Point<dim>::Zero());
}

template class VisibleInterpolation<2>;
template class VisibleInterpolation<3>;

}  // namespace lockstep
