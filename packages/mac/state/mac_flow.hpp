#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "liquid/liquid.hpp"
#include "mac/pressure/pressure_operator.hpp"
#include "mac/state/advection_history.hpp"
#include "mac/state/mac_parameters.hpp"
#include "mac/state/velocity_history.hpp"
#include "staggered/state/stored_fields.hpp"
#include "transport/ray_halo.hpp"

namespace lockstep {

/// State that the parts of a MacFluid share: its grid, its parameters, the geometry of an instant
/// and all fields.
template <int dim>
struct MacFlow {
  /// Collective. Validated lists "Fluid" and "Domain" of a scene.
  MacFlow(const ParameterList& fluid, const ParameterList& box, const Communicator& comm,
          const InterfaceRegistry<dim>* interfaces);
  MacFlow(const MacFlow&) = delete;
  MacFlow& operator=(const MacFlow&) = delete;

  MacDomain<dim> domain;
  MacParameters<dim> parameters;
  Scalars<dim> scalars;
  RayHalo<dim> ray_halo;
  KeptSurface<dim> nearby;
  std::shared_ptr<const LatticeBlocks> blocks;
  std::unique_ptr<Liquid<dim>> liquid;  ///< null: no free surface

  MacGeometry<dim> geometry;
  FaceField<dim> velocity, prediction;          ///< u^n, u*
  std::optional<VelocityHistory<dim>> history;  ///< none: first order in time, or steps of kicks
  std::optional<AdvectionHistory<dim>> advection_history;  ///< none: likewise, or the paper's steps
  CellField scaled_pressure;                               ///< p̂ of the last projection
  CellField accepted_pressure;                             ///< p of the last accepted step [Pa]
  std::vector<CellState> accepted_cells;                   ///< states of the cells then
  double accepted_step = 0;                                ///< its dt
  Point<dim> accepted_acceleration =
      Point<dim>::Zero();           ///< force per mass without scalars in that step [m/s^2]
  std::vector<StoredField> fields;  ///< all that are kept from step to step
  double time = 0;                  ///< time of walls and inflows: time + dt of the last forces [s]
  double last_step = 0;             ///< dt of the last forces, for p = p̂ / dt in pictures
  Momentum<dim>
      surface_impulse;  ///< impulse of surface tension in the last forces and viscous solve

  bool tension_is_implicit() const { return liquid && liquid->tension_is_implicit(); }
  bool holds_gas() const { return liquid && liquid->gas(); }
  bool has_drops() const { return liquid && liquid->drops(); }

  /// Takes these pressures: u* -= rho^-1 G p̂ on free faces. Collective.
  void project(CellField pressure);
  /// Velocities on walls and inflows at a time. Sets the halo. Collective.
  void set_prescribed(double at_time, FaceField<dim>& of) const;
  /// Largest sum_a |u_a| of u^n [m/s]; looked for once. Collective.
  double largest_speed() const;
  void forget_speed() { largest_speed_.reset(); }
  /// Returns the rates of change that advection of second order keeps; none: of first order. Local.
  std::vector<StoredField> rates();
  /// Advection of second order keeps its rates for steps of kicks from now on; that of first order
  /// stays. Local.
  void take_kicks();

  /// The fields and times. Loading finds the tiles already as they were. Collective.
  void save(CheckpointWriter& checkpoint) const;
  void load(const CheckpointReader& checkpoint);

 private:
  mutable std::optional<double> largest_speed_;
};

}  // namespace lockstep
