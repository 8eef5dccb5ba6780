#include "articulated/articulation.hpp"

#include <algorithm>

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
    const int n = lockstep::n_rates<dim>(joint.kind);
    joint.q = Eigen::VectorXd::Zero(n);
    if (joint.first_rate >= 0)
      n_rates_ += n;
  }
  n_dofs_ = n_rates_;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].prescribed())
      continue;
    dofs_.first_of_body[b] = first_dof + n_dofs_;
    n_dofs_ += n_twist<dim>;
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
  const std::vector<char> given(n_rates_, 0);
  std::vector<MotionBasis<dim>> bases;
  for (const Mechanism& mechanism : mechanisms_)
    bases.push_back(motion_basis(mechanism, bodies_, joints_, poses, dofs_, given));
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
      near = advanced<dim>(joint.kind, joint.q, change.segment(joint.first_rate, joint.q.size()));
    joint.q = coordinates(joint.kind, place_of(joint, poses).pose, near);
  }
}

template class Articulation<2>;
template class Articulation<3>;

}  // namespace lockstep
