#include "articulated/articulation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
Articulation<dim>::Articulation(std::vector<JointedBody<dim>> bodies,
                                std::vector<Joint<dim>> joints, const ArticulationOptions& options,
                                GlobalIndex first_dof)
    : bodies_(std::move(bodies)), joints_(std::move(joints)), options_(options) {
  mechanisms_ = find_mechanisms(bodies_, joints_);
  dofs_.first_rate = first_dof;
  dofs_.first_of_body.assign(bodies_.size(), no_index);
  for (Joint<dim>& joint : joints_) {
    const int n = joint.kind->n_rates();
    joint.q = Eigen::VectorXd::Zero(n);
    if (joint.first_rate >= 0)
      n_rates_ += n;
  }
  rates_ = Eigen::VectorXd::Zero(n_rates_);
  given_.assign(n_rates_, 0);
  for (Joint<dim>& joint : joints_) {
    check_input(
        joint.first_rate >= 0 || !joint.wants_rates(),
        "The joint \"{}\" closes a loop whose other joints are all under control or limited; "
        "leave one of them free.",
        joint.name);
    joint.at_begin = {joint.q, Eigen::VectorXd::Zero(joint.q.size())};
    joint.goal = joint.at_begin;
    for (int k = 0; k < joint.q.size() && joint.control.any_given(); ++k)
      given_[joint.first_rate + k] = joint.control.given(k) ? 1 : 0;
  }
  n_dofs_ = n_rates_;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].prescribed())
      continue;
    dofs_.first_of_body[b] = first_dof + n_dofs_;
    n_dofs_ += n_twist<dim>;
  }
  set_gains();
}

/// Sets the gains of oscillators from the inertia of each joint alone, with all others held: its
/// coordinates are resisted by the inertia of the tree, less what a free root yields.
template <int dim>
void Articulation<dim>::set_gains() {
  const std::vector<BodyPose<dim>> poses = this->poses();
  const std::vector<char> all(n_rates_, 1);  // loops make no combinations
  for (const Mechanism& mechanism : mechanisms_) {
    const MotionBasis<dim> basis = motion_basis(mechanism, bodies_, joints_, poses, dofs_, all);
    Eigen::MatrixXd inertia = Eigen::MatrixXd::Zero(basis.columns.size(), basis.columns.size());
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
      const JointedBody<dim>& body = bodies_[mechanism.bodies[b]];
      const auto mass = body.model->rigid_frame(body.solid).mass;
      inertia += basis.twists[b].transpose() * mass * basis.twists[b];
    }
    const int n_root = mechanism.root == space ? 0 : n_twist<dim>;
    const Eigen::LDLT<Eigen::MatrixXd> root(inertia.topLeftCorner(n_root, n_root));
    for (const int j : mechanism.joints) {
      Joint<dim>& joint = joints_[j];
      if (joint.first_rate < 0)
        continue;
      const auto first = std::find(basis.columns.begin(), basis.columns.end(),
                                   dofs_.first_rate + joint.first_rate);
      for (int k = 0; k < joint.q.size(); ++k) {
        CoordinateControl& control = joint.control.coordinates[k];
        if (!control.acts() && !control.natural_frequency)
          continue;
        const Eigen::Index c = first - basis.columns.begin() + k;
        double own = inertia(c, c);
        if (n_root > 0)
          own -= inertia.col(c).head(n_root).dot(
              root.solve(Eigen::VectorXd(inertia.col(c).head(n_root))));
        control.inertia = own;
        if (!control.natural_frequency)
          continue;
        const double frequency = *control.natural_frequency;
        control.stiffness = frequency * frequency * own;
        control.damping = 2 * control.damping_ratio * frequency * own;
      }
    }
  }
}

template <int dim>
Eigen::VectorXd Articulation<dim>::rates_of(const Joint<dim>& joint) const {
  if (joint.first_rate < 0)
    return Eigen::VectorXd::Zero(joint.q.size());
  return rates_.segment(joint.first_rate, joint.q.size());
}

template <int dim>
bool Articulation<dim>::any_acts() const {
  return std::any_of(joints_.begin(), joints_.end(),
                     [](const Joint<dim>& joint) { return joint.control.any_acts(); });
}

/// A kick has the spring at its place and dt^2/4 times its stiffness as a mass, and the mean of
/// what the damper gives before and after. That rings where a spring is too stiff for the step:
/// there both go over to those of the end of the step.
template <int dim>
ControlLaw Articulation<dim>::control() const {
  ControlLaw all{Eigen::VectorXd::Zero(n_rates_), Eigen::VectorXd::Zero(n_rates_),
                 std::vector<char>(n_rates_, 0)};
  for (const Joint<dim>& joint : joints_) {
    if (!joint.control.any_acts())
      continue;
    TargetValue present = joint.at_kick;
    ControlTimes times{begin_ + dt_ / 2, dt_ / 2, has_moved_ ? 0.5 : 1};
    if (options_.fully_implicit || takes_kicks_) {
      const double late = options_.fully_implicit ? 1 : unresolved_part(joint.control, dt_);
      const double kick = takes_kicks_ && has_moved_ ? begin_ + dt_ : begin_;
      times = {kick + late * dt_, (1 + late) * dt_ / 2, (1 + late) / 2};
      if (late < 1)
        present.q = joint.kind->advanced(present.q, (late - 1) * dt_ / 2 * present.rate);
    }
    const ControlLaw law = control_law<dim>(*joint.kind, joint.control, present, times);
    all.constant.segment(joint.first_rate, law.constant.size()) = law.constant;
    all.slope.segment(joint.first_rate, law.slope.size()) = law.slope;
    std::copy(law.limited.begin(), law.limited.end(), all.limited.begin() + joint.first_rate);
  }
  return all;
}

template <int dim>
void Articulation<dim>::begin_step(double time, double dt) {
  begin_ = time;
  dt_ = dt;
  has_moved_ = false;
  for (Joint<dim>& joint : joints_) {
    joint.at_begin = joint.at_kick = {joint.q, rates_of(joint)};
    if (joint.control.any_given())
      joint.goal = given_motion<dim>(*joint.kind, joint.control, joint.at_begin, time, dt);
  }
}

namespace {
template <int dim>
BodyPose<dim> pose_of(const RigidFrame<dim>& frame) {
  return {frame.position, frame.orientation.toRotationMatrix()};
}
}  // namespace

template <int dim>
std::vector<BodyPose<dim>> Articulation<dim>::poses() const {
  std::vector<BodyPose<dim>> poses;
  for (const JointedBody<dim>& body : bodies_)
    poses.push_back(pose_of(body.model->rigid_frame(body.solid)));
  return poses;
}

template <int dim>
std::vector<BodyPose<dim>> Articulation<dim>::prescribed_poses(double time) const {
  std::vector<BodyPose<dim>> poses;
  for (const JointedBody<dim>& body : bodies_)
    poses.push_back(body.prescribed() ? pose_of(body.model->prescribed_frame(body.solid, time))
                                      : BodyPose<dim>());
  return poses;
}

template <int dim>
TwistVector<dim> Articulation<dim>::prescribed_twist(int body, double begin, double end) const {
  const JointedBody<dim>& one = bodies_[body];
  const RigidFrame<dim> after = one.model->prescribed_frame(one.solid, end);
  if (end == begin)
    return after.velocity;
  return twist_to(pose_of(one.model->prescribed_frame(one.solid, begin)), pose_of(after),
                  end - begin);
}

template <int dim>
std::vector<MotionBasis<dim>> Articulation<dim>::motion_bases() const {
  const std::vector<BodyPose<dim>> poses = this->poses();
  std::vector<MotionBasis<dim>> bases;
  for (const Mechanism& mechanism : mechanisms_)
    bases.push_back(motion_basis(mechanism, bodies_, joints_, poses, dofs_, given_));
  return bases;
}

template <int dim>
double Articulation<dim>::fastest_turn() const {
  double fastest = 0;
  for (const JointedBody<dim>& body : bodies_) {
    const auto velocity = body.model->rigid_frame(body.solid).velocity;
    if (!body.prescribed())
      fastest = std::max(fastest, velocity.template tail<n_rotations<dim>>().norm());
  }
  return fastest;
}

template <int dim>
void Articulation<dim>::update_coordinates(const Eigen::VectorXd& change) {
  const std::vector<BodyPose<dim>> poses = this->poses();
  for (Joint<dim>& joint : joints_) {
    Eigen::VectorXd near = joint.q;
    if (joint.first_rate >= 0)
      near = joint.kind->advanced(joint.q, change.segment(joint.first_rate, joint.q.size()));
    joint.q = joint.kind->coordinates(place_of(joint, poses).pose, near);
    if (takes_kicks_)
      joint.at_kick = {joint.q, rates_of(joint)};
  }
  has_moved_ = true;
}

template class Articulation<2>;
template class Articulation<3>;

}  // namespace lockstep
