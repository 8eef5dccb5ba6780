#pragma once
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "contact/contact_law.hpp"
#include "contact/impacts/impacts.hpp"

namespace lockstep {

/// Gap below which surfaces are watched whatever their motion [h]; faster motion is followed along
/// its path, and what moves farther than half of it is looked for again (`extend_search`). Chosen,
/// not varied by a page.
constexpr double watched_gap = 0.1;

/// Walls and options of contact, and pairs of solids that have none.
struct ContactConditions {
  const std::vector<HalfSpace>& walls;
  const GaussSeidelOptions& options;
  const SolidPairs& apart;  ///< pairs that do not touch, in both orders
  double spacing = 0;       ///< grid spacing h [m]
};

/// One resolution of contacts: candidates from the search, of which those that would be violated
/// become active, a few for every pair of rigid solids, until none is left violated; for positions
/// also the impacts of surfaces that are not rigid. Local, the same on all ranks.
template <int dim>
class ContactProblem {
 public:
  /// The system, the shapes and what the setting refers to must outlive this; dt [s].
  ContactProblem(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                 const ContactConditions& setting, ContactPhase phase, double dt);

  /// Contacts that bounce by an earlier decision of this step, by `ContactLaw::bounce_key`: they
  /// bounce in this one, too, which adds its own. Decisions that a coupled solve asks for one after
  /// the other would go to and fro between a bounce and none. Before `prepare`.
  void keep_bouncing(std::set<std::size_t>& bouncing) { bouncing_ = &bouncing; }
  /// Leaves impacts along the way of soft surfaces to a later resolution; before `prepare`.
  void leave_impacts() { leaves_impacts_ = true; }
  /// Contacts that act without friction, as if they touched, wherever they are; before `prepare`.
  void hold(std::vector<Contact<dim>> contacts) { held_ = std::move(contacts); }
  /// Finds the candidates; false if there is nothing to act on. `before`: V_S at the beginning of
  /// the step, `velocity`: the one to change; both by id. If none is `expected`, most of the
  /// pairs of a solid that is not rigid with itself are skipped at first.
  bool prepare(const std::vector<double>& before, const std::vector<double>& velocity,
               bool expected);
  /// Solves; returns the number of sweeps.
  int solve(ImpulseSolver<dim>& solver);

  double deepest_overlap() const;
  /// See `SurfacePath`: of the velocities given to `prepare`; empty where it does not matter.
  const std::vector<Point<dim>>& unheld() const { return unheld_; }
  /// Returns the rows of contacts and joint limits that push, for a coupled solve to hold.
  std::vector<HeldRow> held_rows(const ImpulseSolver<dim>& solver) const;
  /// Returns the impulses of joint limits, each with the dof of its coordinate.
  std::vector<std::pair<GlobalIndex, double>> limit_impulses(
      const ImpulseSolver<dim>& solver) const;

 private:
  struct Candidate {
    Contact<dim> contact;
    double target = 0;    ///< least normal velocity [m/s]
    bool active = false;  ///< true also if nothing moves along it
  };
  /// A limit of a coordinate of a joint.
  struct Limit {
    JointLimit limit;
    std::vector<std::pair<GlobalIndex, double>> resolved;  ///< terms by dofs that others follow
    double target = 0;                                     ///< least value of its combination [m/s]
    bool active = false;                                   ///< true also if nothing moves it
    int number = -1;                                       ///< in the solver
    double value(const std::vector<double>& velocity) const {
      double sum = 0;
      for (const auto& [dof, weight] : resolved)
        sum += weight * velocity[dof];
      return sum;
    }
  };
  using Pair = std::pair<int, int>;

  /// Returns how far the search has to look for a motion.
  ContactReach reach(const SolidMotion<dim>& motion) const;
  /// The largest violation, not less than 0 [m/s]. Keeps no candidates.
  double worst_violation(const SolidMotion<dim>& motion, const SolidMotion<dim>& before);
  /// True for pairs that do not touch: those of `apart`, and those of which one is glued to the
  /// other.
  bool is_apart(const Contact<dim>& contact) const;
  bool is_known(const Contact<dim>& contact) const;
  /// `unheld`: nothing has acted on the motion yet.
  void add_candidates(const SolidMotion<dim>& motion, const SolidMotion<dim>& before,
                      bool unheld = true);
  /// Returns the largest violation of inactive contacts and limits [m/s].
  double largest_violation(const SolidMotion<dim>& motion,
                           const std::vector<double>& velocity) const;
  void find_scale(const SolidMotion<dim>& motion, const std::vector<double>& velocity);
  /// Throws SolveError if a contact that nothing can move is deep: what is driven does not stop.
  void check_room(const Contact<dim>& contact) const;
  /// Leaves out contacts and limits along which nothing can move: no impulse would change them.
  void leave_out_immovable(ImpulseSolver<dim>& solver);
  /// Activates a candidate; returns false if nothing moves along it.
  bool activate(Candidate& candidate, ImpulseSolver<dim>& solver) const;
  /// Activates up to `most` candidates of every pair, the most violated first, then those farthest
  /// from the others; returns how many.
  int activate_violated(const SolidMotion<dim>& motion, int most, double tolerance,
                        ImpulseSolver<dim>& solver);
  /// Activates those limits of joints that are violated; returns how many.
  int activate_limits(const std::vector<double>& velocity, double tolerance,
                      ImpulseSolver<dim>& solver);
  /// Does at most `most` sweeps; returns their number.
  int sweep(ImpulseSolver<dim>& solver, int most) const;
  /// Looks again if the solution moves solids farther than the search had looked.
  void extend_search(const std::vector<double>& velocity);
  bool follows_impacts() const;
  /// Returns the contacts that prevent the impacts to which these velocities lead.
  std::vector<Contact<dim>> impacts_of(const std::vector<double>& velocity) const;
  /// Returns the number of sweeps.
  int stop_impacts(ImpulseSolver<dim>& solver) const;

  const SolidSystem<dim>& system_;
  const ContactShapes<dim>& shapes_;
  const std::vector<HalfSpace>& walls_;
  const GaussSeidelOptions& options_;
  const SolidPairs& apart_;  ///< pairs that do not touch, in both orders
  double spacing_;
  ContactPhase phase_;
  double dt_;
  ContactLaw<dim> law_;
  std::vector<double> before_;
  std::vector<Point<dim>> unheld_;
  std::vector<Box<dim>> searched_;  ///< velocities of the solids that the search has followed
  std::vector<Candidate> candidates_;
  std::vector<Contact<dim>> held_;
  bool leaves_impacts_ = false;
  std::set<std::size_t>* bouncing_ = nullptr;  ///< null: none is kept
  std::vector<Limit> limits_;
  std::map<Pair, std::vector<int>> pairs_;                      ///< candidates of each pair
  std::unordered_map<std::size_t, std::vector<int>> by_place_;  ///< candidates by hash_of
  double scale_ = 0;    ///< largest violation at the start, of movable contacts and limits [m/s]
  double deepest_ = 0;  ///< overlap of what is no candidate [m]
};

}  // namespace lockstep
