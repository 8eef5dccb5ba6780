#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/moving_surface.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/step_bound.hpp"
#include "linear/harmonic_extension.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// The kinds of neighbour on one side of a velocity control volume.
enum class SideKind : char {
  unknown,  ///< a pressure that is solved for
  solid,    ///< the inside of a closed solid
  patch,    ///< a wall or another closed solid, with no room for a pressure between
  air,      ///< air, p = 0
  open,     ///< an open side of the domain, p = 0
  closed    ///< a wall or an inflow, which takes any pressure
};

/// One side of a velocity control volume.
template <int dim>
struct PressureSide {
  SideKind kind = SideKind::open;
  GlobalIndex unknown = no_index;          ///< id in `pressure_map` if the kind is `unknown`
  Point<dim> center = Point<dim>::Zero();  ///< where the pressure lives [m]
  int solid = -1;                          ///< index in the snapshot if the kind is `solid`, or -1
  GlobalIndex cell =
      no_index;  ///< the fluid's own number of the cell there; no_index: there is none
  int bubble =
      -1;  ///< gas bubble (interfaces/gas.hpp) if the kind is `air` and it is in one, or -1
  /// Node of `FluidGeometry::contact_patches` if the kind is `patch`, or -1: the pressure is the
  /// harmonic extension's there, of a linear pressure that at `center` times `weight`.
  int patch = -1;
  double weight = 1;
};

/// The control volume of one staggered velocity (a dual cell). Its momentum balance is
/// M u' = M u* - area (p̂_upper - p̂_lower) (Eq. 9).
///
/// It is an axis-aligned box with one direction, its velocity's. Couplings cut the box by surfaces
/// and carry its momentum along that axis alone. Staggered grids and octrees, whose faces between
/// cells of two sizes are boxes too, are made of such volumes; finite elements are not: their
/// velocities stand at nodes, along all axes, and would need a coupling of their own.
template <int dim>
struct ControlVolume {
  int direction = 0;                       ///< axis of its velocity
  Point<dim> center = Point<dim>::Zero();  ///< R_f [m]
  Box<dim> box;                            ///< the dual cell; half of it at an open side
  double density = 0;  ///< density of the fluid, or of the liquid below a gas [kg/m^dim]
  double area = 0;     ///< area of the face, V |G| [m^(dim-1)]
  std::array<PressureSide<dim>, 2> sides;       ///< lower, upper along `direction`
  double open_fraction = 1;                     ///< alpha_f, as the coupling's rule answered
  Point<dim> open_center = Point<dim>::Zero();  ///< where its fluid moves: R_f unless partly open
  bool seen_by_fluid = true;  ///< a fluid cell beside it sees its centre without crossing a surface
  /// True on a wall or an inflow: a boundary condition prescribes the velocity of its open part.
  bool at_prescribed_side = false;
  GlobalIndex id = no_index;  ///< the fluid's own number; the same on any number of ranks

  /// True if no pressure unknown is beside it, so that no liquid moves with it.
  bool only_gas() const { return sides[0].unknown == no_index && sides[1].unknown == no_index; }
  bool touches_patch() const { return sides[0].patch >= 0 || sides[1].patch >= 0; }
};

/// A cell with a pressure through which the surface of a soft body passes.
template <int dim>
struct CutCell {
  Box<dim> box;  ///< [m]; cells side by side have the same plane between them, to the bit
  PressureSide<dim> pressure;  ///< an unknown, or that of a gas bubble
  bool is_owned = true;        ///< by this rank: it counts for one
};

/// Decides how far a control volume is open to the fluid: 1 free, 0 closed (mixed, after the
/// paper), between: the face fraction of a cut-cell coupling. Called for every control volume near
/// a surface that has a fluid cell on at least one side.
template <int dim>
class OpenFractionRule {
 public:
  virtual ~OpenFractionRule() = default;
  /// `occluded`: a surface is between its two pressure points, or parts the fluid of its cells.
  virtual double open_fraction(const ControlVolume<dim>& volume, bool occluded,
                               const SurfaceSnapshot<dim>& surface) const = 0;
  /// True if cells are cut: every cell with an open face carries a pressure, wherever its centre
  /// is. False: cells whose centre is inside a closed solid carry none, and their faces are closed.
  virtual bool cuts_cells() const { return false; }
  /// Centroid of the open part of a face whose open fraction is between 0 and 1: there its momentum
  /// counts. Default: the centre of the face.
  virtual Point<dim> open_center(const ControlVolume<dim>& volume,
                                 const SurfaceSnapshot<dim>&) const {
    return volume.center;
  }
};

/// Connected components of the pressure unknowns through free faces (regions, design: null space).
struct PressureRegions {
  int n_regions = 0;                ///< over all ranks
  std::vector<int> of_unknown;      ///< region of each local pressure unknown
  std::vector<char> has_dirichlet;  ///< per region: some face fixes the pressure level
};

/// The frozen geometry, as `set_geometry` makes it.
template <int dim>
struct FluidGeometry {
  /// Control volumes with open_fraction < 1 and at least one pressure unknown, gas bubble or
  /// contact patch, owned here.
  std::vector<ControlVolume<dim>> coupled_volumes;
  /// Cells through which surfaces of soft bodies pass, if the rule cuts cells: those owned here and
  /// those beside this rank's coupled volumes.
  std::vector<CutCell<dim>> cut_cells;
  RCP<const Map> pressure_map;
  /// A = V G_f^T rho^-1 G_f over free faces [m^dim s / kg * 1/m^2]; symmetric positive
  /// semidefinite.
  RCP<const LinearOperator> pressure_block;
  PressureRegions regions;
  double volume = 0;  ///< volume of the fluid [m^dim], global
  /// The patches in which closed solids touch walls and each other, with no pressure between: a
  /// patch has the harmonic extension of the pressure around it, and what solids push out there
  /// comes out around it. Null: there is none; the same on all ranks.
  std::shared_ptr<const HarmonicExtension> contact_patches;
};

/// Momentum that the explicit forces of a step gave to the fluid.
template <int dim>
struct ForceImpulse {
  Momentum<dim> impulse;               ///< given to the free velocities, global
  std::vector<double> coupled_change;  ///< change of each coupled control volume's u* [m/s]
};

template <int dim>
class AuditedFluid;  // interfaces/fluid_sides.hpp
template <int dim>
class EnergyFluid;  // interfaces/energy.hpp
template <int dim>
class FluidOutput;  // interfaces/fluid_sides.hpp
template <int dim>
class GasFluid;  // interfaces/gas.hpp
template <int dim>
class LiquidFluid;  // interfaces/liquid.hpp
template <int dim>
class ViscousFluid;  // interfaces/viscosity.hpp

/// A fluid on its own discretization. Geometry is frozen between two calls of `set_geometry`.
///
/// It keeps three velocity fields: the velocity u^n, the prediction u* on which all stages between
/// `begin_prediction` and `accept` act, and the leak-proof advection velocity u_ADV. Audits,
/// solvers and outputs find more in interfaces/fluid_sides.hpp, the viscous solve in viscosity.hpp.
/// All members are collective unless they say otherwise.
template <int dim>
class FluidDiscretization : public PlugIn {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  // Geometry and the pressure system (Eq. 16, block A).

  /// Freezes the geometry: cell states, coupled control volumes, pressure unknowns, regions, A.
  void set_geometry(const Surface& surface, const OpenFractionRule<dim>& rule) {
    frozen_ = &freeze(surface, rule);
  }
  /// Parts of the frozen geometry. Local.
  const std::vector<ControlVolume<dim>>& coupled_volumes() const {
    return frozen_->coupled_volumes;
  }
  const std::vector<CutCell<dim>>& cut_cells() const { return frozen_->cut_cells; }
  const RCP<const Map>& pressure_map() const { return frozen_->pressure_map; }
  const RCP<const LinearOperator>& pressure_block() const { return frozen_->pressure_block; }
  const PressureRegions& regions() const { return frozen_->regions; }
  double fluid_volume() const { return frozen_->volume; }
  const std::shared_ptr<const HarmonicExtension>& contact_patches() const {
    return frozen_->contact_patches;
  }

  /// rhs = V G_f^T u* + V G_d^T u_d: minus the outflow of the free and the prescribed faces
  /// [m^dim/s].
  virtual void divergence(Vector& rhs) const = 0;
  /// u* -= rho^-1 G p̂ on free faces (F2, F4). p̂ = dt p [Pa s].
  virtual void project(const Vector& scaled_pressure) = 0;
  /// u* of the coupled control volumes, in their order [m/s]. Local.
  virtual std::vector<double> coupled_velocity() const = 0;
  /// Sets u* of the coupled control volumes that are closed (open fraction 0), in their order
  /// [m/s]; a partly open one keeps its own.
  virtual void set_coupled_velocity(const std::vector<double>& velocity) = 0;

  // The stages of a step.

  /// Steps are two kicks and a drift (stepping/step/kick_drift_kick.cpp): what `advect` takes is
  /// the velocity that the first kick gave, less what `begin_advection_velocity` had added before
  /// that. Before the first step; local. Default: nothing is added then, nor taken off.
  virtual void take_kicks() {}
  /// Begins a step from `time` to time + dt: tiles may be made where things will move. Returns true
  /// if u^n lives on other cells than when it was accepted, without being free of divergence there:
  /// then the geometry is to be frozen anew. `solid_speed`: that of the fastest solid [m/s];
  /// collective, for those who want it. Default: the fluid always has room.
  virtual bool begin_step(double /*time*/, double /*dt*/,
                          const std::function<double()>& /*solid_speed*/) {
    return false;
  }
  virtual void begin_prediction() = 0;  ///< u* := u^n
  /// u* := the velocity to carry things over a step of dt, before F2, or the first of two kicks,
  /// makes it free of divergence: u^n, or nearer to the middle of the step. True if it is as free
  /// of divergence as u^n where there are no solids, so that F2 has nothing to do; the same on all
  /// ranks.
  virtual bool begin_advection_velocity(double /*dt*/) {
    begin_prediction();
    return true;
  }
  /// u* += dt f on all velocities outside solids.
  virtual ForceImpulse<dim> add_forces(double time, double dt) = 0;
  /// F3: u_ADV := u*, as F2 left it; then u* := u^n carried along u_ADV, and all scalars. Rays stop
  /// at the moving surfaces and see only samples on their own side. Called before `set_geometry` of
  /// the new surfaces.
  virtual void advect(double time, double dt, const MovingSurface<dim>& surface) = 0;
  /// Gives values to samples that a surface swept over or uncovered, from visible neighbours.
  /// Called after `set_geometry` of the new surfaces. Default: nothing is stored there.
  virtual void populate_uncovered(const MovingSurface<dim>&) {}
  virtual void accept() = 0;  ///< u^n := u* (end of the step)

  // Scales and properties that the step and the solids need to know.

  /// Returns the shortest distance that the fluid resolves [m]: h of its smallest cells. Local.
  virtual double smallest_length() const = 0;
  /// Largest sum_a |u_a| of u^n [m/s].
  virtual double largest_speed() const = 0;
  /// Returns the longest step [s] in which neither the fluid nor a solid of that speed [m/s]
  /// crosses more than n_cells cells, with the velocity that gravity adds within the step. Infinite
  /// at rest. Default: all cells are as small as the smallest.
  virtual double suggested_step(double n_cells, double solid_speed) const;
  /// The longest step that is stable; waves on a free surface bound it. Default: any is. Local.
  virtual StepBound largest_stable_step() const { return {}; }
  /// True if its own geometry changes from step to step, as that of a free surface does: then it is
  /// frozen anew after `advect`, solids or not. The same on all ranks. Local.
  virtual bool geometry_changes() const { return false; }
  /// Uniform acceleration [m/s^2]. Local.
  virtual Point<dim> gravity() const { return Point<dim>::Zero(); }
  /// Density of the fluid at x [kg/m^dim], for the buoyancy of bodies too small for the grid to
  /// see. Default 0: such bodies feel none. Local.
  virtual double density(const Point<dim>&) const { return 0; }

  // The box that it can be in. What of a solid lies beyond an open side or a wall displaces
  // nothing.

  /// Default: all of space. The same on every rank. Local. [m]
  virtual Box<dim> bounds() const {
    const Point<dim> far = Point<dim>::Constant(std::numeric_limits<double>::max());
    return Box<dim>(-far, far);
  }
  /// [axis][lower, upper]: a wall, which solids cannot pass either. Local.
  virtual std::array<std::array<bool, 2>, dim> closed_sides() const { return {}; }
  /// Velocity of the wall at an end (0 lower, 1 upper) of an axis, along itself [m/s]. Local.
  virtual Point<dim> wall_velocity(int, int, double) const { return Point<dim>::Zero(); }
  /// Axes along which what leaves at one side comes in at the other; of solids, those that
  /// `RepeatedSolids` repeats do. Default: none. The same on every rank. Local.
  virtual std::array<bool, dim> periodic_axes() const { return {}; }
  /// True if there is such an axis: then torques have no common origin. Local.
  bool is_periodic() const {
    const std::array<bool, dim> axes = periodic_axes();
    return std::any_of(axes.begin(), axes.end(), [](bool one) { return one; });
  }
  /// Returns the fluxes through its sides at `time`, one by one, those of sides that are shut then
  /// too: so that a run can say whose motion closed fluid has no room for. Local.
  virtual std::vector<PrescribedFlux> side_fluxes(double /*time*/) const { return {}; }

  // The pressure of the last step: the initial guess of the solves, and what the viscous solve
  // reads.

  /// p̂ of the last accepted step on the present unknowns, carried on to those where there was none.
  /// Default: zero, it is not kept.
  virtual RCP<Vector> last_scaled_pressure() const { return make_vector(pressure_map()); }
  /// Adds to the scaled pressure of the last `project` what `accept` keeps with it: of each unknown
  /// `inflow` [Pa s m^dim] over the volume of its cell. Changes no velocity.
  virtual void correct_pressure(const Vector& /*inflow*/) {}

  // Sides: what else it can do, each an object of its own. Null: it cannot; the same in all of a
  // run and on all ranks. Local.

  virtual const AuditedFluid<dim>* audit() const { return nullptr; }
  virtual EnergyFluid<dim>* energy() const { return nullptr; }
  virtual GasFluid<dim>* gas() { return nullptr; }  ///< null: none is ever trapped
  virtual const LiquidFluid<dim>* liquid() const { return nullptr; }  ///< null: no free surface
  virtual const FluidOutput<dim>* output() const { return nullptr; }
  virtual ViscousFluid<dim>* viscosity() { return nullptr; }  ///< null: inviscid in this scene

 protected:
  FluidDiscretization() = default;
  FluidDiscretization(const FluidDiscretization&) = delete;
  FluidDiscretization& operator=(const FluidDiscretization&) = delete;

 private:
  /// Makes the geometry for `set_geometry`; the result stays valid and unchanged until the next
  /// call.
  virtual const FluidGeometry<dim>& freeze(const Surface& surface,
                                           const OpenFractionRule<dim>& rule) = 0;

  const FluidGeometry<dim>* frozen_ = nullptr;
};

template <int dim>
double FluidDiscretization<dim>::suggested_step(double n_cells, double solid_speed) const {
  const double speed = std::max(largest_speed(), solid_speed);
  const double distance = n_cells * smallest_length();
  const double acceleration = gravity().template lpNorm<1>();
  return 2 * distance / (speed + std::sqrt(speed * speed + 4 * acceleration * distance));
}

}  // namespace lockstep
