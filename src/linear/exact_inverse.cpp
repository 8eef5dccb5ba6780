#include "linear/exact_inverse.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/gathered_direct.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

constexpr int largest_block = 24;
constexpr Tpetra::global_size_t largest_direct = 20000;

}  // namespace

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     double tolerance, int maximum_iterations,
                                                     const std::string& name) {
  RCP<const CrsMatrix> jacobi;
  if (const auto matrix = assembled(op); !matrix.is_null())
    jacobi = jacobi_inverse(*matrix, name);
  const Action precondition = [jacobi](const Vector& x, Vector& y) {
    if (jacobi.is_null())
      y.update(1, x, 0);
    else
      jacobi->apply(x, y);
  };
  return action_operator(domain_map(*op), [=](const Vector& rhs, Vector& solution) {
    const double norm = rhs.norm2();
    const int iterations =
        conjugate_gradients([&op](const Vector& x, Vector& y) { apply(*op, x, y); }, precondition,
                            rhs, solution, {name, tolerance * norm, maximum_iterations, {}});
    if (iterations < maximum_iterations)
      return;
    Vector residual(rhs, Teuchos::Copy);
    apply(*op, solution, residual, -1, 1);
    throw SolveError(fmt::format(
        "The inner conjugate gradients on the {} stopped at a relative residual of {:.1e} after {} "
        "iterations, but {:.1e} is required.",
        name, residual.norm2() / norm, iterations, tolerance));
  });
}

RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name) {
  if (const auto matrix = assembled(op); !matrix.is_null()) {
    const auto blocks = block_diagonal_inverse(matrix, largest_block, name);
    if (blocks.exact)
      return as_operator(blocks.inverse);
    if (matrix->getGlobalNumRows() <= largest_direct)
      return gathered_direct(matrix, name);
  }
  return conjugate_gradient_inverse(op, 1e-14, 20000, name);
}

}  // namespace lockstep
