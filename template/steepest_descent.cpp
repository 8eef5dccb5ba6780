#include "steepest_descent.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/null_space.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList SteepestDescent::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  declare_between(list, "Shortening", 0.95, 0.1, 1.0,
                  "Factor of every step [1]; below 1 breaks the zigzag of exact line searches");
  return list;
}

SteepestDescent::SteepestDescent(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")),
      shortening_(with_defaults(given, valid_parameters()).get<double>("Shortening")) {}

void SteepestDescent::build(const BlockSystem&, bool, bool) {}

int SteepestDescent::correct(const BlockSystem& system, const CorrectionRequest& request,
                             Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  const CrsMatrix& coupling = *system.coupling_transposed();
  Vector r(*request.residual, Teuchos::Copy), z(r.getMap()), s_z(r.getMap());
  Vector force(coupling.getRangeMap()), velocity(coupling.getRangeMap());
  correction.putScalar(0);
  int n_iterations = 0;
  while (r.norm2() > request.target && n_iterations < request.maximum_iterations) {
    apply(*pressure_inverse(), r, z);
    project_out(system.null_space, z);
    // S z = A z + B C^-1 B^T z, never assembled
    apply(*system.pressure_block(), z, s_z);
    coupling.apply(z, force);
    apply(*solid_inverse(), force, velocity);
    coupling.apply(velocity, s_z, Teuchos::TRANS, 1, 1);
    const double step = shortening_ * z.dot(r) / z.dot(s_z);
    correction.update(step, z, 1);
    r.update(-step, s_z, 1);
    ++n_iterations;
  }
  return n_iterations;
}

}  // namespace lockstep
