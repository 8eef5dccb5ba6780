#pragma once
#include "mac/forces/scalars.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Accelerations of the fluid.
template <int dim>
struct ForceParameters {
  Point<dim> gravity = Point<dim>::Zero();  ///< g in the middle of the present step [m/s^2]
  FieldFormula<dim> gravity_law;            ///< formulas of the time that `gravity` comes from
  double gravity_time = 0;                  ///< the time of `gravity` [s]
  Point<dim> body = Point<dim>::Zero();     ///< any other uniform acceleration [m/s^2]
  FieldFormula<dim> damping;                ///< rate at which the velocity decays [1/s]
  double expansion = 0;                     ///< Boussinesq, beta [1/K]
  double reference_temperature = 0;         ///< T0, where buoyancy vanishes [K]
  double smoke_weight = 0;                  ///< relative excess density of smoke of density 1 [1]

  /// Takes the gravity of that time. Local.
  void set_time(double time) {
    gravity_time = time;
    if (!gravity_law.are_numbers())
      gravity = gravity_law.vector(Point<dim>::Zero(), time);
  }
  /// Acceleration of a fluid without scalars [m/s^2].
  Point<dim> uniform() const { return gravity + body; }
};

/// f = g + f_body + (-beta (T - T0) + w s) g along `axis` at a face, temperature and smoke being
/// the mean of the fluid cells beside it. Local; the halo of the scalars must be valid.
template <int dim>
class ForceField {
 public:
  ForceField(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
             const ForceParameters<dim>& parameters, const Scalars<dim>& scalars);
  double operator()(int axis, int cell) const;
  /// Acceleration where all scalars are ambient [m/s^2].
  Point<dim> of_surroundings() const;
  /// True if the acceleration is the same at all faces of an axis.
  bool is_uniform() const { return temperature_ == nullptr && smoke_ == nullptr; }
  /// True if there is no acceleration along `axis`, anywhere.
  bool vanishes(int axis) const {
    return parameters_.gravity[axis] == 0 && parameters_.body[axis] == 0;
  }

 private:
  double mean(const CellField& field, int axis, int cell) const;

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const ForceParameters<dim>& parameters_;
  const Scalar* temperature_;  ///< null if it does nothing
  const Scalar* smoke_;
};

}  // namespace lockstep
