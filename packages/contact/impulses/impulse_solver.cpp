#include "contact/impulses/impulse_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace lockstep {

namespace {
/// Below this part of what its dofs would answer one by one, the response of a contact or a limit
/// is the round-off of joints that let nothing move along it.
constexpr double unmovable = 1e-10;

/// Factors of nonlinear conjugate gradients by the energies of sweeps. Contacts that contradict one
/// another have no solution, and such steps would take their impulses ever farther: where sweeps
/// gain nothing for a while, plain ones follow.
class ConjugateSteps {
 public:
  /// Part of the last direction in the next one; none: from now on a sweep is to be all of a step.
  std::optional<double> next(double energy) {
    const double ratio = energy < last_ ? energy / last_ : 0;
    last_ = energy;
    least_ = std::min(least_, energy);
    bool stalls = false;
    if (++n_sweeps_ % round == 0 && n_stalls_ < most_stalls) {
      stalls = !(least_ < gain * least_before_);
      n_stalls_ = stalls ? n_stalls_ + 1 : 0;
      least_before_ = std::exchange(least_, infinity);
    }
    if (n_stalls_ == most_stalls)
      return std::nullopt;
    return stalls ? 0 : ratio;
  }

 private:
  // Without an end a jammed loop of links gained as much energy as it had: its sweeps change
  // nothing but impulses. Those of redundant contacts gain a hundredth in a round, and get
  // somewhere.
  static constexpr int round = 50, most_stalls = 4;
  static constexpr double gain = 0.999;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double last_ = 0, least_ = infinity, least_before_ = infinity;
  int n_sweeps_ = 0, n_stalls_ = 0;
};

/// Columns: the normal and two tangents, or one.
template <int dim>
Eigen::Matrix<double, dim, dim> frame_of(const Point<dim>& normal) {
  Eigen::Matrix<double, dim, dim> frame;
  frame.col(0) = normal;
  if constexpr (dim == 2) {
    frame.col(1) = Point<2>(-normal.y(), normal.x());
  } else {
    frame.col(1) = normal.unitOrthogonal();
    frame.col(2) = normal.cross(frame.col(1));
  }
  return frame;
}

/// The row of a joint limit with these weights by id; without a response if nothing can move.
template <int dim>
LimitImpulses::Row limit_row(const Mobility<dim>& mobility, bool responds,
                             const std::map<int, double>& weights) {
  std::map<int, double> response;
  double of_parts = 0, of_all = 0;
  for (const auto& [id, weight] : weights) {
    const auto add = [&, id = id, weight = weight](int other, double value) {
      response[other] += weight * value;
      if (other == id)
        of_parts += weight * weight * value;
    };
    if (!responds) {
      for (const auto& [other, value] : mobility.row(id))
        add(other, value);
      continue;
    }
    for (int other = 0; other < mobility.n_active(); ++other)
      add(other, mobility.column(id)[other]);
  }
  for (const auto& [id, velocity] : response) {
    const auto weight = weights.find(id);
    of_all += weight == weights.end() ? 0 : weight->second * velocity;
  }
  LimitImpulses::Row row;
  row.weights.assign(weights.begin(), weights.end());
  if (of_all > unmovable * of_parts)
    row.response.assign(response.begin(), response.end());
  return row;
}
}  // namespace

template <int dim>
ImpulseSolver<dim>::ImpulseSolver(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                                  Mobility<dim>& mobility, std::vector<double> velocity)
    : system_(system), shapes_(shapes), mobility_(mobility), velocity_(std::move(velocity)) {
  if (!responds())
    return;
  given_ = velocity_;
  for (int number = 0; number < mobility_.n_active(); ++number)
    active_.push_back(velocity_[mobility_.active_dof(number)]);
}

template <int dim>
void ImpulseSolver<dim>::add_side(Row& row, const ContactSide<dim>& side, double sign) {
  if (shapes_.solids()[side.solid].prescribed) {
    row.of_given += sign * shapes_.prescribed_velocity(side.point, side.x);
    return;
  }
  for (const auto& [point, factor] : carriers_of(shapes_, side)) {
    row.prescribed += sign * factor * shapes_.constraint_error(point, side.x);
    add_entries(row, point, side.x, sign * factor);
  }
}

template <int dim>
void ImpulseSolver<dim>::add_entries(Row& row, const SurfacePoint<dim>& point, const Point<dim>& x,
                                     const Eigen::Matrix<double, dim, dim>& factor) {
  shapes_.velocity_row(point, x, velocity_row_);
  for (std::size_t k = 0; k < velocity_row_.dofs.size(); ++k) {
    const auto dof = static_cast<int>(velocity_row_.dofs[k]);
    const Point<dim> coefficient = factor * velocity_row_.coefficients[k];
    if (!responds()) {
      jacobian_.push_back({dof, coefficient});
      continue;
    }
    if (row.law.friction == 0 && row.contact.normal.dot(coefficient) == 0)
      continue;  // without friction the tangential part has no effect
    if (mobility_.is_held(dof))
      row.prescribed += velocity_[dof] * coefficient;
    else
      jacobian_.push_back({activate(dof), coefficient});
  }
}

/// `of_parts`: the normal response if no dof took back what another gives.
template <int dim>
void ImpulseSolver<dim>::add_mass_response(Row& row, Compliance& compliance, double& of_parts) {
  std::map<int, Point<dim>> response;
  for (int k = row.begin; k < row.end; ++k) {
    for (const auto& [dof, value] : mobility_.row(jacobian_[k].id)) {
      const auto place = response.try_emplace(dof, Point<dim>::Zero()).first;
      place->second += value * jacobian_[k].coefficient;
      if (dof == jacobian_[k].id)
        of_parts += value * std::pow(row.contact.normal.dot(jacobian_[k].coefficient), 2);
    }
  }
  row.response_begin = static_cast<int>(response_.size());
  for (const auto& [dof, coefficient] : response)
    response_.push_back({dof, coefficient});
  row.response_end = static_cast<int>(response_.size());
  for (int k = row.begin; k < row.end; ++k) {
    const auto found = response.find(jacobian_[k].id);
    if (found != response.end())
      compliance += jacobian_[k].coefficient * found->second.transpose();
  }
}

template <int dim>
void ImpulseSolver<dim>::add_response(Row& row) {
  Compliance compliance = Compliance::Zero();
  double of_parts = 0;
  if (responds())
    find_response(row, compliance, of_parts);
  else
    add_mass_response(row, compliance, of_parts);
  row.normal_response = row.contact.normal.dot(compliance * row.contact.normal);
  if (row.normal_response < unmovable * of_parts)
    row.normal_response = 0;
  row.law.mobility = row.frame.transpose() * compliance * row.frame;
  row.law.mobility(0, 0) = row.normal_response;
  // Directions that locks hold get no impulse to speak of.
  row.law.mobility.template bottomRightCorner<dim - 1, dim - 1>().diagonal().array() +=
      1e-12 * compliance.trace();
  row.tangent_response = row.law.mobility.template bottomRightCorner<dim - 1, dim - 1>().norm();
  if (row.law.friction > 0 && row.normal_response > 0)
    row.law.inverse = row.law.mobility.inverse();
}

template <int dim>
typename ImpulseSolver<dim>::Row ImpulseSolver<dim>::row_of(const Contact<dim>& contact,
                                                            double friction) {
  const auto& solids = shapes_.solids();
  Row row;
  row.contact = contact;
  row.law.friction = friction;
  row.frame = frame_of<dim>(contact.normal);
  row.solid_prescribed = solids[contact.solid].prescribed;
  row.other_prescribed = contact.other < 0 || solids[contact.other].prescribed;
  row.begin = static_cast<int>(jacobian_.size());
  add_side(row, row.solid_side(), 1);
  if (contact.other >= 0)
    add_side(row, row.other_side(), -1);
  else
    row.of_given -= contact.wall_velocity;
  row.prescribed += row.of_given;
  row.end = static_cast<int>(jacobian_.size());
  row.response_begin = row.response_end = static_cast<int>(response_.size());
  add_response(row);
  return row;
}

/// The row that was made last.
template <int dim>
void ImpulseSolver<dim>::forget_last(const Row& row) {
  jacobian_.resize(row.begin);
  response_.resize(row.response_begin);
}

template <int dim>
bool ImpulseSolver<dim>::add(const Contact<dim>& contact, double target, double friction) {
  Row row = row_of(contact, friction);
  if (!(row.normal_response > 0)) {
    forget_last(row);
    return false;
  }
  row.target = target;
  rows_.push_back(row);
  return true;
}

template <int dim>
bool ImpulseSolver<dim>::can_move(const Contact<dim>& contact) {
  const Row row = row_of(contact, 0);
  forget_last(row);
  return row.normal_response > 0;
}

/// Makes the row of a joint limit, without a response if nothing of it can move; `least` accounts
/// for held dofs.
template <int dim>
LimitImpulses::Row ImpulseSolver<dim>::row_of(const Terms& terms) {
  std::map<int, double> weights;
  double least = 0;
  for (const auto& [dof, weight] : shapes_.resolved(terms)) {
    if (!responds())
      weights[static_cast<int>(dof)] += weight;
    else if (mobility_.is_held(static_cast<int>(dof)))
      least -= weight * velocity_[dof];
    else
      weights[activate(static_cast<int>(dof))] += weight;
  }
  LimitImpulses::Row row = limit_row<dim>(mobility_, responds(), weights);
  row.least = least;
  return row;
}

template <int dim>
int ImpulseSolver<dim>::add(const Terms& terms, double least) {
  LimitImpulses::Row row = row_of(terms);
  if (row.response.empty())
    return -1;
  row.least += least;
  limits_.add(std::move(row));
  return limits_.size() - 1;
}

template <int dim>
bool ImpulseSolver<dim>::can_move(const Terms& terms) {
  return !row_of(terms).response.empty();
}

template <int dim>
Point<dim> ImpulseSolver<dim>::relative_velocity(const Row& row) const {
  Point<dim> velocity = row.prescribed;
  const std::vector<double>& known = velocity_by_id();
  for (int k = row.begin; k < row.end; ++k)
    velocity += known[jacobian_[k].id] * jacobian_[k].coefficient;
  return velocity;
}

template <int dim>
void ImpulseSolver<dim>::push(const Row& row, const Point<dim>& impulse) {
  for (int k = row.response_begin; k < row.response_end; ++k)
    velocity_[response_[k].id] += response_[k].coefficient.dot(impulse);
  for (int k = row.begin; k < row.end && responds(); ++k) {
    const double pushed = jacobian_[k].coefficient.dot(impulse);
    if (pushed != 0)
      mobility_.column(jacobian_[k].id).add_to(active_, pushed);
  }
}

/// Solves for one contact while the others stay.
template <int dim>
void ImpulseSolver<dim>::relax(Row& row, SweepReport& report) {
  const auto& mobility = row.law.mobility;
  Point<dim> velocity = row.frame.transpose() * relative_velocity(row);
  velocity[0] -= row.target;
  Point<dim> next = Point<dim>::Zero();
  if (row.law.friction > 0)
    next = coulomb_impulse<dim>(row.law, velocity - mobility * row.impulse, row.impulse);
  else
    next[0] = std::max(0.0, row.impulse[0] - velocity[0] / row.normal_response);
  row.change = next - row.impulse;
  row.impulse = next;
  if (row.change.isZero(0))
    return;
  push(row, row.frame * row.change);
  const Point<dim> felt = mobility * row.change;
  const double change = row.law.friction > 0 ? felt.norm() : std::abs(felt[0]);
  report.change = std::max(report.change, change);
  report.energy += row.change.dot(felt);
}

template <int dim>
typename ImpulseSolver<dim>::SweepReport ImpulseSolver<dim>::sweep(double negligible) {
  SweepReport report;
  report.change = limits_.relax(velocity_by_id(), negligible);
  for (Row& row : rows_)
    relax(row, report);
  return report;
}

/// Adds to the impulses `factor` times the last direction, which then becomes that and the last
/// sweep's change: the next direction of nonlinear conjugate gradients.
template <int dim>
void ImpulseSolver<dim>::go_on(double factor) {
  for (Row& row : rows_) {
    const Point<dim> more = factor * row.direction;
    row.direction = row.change + more;
    if (!more.isZero(0)) {
      row.impulse += more;
      push(row, row.frame * more);
    }
  }
}

/// Each sweep is a step of a gradient for nonlinear conjugate gradients (Silcowitz-Hansen, Niebe
/// and Erleben 2010), which need a fiftieth of the sweeps in stacks of unequal masses.
template <int dim>
int ImpulseSolver<dim>::iterate(int maximum_sweeps, double tolerance, double negligible) {
  extend_limits();
  for (Row& row : rows_)
    row.direction.setZero();
  ConjugateSteps steps;
  int n_sweeps = 0;
  for (double change = 1e300; n_sweeps < maximum_sweeps && !(change <= tolerance);) {
    const SweepReport report = sweep(negligible);
    change = report.change;
    const std::optional<double> factor = steps.next(report.energy);
    if (++n_sweeps < maximum_sweeps && change > tolerance && factor)
      go_on(*factor);
  }
  if (responds() && n_contacts() > 0)
    find_velocity();
  return n_sweeps;
}

/// Generalized, by dof of the surfaces.
template <int dim>
typename ImpulseSolver<dim>::Terms ImpulseSolver<dim>::impulse_on_both(
    const Row& row, const Point<dim>& impulse) const {
  Terms on_dofs = impulse_on(system_, shapes_, row.solid_side(), impulse);
  if (row.contact.other >= 0) {
    const Terms on_other = impulse_on<dim>(system_, shapes_, row.other_side(), -impulse);
    on_dofs.insert(on_dofs.end(), on_other.begin(), on_other.end());
  }
  return on_dofs;
}

template <int dim>
std::vector<double> ImpulseSolver<dim>::generalized_impulse() const {
  std::vector<double> total(velocity_.size());
  for (const Row& row : rows_)
    for (const auto& [dof, pushed] : impulse_on_both(row, row.frame * row.impulse))
      total[dof] += pushed;
  std::vector<double> of_limits(responds() ? active_.size() : total.size(), 0);
  limits_.add_to(of_limits);
  for (std::size_t id = 0; id < of_limits.size(); ++id)
    total[dof_of(static_cast<int>(id))] += of_limits[id];
  return total;
}

template <int dim>
Momentum<dim> ImpulseSolver<dim>::external_impulse() const {
  Momentum<dim> total;
  for (const Row& row : rows_) {
    if (row.solid_prescribed)
      total.add(row.contact.place(), -row.frame * row.impulse);
    if (row.other_prescribed)
      total.add(row.contact.other_place(), row.frame * row.impulse);
  }
  return total;
}

template class ImpulseSolver<2>;
template class ImpulseSolver<3>;

}  // namespace lockstep
