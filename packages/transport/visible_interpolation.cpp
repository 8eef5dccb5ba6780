#include "transport/visible_interpolation.hpp"

#include <algorithm>

#include "transport/box_visibility.hpp"

namespace lockstep {

namespace {
template <int dim>
constexpr unsigned all_samples = (1u << (1 << dim)) - 1;

template <int dim>
double weight_of(const Stencil<dim>& stencil, int k) {
  double weight = 1;
  for (int a = 0; a < dim; ++a)
    weight *= (k >> a & 1) != 0 ? stencil.weight[a] : 1 - stencil.weight[a];
  return weight;
}
}  // namespace

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
void VisibleInterpolation<dim>::add_seen(SampleKind kind, const Point<dim>& x,
                                         const Stencil<dim>& stencil, unsigned seen,
                                         const double* field, WeightedMean& mean) const {
  // At a closed lower side the velocity is zero, whatever the field says.
  const bool at_closed_side = kind != cell_centers && usable_.closed_below[kind] && x[kind] < 1;
  const char* usable = kind == cell_centers ? usable_.cells : usable_.faces[kind];
  for (int k = 0; k < 1 << dim; ++k) {
    const double weight = weight_of<dim>(stencil, k);
    const int id = stencil.id[k];
    if (weight == 0 || (seen >> k & 1) == 0)
      continue;
    if (id == Stencil<dim>::wall_sample || (at_closed_side && (k >> kind & 1) == 0))
      mean.add(weight, 0);
    else if (id >= 0 && usable[id])
      mean.add(weight, field[id]);
  }
}

template <int dim>
std::optional<typename VisibleInterpolation<dim>::Hidden>
VisibleInterpolation<dim>::hidden_together(SampleKind kind, const Point<dim>& x,
                                           const Stencil<dim>& stencil, unsigned hidden,
                                           const BoxVisibility<dim>& box) const {
  double sum = 0;
  Point<dim> beyond = Point<dim>::Zero();  // share of the upper samples along each axis
  for (int k = 0; k < 1 << dim; ++k) {
    const double weight = (hidden >> k & 1) == 0 ? 0 : weight_of<dim>(stencil, k);
    sum += weight;
    for (int a = 0; a < dim; ++a)
      beyond[a] += (k >> a & 1) * weight;
  }
  if (sum == 0)
    return std::nullopt;
  const Point<dim> offset = sample_offset<dim>(kind);
  const Point<dim> lower = (x - offset).array().floor().matrix() + offset;
  const Point<dim> eye = physical(x);
  const auto hit = nearby_->first_hit(eye, physical(Point<dim>(lower + beyond / sum)));
  return Hidden{sum, hit ? *hit : box.beside(nearby_->snapshot(), eye)};
}

template <int dim>
template <typename Function>
unsigned VisibleInterpolation<dim>::send_rays(SampleKind kind, const Point<dim>& x,
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
  nearby_->look_around(eye, around, corners, hits);
  unsigned seen = 0;
  for (int k = 0; k < 1 << dim; ++k) {
    seen |= unsigned(!hits[k]) << k;
    if (hits[k] && samples[k].weight != 0)
      f(samples[k].weight, *hits[k]);
  }
  return seen;
}

template <int dim>
template <typename Function>
unsigned VisibleInterpolation<dim>::send_rays_to(unsigned unknown, SampleKind kind,
                                                 const Point<dim>& x, const Function& f) const {
  const auto samples = lattice_.corners(kind, x);
  unsigned seen = 0;
  for (int k = 0; k < 1 << dim; ++k) {
    if ((unknown >> k & 1) == 0 || samples[k].weight == 0)
      continue;
    if (const auto hit = nearby_->first_hit(physical(x), physical(samples[k].position)))
      f(samples[k].weight, *hit);
    else
      seen |= 1u << k;
  }
  return seen;
}

template <int dim>
template <typename Function>
typename VisibleInterpolation<dim>::Found VisibleInterpolation<dim>::find_seen(
    SampleKind kind, const Point<dim>& x, const BoxVisibility<dim>* box, const Function& f) const {
  if (!box)
    return {all_samples<dim>, 0};
  const auto known = box->seen_from(physical(x));
  if (!known)
    return {send_rays(kind, x, f), 0};
  const unsigned seen = known->unknown == 0 ? 0 : send_rays_to(known->unknown, kind, x, f);
  return {known->seen | seen, all_samples<dim> & ~(known->seen | known->unknown)};
}

template <int dim>
void VisibleInterpolation<dim>::look(int axis, const Point<dim>& x, const double* field) {
  Sight& sight = sight_[axis];
  sight.visible = {};
  sight.hidden.clear();
  const BoxVisibility<dim>* box = nearby_->visibility(axis).around(x);
  const Stencil<dim> stencil = lattice_.locate(axis, x);
  if (!box && all_count(axis, x, stencil))
    return sight.visible.add(1, interpolate<dim>(stencil, field));
  const Found found = find_seen(axis, x, box, [&](double weight, const auto& hit) {
    sight.hidden.push_back({weight, hit});
  });
  add_seen(axis, x, stencil, found.seen, field, sight.visible);
  if (found.hidden != 0)
    if (const auto hidden = hidden_together(axis, x, stencil, found.hidden, *box))
      sight.hidden.push_back(*hidden);
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
  const BoxVisibility<dim>* box = nearby_->visibility(cell_centers).around(x);
  const Stencil<dim> stencil = lattice_.locate(cell_centers, x);
  if (!box && all_count(cell_centers, x, stencil))
    return interpolate<dim>(stencil, field);
  WeightedMean mean;
  const Found found = find_seen(cell_centers, x, box, [](double, const auto&) {});
  add_seen(cell_centers, x, stencil, found.seen, field, mean);
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
