#pragma once
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/fluid.hpp"

namespace lockstep {

struct BoxFrame;      // output/frames.hpp
struct SurfaceFrame;  // output/frames.hpp

// Side interfaces of fluids (`side_of`) for audits, solvers and outputs. Viscosity has its own
// (interfaces/viscosity.hpp), and so have the fluxes of the sides (prescribed_flux.hpp) and samples
// (field_sampler.hpp).

/// Momentum and energy of u*, for the ledger. Without it a run has no `momentum_error`.
template <int dim>
class AuditedFluid {
 public:
  virtual ~AuditedFluid() = default;
  virtual Momentum<dim> momentum()
      const = 0;  ///< momentum of u* on free faces, global. Collective.
  virtual double kinetic_energy()
      const = 0;  ///< energy of u* on free faces [J], global. Collective.
  /// Impulse of walls and open sides through their own pressure [kg m/s], global. Collective.
  virtual Momentum<dim> boundary_pressure_impulse(const Vector& scaled_pressure) const = 0;
};

/// Keeps the pressure of the last step: the initial guess of the solves, and an input of the
/// viscous solve.
template <int dim>
class PressureMemory {
 public:
  virtual ~PressureMemory() = default;
  /// p̂ of the last accepted step on the present unknowns, carried on to those where there was none.
  /// Collective.
  virtual RCP<Vector> last_scaled_pressure() const = 0;
  /// Adds `inflow` [Pa s m^dim] over the volume of each unknown's cell to the scaled pressure that
  /// `accept` keeps of the last `project`. Changes no velocity. Collective.
  virtual void correct_pressure(const Vector& inflow) = 0;
};

/// p̂ of the last step, zero if the fluid does not keep it. Collective.
template <int dim>
RCP<Vector> last_scaled_pressure_of(const FluidDiscretization<dim>& fluid) {
  const auto* memory = side_of<PressureMemory<dim>>(fluid);
  return memory ? memory->last_scaled_pressure() : make_vector(fluid.pressure_map());
}

/// Knows the box that the fluid is in. The part of a solid beyond an open side or a wall displaces
/// no fluid.
template <int dim>
class BoundedFluid {
 public:
  virtual ~BoundedFluid() = default;
  virtual Box<dim> bounds() const = 0;  ///< [m]; the same on every rank. Local.
  /// [axis][lower, upper]: a wall, which solids cannot pass either. Local.
  virtual std::array<std::array<bool, 2>, dim> closed_sides() const { return {}; }
  /// Velocity of the wall at an end (0 lower, 1 upper) of an axis, tangential to the wall, at a
  /// time [m/s]. Local.
  virtual Point<dim> wall_velocity(int, int, double) const { return Point<dim>::Zero(); }
  /// True if what leaves at one side comes in at another: then torques have no common origin.
  /// Local.
  virtual bool is_periodic() const { return false; }
};

/// All of space for fluids without bounds. Local.
template <int dim>
Box<dim> bounds_of(const FluidDiscretization<dim>& fluid) {
  if (const auto* bounded = side_of<BoundedFluid<dim>>(fluid))
    return bounded->bounds();
  const Point<dim> far = Point<dim>::Constant(std::numeric_limits<double>::max());
  return Box<dim>(-far, far);
}

/// Fields, surfaces and notes that only pictures and `--explain` show.
template <int dim>
class FluidOutput {
 public:
  virtual ~FluidOutput() = default;
  /// Adds its cell-centred fields to a frame.
  virtual void add_frame(std::vector<BoxFrame>& boxes) const = 0;
  /// Adds its surfaces, as a liquid with a free surface has one. Collective.
  virtual void add_surfaces(std::vector<SurfaceFrame>&) const {}
  /// Returns the names of the surfaces, which no solid may have. Local.
  virtual std::vector<std::string> surface_names() const { return {}; }
  /// Lines for `--explain`, title and text: how the grid has taken what the scene asks for.
  /// Collective.
  virtual std::vector<std::pair<std::string, std::string>> notes() const { return {}; }
};

}  // namespace lockstep
