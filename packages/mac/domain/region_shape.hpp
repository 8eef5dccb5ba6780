#pragma once
#include <algorithm>
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A part of space that a scene names: a box or a ball.
template <int dim>
struct RegionShape {
  bool ball = false;
  Point<dim> lower = Point<dim>::Zero(), upper = Point<dim>::Zero();  ///< box [m]
  Point<dim> center = Point<dim>::Zero();                             ///< ball [m]
  double radius = 0;                                                  ///< [m]

  bool contains(const Point<dim>& x) const {
    if (ball)
      return (x - center).squaredNorm() <= radius * radius;
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
  /// Negative inside [m].
  double distance(const Point<dim>& x) const {
    if (ball)
      return (x - center).norm() - radius;
    const Point<dim> out = (lower - x).cwiseMax(x - upper);
    return std::min(out.maxCoeff(), 0.0) + out.cwiseMax(0).norm();
  }
};

/// "Shape" and the sizes of box and ball in `list`; reading throws InputError if they do not fit.
template <int dim>
void declare_shape(ParameterList& list);
template <int dim>
RegionShape<dim> read_shape(const ParameterList& list);

}  // namespace lockstep
