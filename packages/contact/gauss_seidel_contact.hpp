#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "contact/bodies/inverse_mass.hpp"
#include "contact/impacts/impacts.hpp"
#include "contact/impulses/impulse_solver.hpp"
#include "contact/impulses/mobility.hpp"
#include "contact/search/contact_search.hpp"
#include "interfaces/contact.hpp"

namespace lockstep {

using SolidPairs = std::set<std::pair<int, int>>;

struct GaussSeidelOptions {
  int sweeps = 200;         ///< sweeps of block Gauss-Seidel over the final set of contacts
  double tolerance = 1e-4;  ///< change of velocities over the largest one wanted [1]
  double thickness = 0.1;   ///< thickness of shells and of the skins of deformable bodies [h]
  std::map<std::string, double> thickness_of;              ///< instead, by name of the solid [m]
  std::vector<std::pair<std::string, std::string>> apart;  ///< pairs that do not touch, by name
  std::optional<double> wall_friction, wall_restitution;   ///< default: those of the solid
};

/// Speculative contacts solved by block Gauss-Seidel through M_S. A contact with gap g must
/// have v_n >= -g / dt after the resolution. In the position phase overlaps are pushed out, and
/// whatever a vertex meets during dt is a contact; in the velocity phase only what is near by
/// counts (all near vertices of a face or a ball, or a fast one would be set spinning by the one
/// that touches), and restitution acts there. Motion is linear within dt: solids that turn by more
/// than about 0.3 rad a step overlap for a while.
///
/// Surfaces that are not rigid pass neither through each other nor through themselves: after the
/// resolution of positions, impacts along the way (`find_impacts`) become contacts until there are
/// none, and if that does not end, impact zones do (`join_impact_zones`); what these hold back, the
/// velocity phase that follows stops (`held_contacts`). Prescribed solids are
/// followed with their present velocities only. Their nodes are pushed by barycentric weights
/// through M_S; pinned ones do not yield, and their reactions are in the report. Where M_S is
/// consistent, lumped masses serve for the positions and, in the velocity phase, for the size of
/// the impulses, which then act through M_S itself: momentum is exact, velocities at contacts are
/// not. Solids whose elasticity is implicit are pushed through their response (M_S - dt D)^-1, as
/// whole bodies: pushed node by node, at steps longer than their stable one, they would be crushed.
///
/// Surfaces and velocities of all solids are replicated and every rank solves the same problem:
/// results do not depend on the number of ranks; the work, O(solids and their vertices), does not
/// shrink with it either.
template <int dim>
class GaussSeidelContact : public ContactModel<dim> {
 public:
  /// Walls: see `walls_of`; they are at rest if `wall_velocity` is empty. `grid_spacing` h [m].
  GaussSeidelContact(const GaussSeidelOptions& options, std::vector<HalfSpace> walls,
                     double grid_spacing, WallVelocity<dim> wall_velocity = {});

  std::string name() const override { return "gauss seidel"; }
  void begin_step(double time) override;
  using ContactModel<dim>::resolve;
  ContactReport<dim> resolve(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                             Vector& velocity, const ContactResponse& response) override {
    return act(solids, {phase, dt, response, Task::resolve}, velocity).report;
  }
  ContactReport<dim> decide(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                            Vector& velocity, const ContactResponse& response) override {
    return act(solids, {phase, dt, response, Task::decide}, velocity).report;
  }
  bool may_act(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
               const Vector& velocity) override {
    Vector copy(velocity, Teuchos::Copy);
    return act(solids, {phase, dt, {}, Task::look}, copy).acts;
  }

 private:
  enum class Task { look, decide, resolve };
  struct Request {
    ContactPhase phase;
    double dt;
    const ContactResponse& response;
    Task task;
  };
  struct Outcome {
    bool acts = false;  ///< there is something to act on
    ContactReport<dim> report;
  };
  /// Changes the velocity, but for Task::look.
  Outcome act(const SolidSystem<dim>& solids, const Request& request, Vector& velocity);
  Mobility<dim>& dense_mobility(const SolidSystem<dim>& solids, const ContactResponse& response);
  void move_walls(ContactPhase phase, double dt);
  const InverseMass& inverse_mass_of(const SolidSystem<dim>& solids);
  const SolidPairs& apart_among(const std::vector<SolidDescription>& solids);

  GaussSeidelOptions options_;
  std::vector<HalfSpace> walls_;
  double spacing_;
  WallVelocity<dim> wall_velocity_;
  double time_ = 0;  ///< at the beginning of the step [s]
  ContactTopology<dim> topology_;
  SolidPairs apart_;                  ///< `GaussSeidelOptions::apart` by number, in both orders
  std::vector<std::string> numbers_;  ///< numbers of solids with these names
  RCP<const LinearOperator> known_inverse_;  ///< inverse of which `inverse_mass_` is the copy
  InverseMass inverse_mass_;
  std::unique_ptr<Mobility<dim>> dense_mobility_;  ///< mobility in the last response of this step
  std::set<std::size_t> bouncing_;                 ///< see ContactProblem::keep_bouncing
  std::vector<FoundImpact<dim>> held_back_;  ///< by impact zones, in the positions of this step
  /// By phase, whether there was something to act on last time; results do not depend on it.
  std::array<bool, 2> acted_{};
};

/// Half spaces of the closed sides of a domain: [axis][lower, upper].
template <int dim>
std::vector<HalfSpace> walls_of(const Box<dim>& domain,
                                const std::array<std::array<bool, 2>, dim>& closed_sides);

}  // namespace lockstep
