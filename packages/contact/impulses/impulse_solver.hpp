#pragma once
#include <vector>

#include "contact/bodies/contact_side.hpp"
#include "contact/impulses/coulomb.hpp"
#include "contact/impulses/limit_impulses.hpp"
#include "contact/impulses/mobility.hpp"
#include "contact/search/contact_search.hpp"
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
  using Compliance = Eigen::Matrix<double, dim, dim>;
  struct SweepReport {
    double change = 0;  ///< the largest one of a velocity at a contact or limit [m/s]
    double energy = 0;  ///< sum over contacts of the energy of its change alone [J]
  };
  struct Row {
    Contact<dim> contact;
    int begin = 0, end = 0;                      ///< in `jacobian_`
    int response_begin = 0, response_end = 0;    ///< in `response_`: M_S^-1 J^T, without a response
    Point<dim> prescribed = Point<dim>::Zero();  ///< velocity that no impulse changes
    Point<dim> of_given = Point<dim>::Zero();    ///< its part of prescribed solids and walls
    double target = 0;
    double normal_response = 0, tangent_response = 0;  ///< velocity per impulse [1/kg]
    bool solid_prescribed = false, other_prescribed = false;
    Compliance frame = Compliance::Zero();      ///< columns: the normal, then the tangents
    CoulombContact<dim> law;                    ///< in the frame
    Point<dim> impulse = Point<dim>::Zero();    ///< in the frame [kg m/s]
    Point<dim> change = Point<dim>::Zero();     ///< by the last sweep, in the frame
    Point<dim> direction = Point<dim>::Zero();  ///< last one of conjugate gradients, in the frame
    bool pushes() const { return impulse[0] > 0; }
    /// The impulse of friction.
    Point<dim> of_friction() const {
      return frame.template rightCols<dim - 1>() * impulse.template tail<dim - 1>();
    }
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
  bool slides(const Row& row) const;
  /// Calls f(row, direction, target, impulse, response) for what a coupled solve is to hold.
  template <typename Function>
  void for_each_held(const Function& f) const;
  /// Adds what an impulse on a contact gives to its prescribed solids.
  void add_pushes(const Row& row, const Point<dim>& impulse, int number,
                  std::vector<PrescribedPush<dim>>& pushes) const;
  ContactSide<dim> solid_of(const Row& row) const;
  ContactSide<dim> other_of(const Row& row) const;
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
