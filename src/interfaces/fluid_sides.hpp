#pragma once
#include <string>
#include <utility>
#include <vector>

#include "interfaces/fluid.hpp"

namespace lockstep {

struct BoxFrame;      // output/frames.hpp
struct SurfaceFrame;  // output/frames.hpp

// Sides of fluids (FluidDiscretization::audit, ...) for audits, solvers and outputs. Viscosity has
// its own (interfaces/viscosity.hpp), and so have the fluxes of the sides (prescribed_flux.hpp) and
// samples (field_sampler.hpp).

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

/// State of a fluid at one place.
template <int dim>
struct FluidSample {
  bool in_fluid = false;                     ///< false: in a solid or outside; all else is zero
  double pressure = 0;                       ///< [Pa]
  Point<dim> velocity = Point<dim>::Zero();  ///< [m/s]

  template <typename F>
  void for_each_part(const F& f) {
    f(in_fluid);
    f(pressure);
    f(velocity);
  }
};

/// Flow of a fluid through a plane at one place.
struct FlowSample {
  double open = 0;  ///< part of the plane there that fluid can go through [1]; 0: all else is zero
  double rate = 0;  ///< volume by area, open or not, and time, along the axis [m/s]
  double pressure = 0;  ///< [Pa]

  template <typename F>
  void for_each_part(const F& f) {
    f(open);
    f(rate);
    f(pressure);
  }
};

/// Output of a fluid: samples for observers, fields and surfaces for pictures, notes for
/// `--explain`.
template <int dim>
class FluidOutput {
 public:
  virtual ~FluidOutput() = default;
  /// The state at the end of the last step, one sample a point [m], the same on all ranks.
  /// Collective; all ranks ask for the same points.
  virtual std::vector<FluidSample<dim>> sample(const std::vector<Point<dim>>& points) const = 0;
  /// Returns the flow through planes at right angles to an axis, by the fluid's own balance of
  /// volume. Without a better answer all or nothing, as `sample` has it. Collective.
  virtual std::vector<FlowSample> flow_across(int axis,
                                              const std::vector<Point<dim>>& points) const {
    std::vector<FlowSample> flows;
    for (const FluidSample<dim>& one : sample(points))
      flows.push_back({one.in_fluid ? 1. : 0., one.velocity[axis], one.pressure});
    return flows;
  }
  /// Adds its cell-centred fields to a frame. Default: it has none.
  virtual void add_frame(std::vector<BoxFrame>&) const {}
  /// Adds its surfaces, as a liquid with a free surface has one. Collective.
  virtual void add_surfaces(std::vector<SurfaceFrame>&) const {}
  /// Returns the names of the surfaces, which no solid may have. Local.
  virtual std::vector<std::string> surface_names() const { return {}; }
  /// Lines for `--explain`, title and text: how the grid has taken what the scene asks for.
  /// Collective.
  virtual std::vector<std::pair<std::string, std::string>> notes() const { return {}; }
};

}  // namespace lockstep
