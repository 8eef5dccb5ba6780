#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "linear/types.hpp"

namespace lockstep {

template <int dim>
class SolidSystem;

/// A condition that active contacts put on the velocities: the sum of weights times dofs is
/// `velocity`. A coupled solve holds it.
struct HeldRow {
  /// By dof of the stack, given ones left out, combinations by themselves; the same on all ranks.
  std::vector<std::pair<GlobalIndex, double>> weights;
  double velocity = 0;    ///< [m/s]
  double impulse = 0;     ///< found by the contact model [kg m/s]
  double response = 0;    ///< velocity per impulse in the model's response [1/kg]
  bool is_limit = false;  ///< true for a limit of a joint
  std::vector<std::pair<GlobalIndex, double>> on_given{};  ///< weights of given dofs
  double stiffness = 0;  ///< K of the row where a coupled solve holds it [kg]
};

/// Impulse of contact on a prescribed solid, of which no solve knows.
template <int dim>
struct PrescribedPush {
  static constexpr int whole = -1;
  int row = whole;  ///< held row of whose unit of impulse this is; `whole`: the impulse itself
  int solid = -1;   ///< among all solids
  Momentum<dim> impulse;
};

/// Result of one resolution of contacts.
template <int dim>
struct ContactReport {
  int n_contacts = 0;  ///< number of contacts and joint limits
  int iterations = 0;
  int n_solves = 0;     ///< coupled solves that held them
  double residual = 0;  ///< velocity at contacts that the last of these solves has left [m/s]
  int n_outside = 0;    ///< phases in which they acted outside of the coupled solve: 0 or 1
  int n_crossings = 0;  ///< crossings of surfaces that are not rigid, which could not be prevented
  double deepest_overlap = 0;      ///< before resolution; 0 where nothing is resolved [m]
  Momentum<dim> external_impulse;  ///< from walls and prescribed solids on the dynamic ones, global
  RCP<const Vector> impulse;  ///< generalized, on the free dofs, if there was a `ContactResponse`
  /// Generalized reactions of constraints while contact acted, which no solve contains, as
  /// `Reduction::keep_reactions` leaves them. Null: there are none.
  RCP<const Vector> reactions;
  /// Rows of contacts that push, normal ones and the tangential ones of what sticks, and of limits
  /// that do, and the generalized impulse, by dof, of the friction of what slides; if there was a
  /// `ContactResponse`.
  std::vector<HeldRow> held;
  std::vector<std::pair<GlobalIndex, double>> sliding;
  std::vector<std::pair<GlobalIndex, double>> sliding_on_given;  ///< its part on given dofs
  RCP<const Vector> impulse_on_given;  ///< generalized, on given dofs alone; null: none are given
  std::vector<PrescribedPush<dim>> on_prescribed;
  /// Impulses of joint limits, each with the dof of its coordinate; the same on all ranks.
  std::vector<std::pair<GlobalIndex, double>> limit_impulses;
};

/// Returns the operator from generalized impulses on the free dofs to changes of velocity, if it is
/// not M_S^-1: (M_S - dt D)^-1 of solids whose inner forces answer within the step, or that of
/// solids with the fluid around them. Called only if a contact acts. Collective.
using ContactResponse = std::function<RCP<const LinearOperator>()>;

/// Velocity of the wall of the domain at an end (0 lower, 1 upper) of an axis, tangential to the
/// wall, at a time [m/s]. Local, the same on all ranks.
template <int dim>
using WallVelocity = std::function<Point<dim>(int axis, int end, double time)>;

/// The two places of a step at which contacts are resolved.
enum class ContactPhase {
  position,  ///< S1: V^{n+1/2} moves the positions; existing overlap is pushed out
  velocity   ///< S2: the velocities of t^{n+1}; only approach is stopped
};

/// Collisions, resting contact and friction across all solids and with the walls of the domain.
template <int dim>
class ContactModel : public PlugIn {
 public:
  /// A step begins at `time` [s]; what is resolved until the next call is of it. Default: nothing.
  /// Local.
  virtual void begin_step(double) {}
  /// Changes the stacked generalized velocities by contact impulses (equal and opposite between
  /// dynamic solids, through the solids' own mass M_S or the given response) so that moving by dt
  /// from the present positions leaves no overlap. Collective.
  virtual ContactReport<dim> resolve(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                                     Vector& velocity, const ContactResponse& response) = 0;
  ContactReport<dim> resolve(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                             Vector& velocity) {
    return resolve(solids, phase, dt, velocity, {});
  }
  /// Decides which contacts push, and how, for a coupled solve to hold: as `resolve` with this
  /// response, but to the accuracy that a solve compares with, and without what only the way of
  /// soft surfaces asks for. Collective.
  virtual ContactReport<dim> decide(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                                    Vector& velocity, const ContactResponse& response) {
    return resolve(solids, phase, dt, velocity, response);
  }
  /// False if nothing is near enough to touch at these velocities, so that the response need not be
  /// known. Changes nothing that a later decision depends on. Collective.
  virtual bool may_act(const SolidSystem<dim>&, ContactPhase, double, const Vector&) {
    return true;
  }
};

}  // namespace lockstep
