#pragma once
#include <memory>

#include "lines/line_law.hpp"

namespace lockstep {

struct CatenaryParameters {
  double length = 0;     ///< length without tension [m]
  double weight = 0;     ///< weight in the fluid by length [N/m]
  double stiffness = 0;  ///< tension by strain, EA [N]
  /// The first end lies on level ground, and with it the part that tension does not lift.
  bool on_floor = false;
};

/// Tension of the upper end of an elastic catenary, along the way to it and down.
struct CatenaryTension {
  double horizontal = 0, vertical = 0;  ///< H, V [N]
  /// Their derivatives by l and h: [dH/dl, dH/dh; dV/dl, dV/dh], symmetric [N/m].
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
  double energy = 0;  ///< elastic, and of the weight above the first end [J]
};

/// The elastic catenary (Irvine 1981; with the ground Jonkman 2007) whose second end is l [m]
/// beside its first and h [m] above. Throws SolveError if it is not found.
CatenaryTension solve_catenary(const CatenaryParameters& line, double l, double h);

/// A line under its weight in the fluid, at rest in every moment. `up`: of length 1.
template <int dim>
std::shared_ptr<const LineLaw<dim>> catenary_law(const CatenaryParameters& line,
                                                 const Point<dim>& up);

}  // namespace lockstep
