#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "linear/types.hpp"

namespace lockstep {

struct BoxFrame;  // output/frames.hpp

/// One side of a velocity control volume.
template <int dim>
struct PressureSide {
  GlobalIndex unknown =
      no_index;  ///< id in `pressure_map`, or no_index: no pressure (solid, void, open side)
  Point<dim> center = Point<dim>::Zero();  ///< where the pressure lives [m]
  bool inside_solid = false;               ///< the point lies inside a closed solid
  int solid = -1;                          ///< which one (index in the snapshot), or -1
};

/// The control volume of one staggered velocity (a dual cell). Its momentum balance is
/// M u' = M u* - area (p̂_upper - p̂_lower) (Eq. 9).
template <int dim>
struct ControlVolume {
  int direction = 0;                            ///< axis of its velocity
  Point<dim> center = Point<dim>::Zero();       ///< R_f [m]
  Box<dim> box;                                 ///< the dual cell; half of it at an open side
  double density = 0;                           ///< of its fluid [kg/m^3]
  double area = 0;                              ///< of the face, V |G| [m^(dim-1)]
  std::array<PressureSide<dim>, 2> sides;       ///< lower, upper along `direction`
  double open_fraction = 1;                     ///< alpha_f, as the coupling's rule answered
  Point<dim> open_center = Point<dim>::Zero();  ///< where its fluid moves: R_f unless partly open
  bool seen_by_fluid = true;  ///< a fluid cell beside it sees its centre without crossing a surface
  /// On a wall or an inflow: the velocity of its open part is prescribed, no fluid moves in it.
  bool at_prescribed_side = false;
  GlobalIndex id = no_index;  ///< the fluid's own number; the same on any number of ranks
};

/// Decides how far a control volume is open to the fluid: 1 free, 0 closed (mixed, after the
/// paper), between: the face fraction of a cut-cell coupling. Called for every control volume near
/// a surface that has a fluid cell on at least one side.
template <int dim>
class OpenFractionRule {
 public:
  virtual ~OpenFractionRule() = default;
  /// `blocked`: the segment between its two pressure points meets the surface.
  virtual double open_fraction(const ControlVolume<dim>& volume, bool blocked,
                               const SurfaceSnapshot<dim>& surface) const = 0;
  /// False: cells whose centre is inside a closed solid carry no pressure, and their faces are
  /// closed. True: every cell with an open face does, wherever its centre is.
  virtual bool cuts_cells() const { return false; }
  /// Centroid of the open part of a face whose open fraction is between 0 and 1: there its momentum
  /// counts. Default: the centre of the face.
  virtual Point<dim> open_center(const ControlVolume<dim>& volume,
                                 const SurfaceSnapshot<dim>&) const {
    return volume.center;
  }
};

/// The surfaces of one step, from t^n to t^{n+1}, and how fast they move.
template <int dim>
struct MovingSurface {
  std::shared_ptr<const SurfaceSnapshot<dim>> before;  ///< at t^n
  std::shared_ptr<const SurfaceSnapshot<dim>> after;   ///< at t^{n+1}
  /// Velocity of a surface point [m/s] as F2 uses it: displacement over dt.
  std::function<Point<dim>(const SurfacePoint<dim>&)> velocity;
};

/// Connected components of the pressure unknowns through free faces (regions, design: null space).
struct PressureRegions {
  int n_regions = 0;                ///< over all ranks
  std::vector<int> of_unknown;      ///< region of each local pressure unknown
  std::vector<char> has_dirichlet;  ///< per region: some face fixes the pressure level
};

/// A viscous bond from a free velocity to the solid: it pulls with
/// coefficient * (u_row - v_solid) [N] on both, equal and opposite.
template <int dim>
struct ViscousLink {
  int row = -1;             ///< local row of `ViscousSystem::stiffness`
  int coupled_volume = -1;  ///< >= 0: the neighbour is this coupled control volume (index), W V_S
  /// The neighbour is a coupled control volume of another rank, W V_S (`coupled_volume` is -1).
  std::shared_ptr<const ControlVolume<dim>> remote_volume;
  SurfacePoint<dim> point;  ///< else: the link meets the surface here
  int direction = 0;
  double coefficient = 0;  ///< [kg/s]
  Point<dim> position =
      Point<dim>::Zero();  ///< of the free velocity: where the link pulls on the fluid [m]
  /// The other end [m]: a rigid solid is taken to move there as it does everywhere, even if its
  /// surface is a little nearer or farther.
  Point<dim> end = Point<dim>::Zero();
};

/// Implicit viscosity in variational form: (M + dt K) u = M u* over the free velocities, SPD.
template <int dim>
struct ViscousSystem {
  RCP<const Map> map;              ///< free velocities
  RCP<const CrsMatrix> stiffness;  ///< K_ff [kg/s], with the diagonal of all links and walls
  RCP<Vector> mass;                ///< M_f [kg]
  RCP<Vector> velocity;            ///< u* [m/s]
  RCP<Vector> wall_force;          ///< pull of moving walls and inflows [N]
  double viscosity = 0;            ///< dynamic, mu [Pa s]
  std::vector<ViscousLink<dim>> links;
};

/// A fluid on its own discretization. Geometry is frozen between two calls of `set_geometry`.
///
/// It keeps three velocity fields: the velocity u^n, the prediction u* on which all phases between
/// `begin_prediction` and `accept` act, and the leak-proof advection velocity u_ADV.
/// All members are collective unless they say otherwise.
template <int dim>
class FluidDiscretization : public PlugIn {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  // Geometry and the pressure system (Eq. 16, block A).

  /// Freezes the geometry: cell states, coupled control volumes, pressure unknowns, regions, A.
  virtual void set_geometry(const Surface& surface, const OpenFractionRule<dim>& rule) = 0;
  /// Control volumes with open_fraction < 1 and at least one pressure unknown, owned here. Local.
  virtual const std::vector<ControlVolume<dim>>& coupled_volumes() const = 0;
  virtual RCP<const Map> pressure_map() const = 0;
  /// A = V G_f^T rho^-1 G_f over free faces [m^dim s / kg * 1/m^2]; symmetric positive
  /// semidefinite.
  virtual RCP<const LinearOperator> pressure_block() const = 0;
  virtual const PressureRegions& regions() const = 0;
  /// rhs = V G_f^T u* + V G_d^T u_d: minus the outflow of the free and the prescribed faces
  /// [m^dim/s].
  virtual void divergence(Vector& rhs) const = 0;
  /// u* -= rho^-1 G p̂ on free faces (F2, F4). p̂ = dt p [Pa s].
  virtual void project(const Vector& scaled_pressure) = 0;
  /// u* of the coupled control volumes, in their order [m/s]. Local.
  virtual std::vector<double> coupled_velocity() const = 0;
  virtual void set_coupled_velocity(const std::vector<double>& velocity) = 0;

  // The phases of a step.

  virtual void begin_prediction() = 0;  ///< u* := u^n
  /// u* := the velocity to carry things over a step of dt, before F2 makes it free of divergence:
  /// u^n, or nearer to the middle of the step.
  virtual void begin_advection_velocity(double /*dt*/) { begin_prediction(); }
  /// u* += dt f on all velocities outside solids; returns the impulse given to the free ones,
  /// global.
  virtual Momentum<dim> add_forces(double time, double dt) = 0;
  /// The dt f that `add_forces` adds to each coupled control volume [m/s]. Local.
  virtual std::vector<double> coupled_force(double time, double dt) const = 0;
  /// False: no viscous solve exists, and the two functions below are never called. Local.
  virtual bool is_viscous() const { return false; }
  virtual std::unique_ptr<ViscousSystem<dim>> viscous_system() const { return nullptr; }
  /// Returns the impulse of walls, open sides and the internal couple of the scheme over dt, each
  /// computed from the tractions of `solution`, global; u* := `velocity` on free velocities, which
  /// is u* plus exactly the impulses of `solution` (the two differ by the solver's residual over
  /// M).
  virtual Momentum<dim> accept_viscous(const Vector& solution, const Vector& velocity, double dt);
  virtual void adopt_advection_velocity() = 0;  ///< u_ADV := u* (end of F2)
  /// F3: u* := u^n carried along u_ADV, and all scalars; rays stop at the moving surfaces and see
  /// only samples on their own side. Called before `set_geometry` of the new surfaces.
  virtual void advect(double time, double dt, const MovingSurface<dim>& surface) = 0;
  /// Gives values to samples that a surface swept over or uncovered, from visible neighbours.
  /// Called after `set_geometry` of the new surfaces.
  virtual void revalidate(const MovingSurface<dim>& surface) = 0;
  /// Adds to the scaled pressure of the last `project` what `accept` keeps with it for
  /// `last_scaled_pressure`; changes no velocity. Default: nothing.
  virtual void correct_pressure(const Vector& /*scaled_increment*/) {}
  virtual void accept() = 0;  ///< u^n := u* (end of the step)

  // What the step and the outputs need to know.

  virtual double largest_cell_crossing_rate() const = 0;  ///< max sum_a |u_a|/h over u^n [1/s]
  virtual double spacing() const = 0;                     ///< h [m]
  virtual Point<dim> gravity() const = 0;                 ///< uniform acceleration [m/s^2]
  /// Density of the fluid at x [kg/m^dim], for the buoyancy of bodies too small for the grid to
  /// see. Default 0: such bodies feel none.
  virtual double density(const Point<dim>&) const { return 0; }
  virtual Momentum<dim> momentum() const = 0;  ///< of u* on free faces, global
  virtual double kinetic_energy() const = 0;   ///< of u* on free faces [J], global
  /// Impulse of walls and open sides through their own pressure [kg m/s], global.
  virtual Momentum<dim> boundary_pressure_impulse(const Vector& scaled_pressure) const = 0;
  virtual double fluid_volume() const = 0;  ///< of active cells [m^dim], global
  /// p̂ of the last accepted step on the present unknowns, carried on to those where there was none:
  /// the initial guess of the solves, and what the viscous solve reads. Default: zero.
  virtual RCP<Vector> last_scaled_pressure() const;
  /// What its sides let in at `time`, one by one, whether they do at that time or not. Local.
  virtual std::vector<PrescribedFlux> side_fluxes(double /*time*/) const { return {}; }
  /// Called at the start of a step: puts back, when it is called in turn before `accept`, all that
  /// `save` writes and the phases of a step change. Default: nothing is.
  virtual std::function<void()> undo() {
    return [] {};
  }
  /// Lines for `--explain`, title and text: how the grid has taken what the scene asks for.
  virtual std::vector<std::pair<std::string, std::string>> notes() const { return {}; }
  /// Adds its cell-centred fields to a frame. Default: none.
  virtual void add_frame(std::vector<BoxFrame>& boxes) const;
};

template <int dim>
Momentum<dim> FluidDiscretization<dim>::accept_viscous(const Vector&, const Vector&, double) {
  return {};
}
template <int dim>
RCP<Vector> FluidDiscretization<dim>::last_scaled_pressure() const {
  return make_vector(pressure_map());
}
template <int dim>
void FluidDiscretization<dim>::add_frame(std::vector<BoxFrame>&) const {}

}  // namespace lockstep
