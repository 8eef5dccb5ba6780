#pragma once
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// What lies on one side of a velocity control volume.
enum class SideKind : char {
  unknown,  ///< a pressure that is solved for
  solid,    ///< the inside of a closed solid
  empty,    ///< a void, p = 0
  open,     ///< an open side of the domain, p = 0
  closed    ///< a wall or an inflow, which takes any pressure
};

/// One side of a velocity control volume.
template <int dim>
struct PressureSide {
  SideKind kind = SideKind::open;
  GlobalIndex unknown = no_index;          ///< id in `pressure_map` if the kind is `unknown`
  Point<dim> center = Point<dim>::Zero();  ///< where the pressure lives [m]
  int solid = -1;   ///< which one (index in the snapshot) if the kind is `solid`, or -1
  int pocket = -1;  ///< of gas, if the kind is `empty` and it is one (interfaces/gas.hpp), or -1
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

  /// No pressure unknown is beside it: of what it moves nothing is fluid.
  bool only_gas() const { return sides[0].unknown == no_index && sides[1].unknown == no_index; }
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

/// What `set_geometry` freezes.
template <int dim>
struct FluidGeometry {
  /// Control volumes with open_fraction < 1 and at least one pressure unknown or pocket of gas,
  /// owned here.
  std::vector<ControlVolume<dim>> coupled_volumes;
  RCP<const Map> pressure_map;
  /// A = V G_f^T rho^-1 G_f over free faces [m^dim s / kg * 1/m^2]; symmetric positive
  /// semidefinite.
  RCP<const LinearOperator> pressure_block;
  PressureRegions regions;
  double volume = 0;  ///< of the fluid [m^dim], global
};

/// What the explicit forces of a step did.
template <int dim>
struct ForceImpulse {
  Momentum<dim> impulse;               ///< given to the free velocities, global
  std::vector<double> coupled_change;  ///< of each coupled control volume's u* [m/s]
};

/// A fluid on its own discretization. Geometry is frozen between two calls of `set_geometry`.
///
/// It keeps three velocity fields: the velocity u^n, the prediction u* on which all stages between
/// `begin_prediction` and `accept` act, and the leak-proof advection velocity u_ADV. What audits,
/// solvers and outputs want beyond this: interfaces/fluid_sides.hpp; viscosity: viscosity.hpp.
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
  /// What it froze. Local.
  const std::vector<ControlVolume<dim>>& coupled_volumes() const {
    return frozen_->coupled_volumes;
  }
  const RCP<const Map>& pressure_map() const { return frozen_->pressure_map; }
  const RCP<const LinearOperator>& pressure_block() const { return frozen_->pressure_block; }
  const PressureRegions& regions() const { return frozen_->regions; }
  double fluid_volume() const { return frozen_->volume; }

  /// rhs = V G_f^T u* + V G_d^T u_d: minus the outflow of the free and the prescribed faces
  /// [m^dim/s].
  virtual void divergence(Vector& rhs) const = 0;
  /// u* -= rho^-1 G p̂ on free faces (F2, F4). p̂ = dt p [Pa s].
  virtual void project(const Vector& scaled_pressure) = 0;
  /// u* of the coupled control volumes, in their order [m/s]. Local.
  virtual std::vector<double> coupled_velocity() const = 0;
  /// u* of those that are closed (open fraction 0); a partly open one keeps its own.
  virtual void set_coupled_velocity(const std::vector<double>& velocity) = 0;

  // The stages of a step.

  /// A step from `time` to time + dt begins: room may be made where things will move. True if
  /// u^n lives on other cells than when it was accepted, without being free of divergence there:
  /// then the geometry is to be frozen anew. `solid_speed`: that of the fastest solid [m/s];
  /// collective, for those who want it. Default: the fluid always has room.
  virtual bool begin_step(double /*time*/, double /*dt*/,
                          const std::function<double()>& /*solid_speed*/) {
    return false;
  }
  virtual void begin_prediction() = 0;  ///< u* := u^n
  /// u* := the velocity to carry things over a step of dt, before F2 makes it free of divergence:
  /// u^n, or nearer to the middle of the step. True if it is as free of divergence as u^n where
  /// there are no solids, so that F2 has nothing to do; the same on all ranks.
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
  virtual void revalidate(const MovingSurface<dim>&) {}
  virtual void accept() = 0;  ///< u^n := u* (end of the step)

  // What the step and the solids need to know.

  /// The shortest distance that it resolves [m]: h of its smallest cells. Local.
  virtual double smallest_length() const = 0;
  /// Largest sum_a |u_a| of u^n [m/s].
  virtual double largest_speed() const = 0;
  /// A step in which neither the fluid nor a solid of that speed [m/s] crosses more than so many
  /// cells; the velocity that gravity adds within the step counts as well. Infinite at rest.
  /// Default: all cells are as small as the smallest.
  virtual double suggested_step(double n_cells, double solid_speed) const;
  /// The longest step that is stable [s]; waves on a free surface bound it. Default: any is. Local.
  virtual double largest_stable_step() const { return 1e300; }
  /// True if its own geometry changes from step to step, as that of a free surface does: then it is
  /// frozen anew after `advect`, solids or not. The same on all ranks. Local.
  virtual bool geometry_changes() const { return false; }
  /// Uniform acceleration [m/s^2]. Local.
  virtual Point<dim> gravity() const { return Point<dim>::Zero(); }
  /// Density of the fluid at x [kg/m^dim], for the buoyancy of bodies too small for the grid to
  /// see. Default 0: such bodies feel none. Local.
  virtual double density(const Point<dim>&) const { return 0; }

 protected:
  FluidDiscretization() = default;
  FluidDiscretization(const FluidDiscretization&) = delete;
  FluidDiscretization& operator=(const FluidDiscretization&) = delete;

 private:
  /// For `set_geometry`; what is returned stays valid and unchanged until the next call.
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
