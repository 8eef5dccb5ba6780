#pragma once
#include <array>
#include <memory>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Forces and energy of a line, by the way from the first to the second.
template <int dim>
struct LineResponse {
  double energy = 0;  ///< [J]; that of its weight is relative to the first end
  std::array<Point<dim>, 2> force{Point<dim>::Zero(), Point<dim>::Zero()};  ///< on the ends [N]
  /// - d force[1] / d way, symmetric positive semidefinite [N/m].
  Eigen::Matrix<double, dim, dim> stiffness = Eigen::Matrix<double, dim, dim>::Zero();
  /// - d force[1] / d (rate of the way), likewise [N s/m].
  Eigen::Matrix<double, dim, dim> damping = Eigen::Matrix<double, dim, dim>::Zero();
  std::array<double, 2> tension{};  ///< at the ends [N]; negative: it pushes
};

/// A law of a line between two points.
template <int dim>
class LineLaw {
 public:
  virtual ~LineLaw() = default;
  virtual LineResponse<dim> response(const Point<dim>& way) const = 0;
  /// Weight of which the ends bear all, wherever they are [N].
  virtual Point<dim> weight() const { return Point<dim>::Zero(); }
  /// Points of the line relative to its first end, from there to the second [m].
  virtual std::vector<Point<dim>> shape(const Point<dim>& way) const;
};

struct SpringParameters {
  double stiffness = 0;       ///< [N/m]
  double damping = 0;         ///< [N s/m]
  double length = 0;          ///< length at rest [m]
  bool tension_only = false;  ///< a rope: it never pushes
};

/// A spring and a damper side by side, along the way between the ends.
template <int dim>
std::shared_ptr<const LineLaw<dim>> spring_law(const SpringParameters& parameters);

}  // namespace lockstep
