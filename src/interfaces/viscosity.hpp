#pragma once
#include <memory>
#include <vector>

#include "interfaces/fluid.hpp"

namespace lockstep {

template <int dim>
class SolidSystem;

/// A viscous coupling between a free velocity and the solid: a force coefficient * (u_row -
/// v_solid) [N] on both, equal and opposite.
template <int dim>
struct ViscousCouplingTerm {
  int row = -1;             ///< local row of `ViscousSystem::stiffness`
  int coupled_volume = -1;  ///< >= 0: the neighbour is this coupled control volume (index), W V_S
  /// The neighbour is a coupled control volume of another rank, W V_S (`coupled_volume` is -1).
  std::shared_ptr<const ControlVolume<dim>> remote_volume;
  SurfacePoint<dim> point;  ///< else: the link meets the surface here
  int direction = 0;
  double coefficient = 0;  ///< [kg/s]
  Point<dim> position =
      Point<dim>::Zero();  ///< place of the free velocity, where the link pulls on the fluid [m]
  /// The other end [m]: a rigid solid is taken to move there as it does everywhere, even if its
  /// surface is a little nearer or farther. Across periodic sides where the solid is, not beside
  /// the velocity.
  Point<dim> end = Point<dim>::Zero();
  Point<dim> reach = Point<dim>::Zero();  ///< from the velocity to the other end [m]
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
  std::vector<ViscousCouplingTerm<dim>> links;
};

/// A side of fluids: viscosity, taken implicitly together with the solids.
template <int dim>
class ViscousFluid {
 public:
  virtual ~ViscousFluid() = default;
  /// The viscous solve must read the pressure that the forces on u* call for, which is one more
  /// solve. False: the last step's will do. Local.
  virtual bool wants_present_pressure() const { return false; }
  /// Returns the viscous system of the present u*. Collective.
  virtual std::unique_ptr<ViscousSystem<dim>> viscous_system() const = 0;
  /// Returns the impulse of walls, open sides and the internal couple of the scheme over dt, each
  /// computed from the tractions of `solution`, global; u* := `velocity` on free velocities, which
  /// is u* plus exactly the impulses of `solution` (the two differ by the solver's residual over
  /// M). Collective.
  virtual Momentum<dim> accept_viscous(const Vector& solution, const Vector& velocity,
                                       double dt) = 0;
};

/// The part of a viscous link's end that follows one point of a surface.
template <int dim>
struct EndShare {
  double weight = 0;
  SurfacePoint<dim> point;
  bool prescribed = false;                 ///< its solid is
  Point<dim> pulled = Point<dim>::Zero();  ///< where the link pulls on it [m]
};

/// Row of the dynamic solids (ids of SolidSystem's map) and the prescribed velocity at a viscous
/// link.
template <int dim>
struct EndVelocity {
  std::vector<GlobalIndex> dofs;
  std::vector<double> weights;
  double prescribed = 0;                     ///< velocity that prescribed solids contribute [m/s]
  double prescribed_share = 0;               ///< their part of the link, 0..1
  int prescribed_solid = -1;                 ///< one of them: the last with a share
  Point<dim> position = Point<dim>::Zero();  ///< where the link pulls on the solid [m]
  int solid = -1;                            ///< the one with the largest share
  std::vector<EndShare<dim>> shares;         ///< weights sum to one
};

/// A side interface of couplings: the solid end of viscous couplings. A viscous fluid among solids
/// needs it.
template <int dim>
class ViscousCoupling {
 public:
  virtual ~ViscousCoupling() = default;
  /// Computes the row of one coupling; `assemble` and the surface it was given must still be valid.
  /// Local.
  virtual void link_row(const ViscousCouplingTerm<dim>& link, const SolidSystem<dim>& solids,
                        EndVelocity<dim>& row) const = 0;
};

}  // namespace lockstep
