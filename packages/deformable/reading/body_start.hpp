#pragma once
#include <string>
#include <vector>

#include "deformable/deformable_body.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Declares the parameters that volumes and shells share: mass matrix, damping, time integration,
/// place and velocity at the start, constraints, loads, contact. `integration`: the default of
/// "Time Integration".
template <int dim>
void declare_body_start(ParameterList& list, const std::string& integration);

/// Reads the parameters for nodes at these rest positions; name, mass elements and their masses are
/// set before.
template <int dim>
void read_body_start(const ParameterList& list, const std::vector<Point<dim>>& rest,
                     DeformableBody<dim>& body);

/// Rotation of the body at the start.
template <int dim>
Eigen::Matrix<double, dim, dim> start_rotation(const ParameterList& list);

}  // namespace lockstep
