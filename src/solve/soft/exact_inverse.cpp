#include "solve/soft/exact_inverse.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <utility>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/soft/inverse_by_cost.hpp"

namespace lockstep {

namespace {

Action action_of(const RCP<const LinearOperator>& op) {
  return [op](const Vector& x, Vector& y) {
    if (op.is_null())
      y.update(1, x, 0);
    else
      apply(*op, x, y);
  };
}

/// On the rounded operator as far as its rounding lets the true residual fall, and from there on
/// with the operator itself. Returns the iterations.
int iterate(const LinearOperator& op, const InnerSolve& inner, const Vector& rhs,
            Vector& solution) {
  const double target = inner.tolerance * rhs.norm2();
  const Action exact = [&op](const Vector& x, Vector& y) { apply(op, x, y); };
  const Action precondition = action_of(inner.preconditioner);
  ConjugateGradientsRequest request{inner.name, target, inner.maximum_iterations, {}};
  if (inner.rounded.is_null())
    return conjugate_gradients(exact, precondition, rhs, solution, request);
  Vector residual(rhs, Teuchos::Copy);
  double norm = rhs.norm2();
  bool falls = true;
  request.true_residual = [&](const Vector& x, Vector& r) {
    r.update(1, rhs, 0);
    apply(op, x, r, -1, 1);
    residual.update(1, r, 0);
    const double before = std::exchange(norm, r.norm2());
    falls = norm < 0.5 * before;
    return falls;
  };
  const int n_rounded =
      conjugate_gradients(action_of(inner.rounded), precondition, rhs, solution, request);
  if (falls)
    return n_rounded;
  Vector correction(rhs.getMap());
  request.true_residual = {};
  request.maximum_iterations -= n_rounded;
  const int n_exact = conjugate_gradients(exact, precondition, residual, correction, request);
  solution.update(1, correction, 1);
  return n_rounded + n_exact;
}

}  // namespace

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     const InnerSolve& inner) {
  return action_operator(domain_map(*op), [=](const Vector& rhs, Vector& solution) {
    const int iterations = iterate(*op, inner, rhs, solution);
    if (inner.iterations)
      *inner.iterations += iterations;
    if (iterations < inner.maximum_iterations)
      return;
    Vector residual(rhs, Teuchos::Copy);
    apply(*op, solution, residual, -1, 1);
    throw SolveError(fmt::format(
        "The inner conjugate gradients on the {} stopped at a relative residual of {:.1e} after {} "
        "iterations, but {:.1e} is required. Choose a stronger inverse of it.",
        inner.name, residual.norm2() / rhs.norm2(), iterations, inner.tolerance));
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
  return InverseByCost(op, {}, name).with([&](const InverseByCost::Rest& rest) {
    return conjugate_gradient_inverse(rest.op, 1e-14, 20000, name);
  });
}

}  // namespace lockstep
