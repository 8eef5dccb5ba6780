#pragma once
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Options of the coupled viscous solve.
struct ViscousOptions {
  /// Largest residual in the norm of the preconditioner, relative to the right-hand side [1].
  double tolerance = 1e-10;
  int maximum_iterations = 2000;
  /// List for preconditioner_from_list that preconditions M_f + dt K_ff; empty: its diagonal.
  ParameterList fluid_inverse;
  /// List for preconditioner_from_list that preconditions C; empty: its diagonal with that of K_ss,
  /// and where C is stiff an inverse of it.
  ParameterList solid_inverse;
};

/// Declares the list "Viscous Solve" of a scene's "Solver".
void declare_viscous_solve(ParameterList& solver);
/// Throws InputError if an inverse is none.
ViscousOptions viscous_options(const ParameterList& solver);

}  // namespace lockstep
