#pragma once
#include <string>

#include "articulated/joint_kind.hpp"

namespace lockstep {

/// The first promise of JointKind that a kind breaks at the coordinates q, as a clause; empty if it
/// keeps all. Motions are compared by differences over 1e-6 m and rad. Local.
template <int dim>
std::string broken_promise(const JointKind<dim>& kind, const Eigen::VectorXd& q);

}  // namespace lockstep
