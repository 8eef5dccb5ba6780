#include "mac/visible_interpolation.hpp"

#include <algorithm>

namespace lockstep {

namespace {

/// A weighted mean that is exact for equal values and never leaves their range.
class Mean {
 public:
  void add(double weight, double value) {
    if (weight_ == 0)
      base_ = low_ = high_ = value;
    weight_ += weight;
    sum_ += weight * (value - base_);
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  std::optional<double> value() const {
    if (weight_ == 0)
      return std::nullopt;
    return std::clamp(base_ + sum_ / weight_, low_, high_);
  }

 private:
  double weight_ = 0, base_ = 0, sum_ = 0, low_ = 0, high_ = 0;
};

}  // namespace

template <int dim>
void VisibleInterpolation<dim>::look_around(const Point<dim>& x, double radius) {
  nearby_.gather(physical(widened<dim>(Box<dim>(x), 1 + radius)));
}

template <int dim>
std::array<StencilCorner<dim>, (1 << dim)> VisibleInterpolation<dim>::focus(SampleKind kind,
                                                                            const Point<dim>& x) {
  const auto corners = lattice_.corners(kind, x);
  Box<dim> box(x);
  for (const StencilCorner<dim>& corner : corners)
    box.extend(corner.position);
  nearby_.focus(physical(box));
  return corners;
}

template <int dim>
std::optional<double> VisibleInterpolation<dim>::velocity(int axis, const Point<dim>& x,
                                                          const double* field) {
  const Point<dim> eye = physical(x);
  Mean mean;
  for (const StencilCorner<dim>& corner : focus(axis, x)) {
    if (corner.weight == 0)
      continue;
    if (const auto hit = nearby_.focused_hit(eye, physical(corner.position)))
      mean.add(corner.weight, surface_.velocity(*hit)[axis]);
    else if (corner.id == Stencil<dim>::wall_sample)
      mean.add(corner.weight, 0);
    else if (corner.id >= 0 && usable_.faces[axis][corner.id])
      mean.add(corner.weight, field[corner.id]);
  }
  return mean.value();
}

template <int dim>
std::optional<double> VisibleInterpolation<dim>::scalar(const Point<dim>& x, const double* field) {
  const Point<dim> eye = physical(x);
  Mean mean;
  for (const StencilCorner<dim>& corner : focus(cell_centers, x))
    if (corner.weight > 0 && corner.id >= 0 && usable_.cells[corner.id] &&
        !nearby_.focused_hit(eye, physical(corner.position)))
      mean.add(corner.weight, field[corner.id]);
  return mean.value();
}

template <int dim>
Point<dim> VisibleInterpolation<dim>::velocity_at(const Point<dim>& x,
                                                  const std::array<const double*, dim>& field) {
  Point<dim> result;
  std::optional<Point<dim>> fallback;
  for (int a = 0; a < dim; ++a) {
    const auto component = velocity(a, x, field[a]);
    if (!component && !fallback)
      fallback = nearest_surface_velocity(x);
    result[a] = component ? *component : (*fallback)[a];
  }
  return result;
}

template <int dim>
Point<dim> VisibleInterpolation<dim>::nearest_surface_velocity(const Point<dim>& x) const {
  if (nearby_.empty())
    return Point<dim>::Zero();
  const auto closest = nearby_.snapshot().closest(physical(x), 3 * grid_.spacing());
  return closest ? surface_.velocity(*closest) : Point<dim>(Point<dim>::Zero());
}

template class VisibleInterpolation<2>;
template class VisibleInterpolation<3>;

}  // namespace lockstep
