#pragma once
#include <Eigen/Core>

#include "support/coupled_case.hpp"

namespace lockstep::test {

/// The mixed faces of a case gathered from all ranks, in the order of the fluid's ids.
template <int dim>
struct GatheredFaces {
  std::vector<ControlVolume<dim>> volumes;
  Eigen::MatrixXd weights;  ///< W: faces x solid dofs
  Eigen::VectorXd masses;   ///< M_F [kg]
};

/// Collective. W is read off the velocities that unit solid velocities give.
template <int dim>
GatheredFaces<dim> gathered_faces(CoupledCase<dim>& c);

}  // namespace lockstep::test
