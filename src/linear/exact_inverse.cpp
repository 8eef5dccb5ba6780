#include "linear/exact_inverse.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/inverse_by_cost.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     const InnerSolve& inner) {
  const Action precondition = [m = inner.preconditioner](const Vector& x, Vector& y) {
    if (m.is_null())
      y.update(1, x, 0);
    else
      apply(*m, x, y);
  };
  const auto iterated = inner.rounded.is_null() ? op : inner.rounded;
  return action_operator(domain_map(*op), [=](const Vector& rhs, Vector& solution) {
    const double norm = rhs.norm2();
    ConjugateGradientsRequest request{
        inner.name, inner.tolerance * norm, inner.maximum_iterations, {}};
    if (!inner.rounded.is_null()) {
      request.true_residual = [&](const Vector& x, Vector& r) {
        r.update(1, rhs, 0);
        apply(*op, x, r, -1, 1);
      };
    }
    const int iterations =
        conjugate_gradients([&](const Vector& x, Vector& y) { apply(*iterated, x, y); },
                            precondition, rhs, solution, request);
    if (inner.iterations)
      *inner.iterations += iterations;
    if (iterations < inner.maximum_iterations)
      return;
    Vector residual(rhs, Teuchos::Copy);
    apply(*op, solution, residual, -1, 1);
    throw SolveError(fmt::format(
        "The inner conjugate gradients on the {} stopped at a relative residual of {:.1e} after {} "
        "iterations, but {:.1e} is required. Choose a stronger \"Solid Inverse\".",
        inner.name, residual.norm2() / norm, iterations, inner.tolerance));
  });
}

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     double tolerance, int maximum_iterations,
                                                     const std::string& name) {
  RCP<const LinearOperator> jacobi;
  if (const auto matrix = assembled(op); !matrix.is_null())
    jacobi = as_operator(jacobi_inverse(*matrix, name));
  return conjugate_gradient_inverse(
      op, {jacobi, Teuchos::null, tolerance, maximum_iterations, name, nullptr});
}

RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name) {
  const InverseByCost split(op, name);
  return split.with(split.is_complete()
                        ? Teuchos::null
                        : conjugate_gradient_inverse(split.rest(), 1e-14, 20000, name));
}

}  // namespace lockstep
