#include "coupling/viscous_options.hpp"

#include "solve/preconditioner.hpp"

namespace lockstep {

void declare_viscous_solve(ParameterList& solver) {
  const ViscousOptions standard;
  ParameterList& list = declare_list(
      solver, "Viscous Solve",
      "How implicit viscosity is solved, for the fluid and the solids together: "
      "[M_f + dt K_ff, dt K_fs; dt K_sf, C + dt K_ss], symmetric positive definite, by "
      "conjugate gradients.");
  declare_tolerance(list, "Tolerance", standard.tolerance, "Relative residual [1].");
  declare_positive(list, "Maximum Iterations", standard.maximum_iterations, "Of one solve.");
  declare_inverse(
      list, "Solid Inverse",
      "Approximate inverse of C in the preconditioner. Default: the diagonal of C + dt K_ss, and "
      "of solids that are stiff in this step a multigrid cycle or the factors of C.");
}

ViscousOptions viscous_options(const ParameterList& solver) {
  const ParameterList& list = solver.sublist("Viscous Solve");
  ViscousOptions options;
  options.tolerance = list.get<double>("Tolerance");
  options.maximum_iterations = list.get<int>("Maximum Iterations");
  options.fluid_inverse = inverse_list(list, "Fluid Inverse", {});
  options.solid_inverse = inverse_list(list, "Solid Inverse", {});
  return options;
}

}  // namespace lockstep
