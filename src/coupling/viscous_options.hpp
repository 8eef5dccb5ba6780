#pragma once
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// How the coupled viscous system is solved.
struct ViscousOptions {
  /// Of the residual in the norm of the preconditioner, relative to the right-hand side [1].
  double tolerance = 1e-10;
  int maximum_iterations = 2000;
  /// What preconditioner_from_list takes for M_f + dt K_ff; empty: its diagonal.
  ParameterList fluid_inverse;
  /// The same for C; empty: its diagonal with that of K_ss, where C is stiff an inverse of it.
  ParameterList solid_inverse;
};

/// Declares the list "Viscous Solve" of a scene's "Solver".
void declare_viscous_solve(ParameterList& solver);
/// Throws InputError if an inverse is none.
ViscousOptions viscous_options(const ParameterList& solver);

}  // namespace lockstep
