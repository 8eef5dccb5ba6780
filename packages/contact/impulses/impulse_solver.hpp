#pragma once
#include <vector>

#include "contact/impulses/contact_row.hpp"
#include "contact/impulses/limit_impulses.hpp"
#include "contact/impulses/mobility.hpp"
#include "interfaces/contact.hpp"

namespace lockstep {

/// Block Gauss-Seidel for contact impulses: normal ones that only push, so that the normal velocity
/// reaches a target, and Coulomb friction, each contact exactly while the others stay. Every
/// impulse acts at one point on both solids with opposite signs. Local, the same on all ranks.
template <int dim>
class ImpulseSolver {
 public:
  ImpulseSolver(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                Mobility<dim>& mobility, std::vector<double> velocity);

  using Terms = std::vector<std::pair<GlobalIndex, double>>;  ///< dof and weight

  /// `target`: least normal velocity of `contact.solid` relative to the other [m/s]; `friction`:
  /// Coulomb's coefficient [1]. Adds nothing, and returns false, if no push of the contact changes
  /// that velocity. Collective if the mobility is.
  bool add(const Contact<dim>& contact, double target, double friction);
  /// A limit of joints: the sum of weights times velocities of dofs, of whatever unit, is not to be
  /// below `least`. Returns its number; -1, and adds nothing, if no impulse on it changes that sum.
  /// Collective if the mobility is.
  int add(const Terms& terms, double least);
  /// True if `add` would add it. Collective if the mobility is.
  bool can_move(const Contact<dim>& contact);
  bool can_move(const Terms& terms);
  /// Sweeps until no velocity at a contact changes by more than `tolerance` [m/s]; returns the
  /// number of sweeps. Limits of joints that contradict one another may be missed by `negligible`
  /// [m/s].
  int iterate(int maximum_sweeps, double tolerance, double negligible = 0);

  /// Number of contacts and joint limits.
  int n_contacts() const { return static_cast<int>(rows_.size()) + limits_.size(); }
  const std::vector<double>& velocity() const { return velocity_; }
  /// Impulse of the limit with this number: times the weights it acts on their dofs.
  double limit_impulse(int number) const { return limits_.impulse(number); }
  double limit_response(int number) const { return limits_.response(number); }
  /// J^T impulses, by id: on the dofs of the surfaces themselves, combinations or not.
  std::vector<double> generalized_impulse() const;
  /// Rows of contacts that push, for a coupled solve to hold.
  std::vector<HeldRow> held_rows() const;
  /// Pushes of contacts on prescribed solids: by the numbers of `held_rows`, and of friction that
  /// slides as it is.
  std::vector<PrescribedPush<dim>> held_pushes() const;
  /// Pushes on them by all impulses, as they are.
  std::vector<PrescribedPush<dim>> pushes() const;
  /// Moves given dofs from the weights of a row to its velocity and to `HeldRow::on_given`.
  void take_out_given(HeldRow& row) const;
  /// Impulses, by dof, of the friction of contacts that slide, and in `on_given` their part on
  /// given dofs.
  Terms sliding_impulse(Terms& on_given) const;
  /// Impulse of walls and prescribed solids on the others.
  Momentum<dim> external_impulse() const;

 private:
  struct Entry {
    int id;
    Point<dim> coefficient;
  };
  using Row = ContactRow<dim>;
  using Compliance = typename Row::Compliance;
  struct SweepReport {
    double change = 0;  ///< the largest one of a velocity at a contact or limit [m/s]
    double energy = 0;  ///< sum over contacts of the energy of its change alone [J]
  };

  /// With a response ids are numbers of active dofs, and `active_` their velocities; else they are
  /// dofs.
  bool responds() const { return !mobility_.response().is_null(); }
  std::vector<double>& velocity_by_id() { return responds() ? active_ : velocity_; }
  const std::vector<double>& velocity_by_id() const { return responds() ? active_ : velocity_; }
  int dof_of(int id) const { return responds() ? mobility_.active_dof(id) : id; }
  int activate(int dof);
  void extend_limits();
  void find_velocity();

  Row row_of(const Contact<dim>& contact, double friction);
  void forget_last(const Row& row);
  LimitImpulses::Row row_of(const Terms& terms);
  void add_side(Row& row, const ContactSide<dim>& side, double sign);
  void add_entries(Row& row, const SurfacePoint<dim>& point, const Point<dim>& x,
                   const Eigen::Matrix<double, dim, dim>& factor);
  void add_response(Row& row);
  void add_mass_response(Row& row, Compliance& compliance, double& of_parts);
  void find_response(const Row& row, Compliance& compliance, double& of_parts) const;
  Point<dim> relative_velocity(const Row& row) const;
  void push(const Row& row, const Point<dim>& impulse);
  void relax(Row& row, SweepReport& report);
  SweepReport sweep(double negligible);
  void go_on(double factor);
  /// Calls f(row, direction, target, impulse, response) for what a coupled solve is to hold.
  template <typename Function>
  void for_each_held(const Function& f) const;
  /// Adds what an impulse on a contact gives to its prescribed solids.
  void add_pushes(const Row& row, const Point<dim>& impulse, int number,
                  std::vector<PrescribedPush<dim>>& pushes) const;
  Terms impulse_on_both(const Row& row, const Point<dim>& impulse) const;

  const SolidSystem<dim>& system_;
  const ContactShapes<dim>& shapes_;
  Mobility<dim>& mobility_;
  std::vector<double> velocity_, active_, given_;
  VelocityRow<dim> velocity_row_;  ///< for use by add_entries alone
  std::vector<Row> rows_;
  std::vector<Entry> jacobian_, response_;
  LimitImpulses limits_;
};

}  // namespace lockstep
