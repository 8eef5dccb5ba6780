#include <fmt/format.h>

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "articulated/articulation.hpp"
#include "base/errors.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

template <int dim>
JointConstraints<dim>::JointConstraints(std::shared_ptr<Articulation<dim>> articulation,
                                        const Communicator& comm)
    : articulation_(std::move(articulation)),
      comm_(comm),
      two_halves_(articulation_->joints().size(), 0) {}

template <int dim>
std::vector<Combination> JointConstraints<dim>::combinations() const {
  std::vector<Combination> all;
  const auto add = [&all](GlobalIndex dof, const std::vector<GlobalIndex>& columns,
                          const auto& row) {
    Combination combination{dof, {}};
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double weight = row[static_cast<Eigen::Index>(c)];
      if (weight != 0)
        combination.terms.emplace_back(columns[c], weight);
    }
    all.push_back(std::move(combination));
  };
  const std::vector<MotionBasis<dim>> bases = articulation_->motion_bases();
  for (std::size_t m = 0; m < bases.size(); ++m) {
    const Mechanism& mechanism = articulation_->mechanisms()[m];
    const MotionBasis<dim>& basis = bases[m];
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
      const GlobalIndex first = articulation_->bodies()[mechanism.bodies[b]].first_dof;
      for (int k = 0; k < n_twist<dim> && mechanism.carriers[b] >= 0; ++k)
        add(first + k, basis.columns, basis.twists[b].row(k));
    }
    for (const auto& [column, row] : basis.dependent)
      add(basis.columns[column], basis.columns, row);
  }
  return all;
}

template <int dim>
std::vector<TwistVector<dim>> JointConstraints<dim>::gather_twists(const Vector& velocity) const {
  const auto& bodies = articulation_->bodies();
  std::vector<TwistVector<dim>> twists(bodies.size(), TwistVector<dim>::Zero());
  const auto values = velocity.getData();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (int k = 0; k < n_twist<dim> && !bodies[b].prescribed(); ++k) {
      const int row = velocity.getMap()->getLocalElement(bodies[b].first_dof + k);
      if (row >= 0)
        twists[b][k] = values[row];
    }
  }
  sum_over_ranks(comm_, twists);
  return twists;
}

template <int dim>
Eigen::VectorXd JointConstraints<dim>::gather_rates(const Vector& velocity) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(articulation_->n_rates());
  const auto values = velocity.getData();
  for (int k = 0; k < rates.size(); ++k) {
    const int row = velocity.getMap()->getLocalElement(articulation_->dofs().first_rate + k);
    if (row >= 0)
      rates[k] = values[row];
  }
  sum_over_ranks(comm_, rates);
  return rates;
}

template <int dim>
void JointConstraints<dim>::set_twists(const std::vector<TwistVector<dim>>& twists,
                                       Vector& velocity) const {
  const auto values = velocity.getDataNonConst();
  const auto& bodies = articulation_->bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (int k = 0; k < n_twist<dim> && !bodies[b].prescribed(); ++k) {
      const int row = velocity.getMap()->getLocalElement(bodies[b].first_dof + k);
      if (row >= 0)
        values[row] = twists[b][k];
    }
  }
}

template <int dim>
std::vector<JointLimit> JointConstraints<dim>::limits(double dt,
                                                      const std::vector<double>& velocity) const {
  std::vector<JointLimit> all;
  for (const Joint<dim>& joint : articulation_->joints()) {
    if (joint.first_rate < 0 || !joint.limits.any())
      continue;
    double arm = 0;
    for (const JointSide<dim>& side : joint.sides)
      arm = std::max(arm, side.body == space ? 0 : side.point.norm());
    const GlobalIndex first = articulation_->dofs().first_rate + joint.first_rate;
    const Eigen::Map<const Eigen::VectorXd> rates(velocity.data() + first, joint.q.size());
    for (const RateLimit& one :
         rate_limits(joint.kind->freedom(), joint.limits, joint.q, rates, dt)) {
      const double scale = one.turns && arm > 0 ? arm : 1;
      JointLimit limit;
      limit.room = scale * one.room;
      for (Eigen::Index k = 0; k < one.weights.size(); ++k) {
        if (one.weights[k] != 0)
          limit.terms.emplace_back(first + k, scale * one.weights[k]);
      }
      all.push_back(std::move(limit));
    }
  }
  return all;
}

template <int dim>
std::vector<GivenMotion> JointConstraints<dim>::given_motions() const {
  std::vector<GivenMotion> all;
  for (const Joint<dim>& joint : articulation_->joints()) {
    std::vector<GlobalIndex> dofs;
    for (int k = 0; k < joint.q.size(); ++k) {
      if (joint.control.given(k))
        dofs.push_back(articulation_->dofs().first_rate + joint.first_rate + k);
    }
    if (dofs.empty())
      continue;
    all.push_back({"the motor \"" + joint.name + "\"", std::move(dofs)});
  }
  const auto& bodies = articulation_->bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].prescribed())
      continue;
    std::vector<GlobalIndex> dofs(n_twist<dim>);
    std::iota(dofs.begin(), dofs.end(), articulation_->dofs().first_of_body[b]);
    all.push_back({"what \"" + bodies[b].name + "\" carries by joints", std::move(dofs)});
  }
  return all;
}

template <int dim>
std::string JointConstraints<dim>::limited() const {
  for (const Joint<dim>& joint : articulation_->joints()) {
    if (joint.limits.any())
      return joint.name;
  }
  return "";
}

template <int dim>
int JointConstraints<dim>::largest_block() const {
  int largest = 0;
  for (const Mechanism& mechanism : articulation_->mechanisms()) {
    int n = mechanism.root == space ? 0 : n_twist<dim>;
    for (const int j : mechanism.joints)
      n += articulation_->joints()[j].first_rate < 0
               ? 0
               : static_cast<int>(articulation_->joints()[j].q.size());
    largest = std::max(largest, n);
  }
  return largest;
}

template <int dim>
void JointConstraints<dim>::take_note(const JointImpulses& impulses, double, double dt) {
  const int n = articulation_->n_rates();
  const ControlLaw springs = articulation_->control();
  if (!articulation_->takes_kicks() || !articulation_->has_moved()) {
    impulse_ = limit_impulse_ = Eigen::VectorXd::Zero(n);
    limited_.assign(n, 1);
    dt_ = 0;
  }
  dt_ += dt;
  impulse_ += gather_rates(*impulses.at_end);
  if (!impulses.at_start.is_null())
    impulse_ += gather_rates(*impulses.at_start);
  // S1 takes none of the springs' impulses away from S2.
  impulse_ += dt * (springs.constant - springs.slope.cwiseProduct(articulation_->rates()));
  for (int k = 0; k < n; ++k)
    limited_[k] = limited_[k] && springs.limited[k] ? 1 : 0;
  for (const auto& [dof, impulse] : impulses.of_limits)
    limit_impulse_[dof - articulation_->dofs().first_rate] += impulse;
}

template <int dim>
std::vector<JointState> JointConstraints<dim>::states(double time) const {
  const std::vector<BodyPose<dim>> poses = articulation_->poses();
  std::vector<JointState> states;
  for (std::size_t j = 0; j < articulation_->joints().size(); ++j) {
    const Joint<dim>& joint = articulation_->joints()[j];
    JointState state;
    state.name = joint.name;
    state.gap = largest_gap(joint, poses);
    state.two_halves = two_halves_[j] != 0;
    const Eigen::VectorXd rates = articulation_->rates_of(joint);
    const auto n = static_cast<int>(joint.q.size());
    Eigen::VectorXd target = joint.q;
    if (joint.control.any())
      target = joint.control.target_at(time).q;
    for (int k = 0; k < n; ++k) {
      state.coordinate = n > 1 ? k + 1 : 0;
      state.q = joint.q[k];
      state.rate = rates[k];
      state.target = joint.control.free(k) ? state.q : target[k];
      state.at_limit = at_limit(joint.limits, joint.q, k);
      if (joint.first_rate >= 0 && dt_ > 0) {
        state.torque = impulse_[joint.first_rate + k] / dt_;
        state.limit_torque = limit_impulse_[joint.first_rate + k] / dt_;
        state.at_largest_torque = limited_[joint.first_rate + k] != 0;
        state.power = state.torque * (joint.q[k] - joint.at_begin.q[k]) / dt_;
      }
      states.push_back(state);
    }
    if (n == 0)
      states.push_back(state);
  }
  return states;
}

namespace {

/// The joint of that name; of "NAME k" the joint NAME and its coordinate k, from 0, else -1.
template <int dim>
std::pair<Joint<dim>*, int> joint_named(std::vector<Joint<dim>>& joints, const std::string& name) {
  for (Joint<dim>& joint : joints) {
    if (joint.name == name)
      return {&joint, -1};
    for (int k = 0; k < joint.q.size() && joint.q.size() > 1; ++k) {
      if (joint.name + " " + std::to_string(k + 1) == name)
        return {&joint, k};
    }
  }
  std::vector<std::string> names;
  for (const Joint<dim>& joint : joints)
    names.push_back(joint.name);
  const std::string nearest = nearest_name(name, names);
  throw InputError(fmt::format("There is no joint \"{}\".{} There are: {}.", name,
                               nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
                               quoted_list(names)));
}

/// A straight line through `place` at `time`.
JointTarget moving_target(double time, const std::vector<double>& place,
                          const std::vector<double>& speed) {
  const auto n = static_cast<Eigen::Index>(place.size());
  const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(place.data(), n);
  const Eigen::VectorXd rate = Eigen::Map<const Eigen::VectorXd>(speed.data(), n);
  return [time, q, rate](double t) { return TargetValue{q + (t - time) * rate, rate}; };
}

}  // namespace

template <int dim>
void JointConstraints<dim>::set_target(const std::string& name, double time,
                                       const std::vector<double>& q,
                                       const std::vector<double>& rate) {
  const auto [joint, k] = joint_named(articulation_->joints(), name);
  JointControl& control = joint->control;
  check_input(k < 0 ? control.any() : !control.free(k),
              "The joint \"{}\" is free; give it a \"Control\" before a target.", name);
  const std::size_t n = k < 0 ? joint->q.size() : 1;
  check_input(q.size() == n && rate.size() == n,
              "The target of the joint \"{}\" has {} values and {} rates; it has {} coordinates.",
              name, q.size(), rate.size(), n);
  check_input(k < 0 || !joint->kind->freedom().rotation_vector,
              "The coordinates of the joint \"{}\" have one target; give it for all of them.",
              joint->name);
  if (k >= 0) {
    control.coordinates[k].own_target = moving_target(time, q, rate);
    return;
  }
  control.target = moving_target(time, q, rate);
  for (CoordinateControl& one : control.coordinates)
    one.own_target = nullptr;
}

template <int dim>
std::string JointConstraints<dim>::note() const {
  std::size_t n_loops = 0;
  for (const Mechanism& mechanism : articulation_->mechanisms())
    n_loops += mechanism.loops.size();
  return fmt::format("{} ({} close loops) in {} mechanisms, {} rates; {}",
                     articulation_->joints().size(), n_loops, articulation_->mechanisms().size(),
                     articulation_->n_rates(),
                     articulation_->options().two_halves
                         ? "half of their impulse where a step begins: S1 is solved twice"
                         : "their impulse where a step ends");
}

template class JointConstraints<2>;
template class JointConstraints<3>;

}  // namespace lockstep
