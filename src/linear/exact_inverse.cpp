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

}  // namespace

bool direct_is_cheap(const CrsMatrix& matrix) {
  // Fill grows like n log n for a plane mesh, whose rows have about 14 entries in 2D and 40 with
  // the bending of cloth, and like n^(4/3) for a volume.
  constexpr Tpetra::global_size_t few_rows = 3000, most_rows = 20000, entries_of_a_surface = 24;
  const auto n_rows = matrix.getGlobalNumRows();
  return n_rows <= few_rows ||
         (n_rows <= most_rows && matrix.getGlobalNumEntries() <= entries_of_a_surface * n_rows);
}

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     const InnerSolve& inner) {
  const Action precondition = [m = inner.preconditioner](const Vector& x, Vector& y) {
    if (m.is_null())
      y.update(1, x, 0);
    else
      apply(*m, x, y);
  };
  return action_operator(domain_map(*op), [=](const Vector& rhs, Vector& solution) {
    const double norm = rhs.norm2();
    const int iterations = conjugate_gradients(
        [&op](const Vector& x, Vector& y) { apply(*op, x, y); }, precondition, rhs, solution,
        {inner.name, inner.tolerance * norm, inner.maximum_iterations, {}});
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
  return conjugate_gradient_inverse(op, {jacobi, tolerance, maximum_iterations, name, nullptr});
}

RCP<const LinearOperator> cheap_exact_inverse(const RCP<const LinearOperator>& op,
                                              const std::string& name) {
  const auto matrix = assembled(op);
  if (matrix.is_null())
    return Teuchos::null;
  const auto blocks = block_diagonal_inverse(matrix, largest_block, name);
  if (blocks.exact)
    return as_operator(blocks.inverse);
  return direct_is_cheap(*matrix) ? gathered_direct(matrix, name) : Teuchos::null;
}

RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name) {
  const auto cheap = cheap_exact_inverse(op, name);
  return cheap.is_null() ? conjugate_gradient_inverse(op, 1e-14, 20000, name) : cheap;
}

}  // namespace lockstep
