#include "articulated/lone_mechanism.hpp"

#include <map>

namespace lockstep {

namespace {

/// Own numbers of things, in their order.
std::map<int, int> numbered(const std::vector<int>& all) {
  std::map<int, int> own{{space, space}};
  for (std::size_t k = 0; k < all.size(); ++k)
    own.emplace(all[k], static_cast<int>(k));
  return own;
}

std::vector<int> translated(const std::vector<int>& all, const std::map<int, int>& own) {
  std::vector<int> result;
  for (const int number : all)
    result.push_back(number < 0 ? number : own.at(number));
  return result;
}

}  // namespace

template <int dim>
LoneMechanism<dim> alone(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints) {
  LoneMechanism<dim> lone;
  lone.bodies = mechanism.bodies;
  lone.bodies.insert(lone.bodies.end(), mechanism.grounds.begin(), mechanism.grounds.end());
  const std::map<int, int> body = numbered(lone.bodies), joint = numbered(mechanism.joints);
  lone.mechanism.root = body.at(mechanism.root);
  lone.mechanism.bodies = translated(mechanism.bodies, body);
  lone.mechanism.carriers = translated(mechanism.carriers, joint);
  lone.mechanism.loops = translated(mechanism.loops, joint);
  lone.mechanism.grounds = translated(mechanism.grounds, body);
  lone.mechanism.joints = translated(mechanism.joints, joint);
  for (const int j : mechanism.joints) {
    lone.joints.push_back(joints[j]);
    for (JointSide<dim>& side : lone.joints.back().sides)
      side.body = body.at(side.body);
  }
  return lone;
}

template LoneMechanism<2> alone(const Mechanism&, const std::vector<Joint<2>>&);
template LoneMechanism<3> alone(const Mechanism&, const std::vector<Joint<3>>&);

}  // namespace lockstep
