#include "strategies/common/pressure_cg.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {

int pressure_cg(const BlockSystem& system, const LinearOperator& pressure_inverse,
                const Vector& rhs, const ConjugateGradientsRequest& request, Vector& solution) {
  return conjugate_gradients(
      [&](const Vector& x, Vector& y) { apply(*system.pressure_block, x, y); },
      [&](const Vector& x, Vector& y) { apply(pressure_inverse, x, y); }, rhs, solution, request);
}

}  // namespace lockstep
