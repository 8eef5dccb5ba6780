#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A part of space that a scene names.
template <int dim>
struct RegionShape {
  enum class Kind { box, ball, cylinder };  ///< a cylinder in 3D only

  Kind kind = Kind::box;
  Point<dim> lower = Point<dim>::Zero(), upper = Point<dim>::Zero();  ///< box [m]
  Point<dim> center = Point<dim>::Zero();                             ///< ball, cylinder [m]
  double radius = 0;                                                  ///< ball, cylinder [m]
  Point<dim> axis = Point<dim>::Unit(0);                              ///< cylinder; a unit vector
  double length = 0;                                                  ///< cylinder [m]

  bool contains(const Point<dim>& x) const {
    return kind == Kind::ball ? (x - center).squaredNorm() <= radius * radius : distance(x) <= 0;
  }
  /// Negative inside [m].
  double distance(const Point<dim>& x) const {
    switch (kind) {
      case Kind::ball:
        return (x - center).norm() - radius;
      case Kind::cylinder: {
        const double along = (x - center).dot(axis);
        const double across = (x - center - along * axis).norm();
        return outside<2>({std::abs(along) - 0.5 * length, across - radius});
      }
      default:
        return outside<dim>((lower - x).cwiseMax(x - upper));
    }
  }
  /// All of it lies in there.
  Box<dim> bounds() const {
    if (kind == Kind::box)
      return {lower, upper};
    Point<dim> reach = Point<dim>::Constant(radius);
    if (kind == Kind::cylinder)
      for (int a = 0; a < dim; ++a)
        reach[a] = 0.5 * length * std::abs(axis[a]) +
                   radius * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
    return {Point<dim>(center - reach), Point<dim>(center + reach)};
  }

 private:
  /// Returns the distance from a region, given how far a point is beyond each of its bounds.
  template <int n>
  static double outside(const Point<n>& beyond) {
    return std::min(beyond.maxCoeff(), 0.0) + beyond.cwiseMax(0).norm();
  }
};

/// "Shape" and the sizes in `list`; reading throws InputError if they do not fit.
template <int dim>
void declare_shape(ParameterList& list);
template <int dim>
RegionShape<dim> read_shape(const ParameterList& list);

}  // namespace lockstep
