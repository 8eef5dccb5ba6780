// The solvers of hypre that peers.cpp compares.
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>
#include <HYPRE_struct_ls.h>
#include <HYPRE_utilities.h>

#include "peers.hpp"

namespace lockstep {

namespace {
constexpr int most_iterations = 500;
}  // namespace

/// PFMG on the whole box, red-black Gauss-Seidel; cells without an unknown are rows of the
/// identity.
Outcome pfmg(const Problem& problem, double tolerance) {
  const std::size_t n_cells = problem.place({0, 0, problem.n[2]});
  std::vector<double> values(7 * n_cells, 0), rhs(n_cells, 0), zero(n_cells, 0);
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    values[7 * cell] = 1;
  for_each_entry_of(problem, [&](int row, int column, double value) {
    const int side = side_towards(problem, row, column);
    values[7 * problem.place(problem.cell_of_row[row]) + side + 1] = value;
  });
  // A row that A leaves empty is a null vector, and a row of the identity does no harm.
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    if (values[7 * cell] == 0)
      values[7 * cell] = 1;
  const auto b = problem.rhs->getData();
  for (int row = 0; row < problem.n_rows(); ++row)
    rhs[problem.place(problem.cell_of_row[row])] = b[row];

  const MPI_Comm comm = MPI_COMM_WORLD;
  std::array<HYPRE_Int, 3> lower{0, 0, 0}, upper{}, period{};
  for (int axis = 0; axis < 3; ++axis) {
    upper[axis] = problem.n[axis] - 1;
    period[axis] = problem.periodic[axis] ? problem.n[axis] : 0;
  }
  HYPRE_StructGrid grid;
  HYPRE_StructGridCreate(comm, 3, &grid);
  HYPRE_StructGridSetExtents(grid, lower.data(), upper.data());
  HYPRE_StructGridSetPeriodic(grid, period.data());
  HYPRE_StructGridAssemble(grid);
  HYPRE_StructStencil stencil;
  HYPRE_StructStencilCreate(3, 7, &stencil);
  std::array<HYPRE_Int, 7> entries{};
  for (int entry = 0; entry < 7; ++entry) {
    std::array<HYPRE_Int, 3> offset{0, 0, 0};
    if (entry > 0)
      offset[(entry - 1) / 2] = entry % 2 == 1 ? -1 : 1;
    HYPRE_StructStencilSetElement(stencil, entry, offset.data());
    entries[entry] = entry;
  }
  HYPRE_StructMatrix a;
  HYPRE_StructMatrixCreate(comm, grid, stencil, &a);
  HYPRE_StructMatrixInitialize(a);
  HYPRE_StructMatrixSetBoxValues(a, lower.data(), upper.data(), 7, entries.data(), values.data());
  HYPRE_StructMatrixAssemble(a);
  HYPRE_StructVector f, x;
  for (auto [vector, from] : {std::pair{&f, &rhs}, std::pair{&x, &zero}}) {
    HYPRE_StructVectorCreate(comm, grid, vector);
    HYPRE_StructVectorInitialize(*vector);
    HYPRE_StructVectorSetBoxValues(*vector, lower.data(), upper.data(), from->data());
    HYPRE_StructVectorAssemble(*vector);
  }

  HYPRE_StructSolver solver, cycle;
  HYPRE_StructPCGCreate(comm, &solver);
  HYPRE_StructPCGSetMaxIter(solver, most_iterations);
  HYPRE_StructPCGSetTol(solver, tolerance);
  HYPRE_StructPCGSetTwoNorm(solver, 1);
  HYPRE_StructPFMGCreate(comm, &cycle);
  HYPRE_StructPFMGSetMaxIter(cycle, 1);
  HYPRE_StructPFMGSetTol(cycle, 0);
  HYPRE_StructPFMGSetZeroGuess(cycle);
  HYPRE_StructPFMGSetRelaxType(cycle, 2);  // symmetric red-black Gauss-Seidel
  HYPRE_StructPFMGSetNumPreRelax(cycle, 1);
  HYPRE_StructPFMGSetNumPostRelax(cycle, 1);
  HYPRE_StructPCGSetPrecond(solver, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, cycle);
  Outcome outcome;
  const double start = seconds();
  HYPRE_StructPCGSetup(solver, a, f, x);
  outcome.setup = seconds() - start;
  HYPRE_StructPCGSolve(solver, a, f, x);
  outcome.solve = seconds() - start - outcome.setup;
  HYPRE_Int iterations = 0;
  HYPRE_StructPCGGetNumIterations(solver, &iterations);
  outcome.iterations = iterations;
  HYPRE_StructVectorGetBoxValues(x, lower.data(), upper.data(), zero.data());
  outcome.x = make_vector(problem.matrix->getDomainMap());
  for (int row = 0; row < problem.n_rows(); ++row)
    outcome.x->replaceLocalValue(row, zero[problem.place(problem.cell_of_row[row])]);
  HYPRE_StructPFMGDestroy(cycle);
  HYPRE_StructPCGDestroy(solver);
  HYPRE_StructVectorDestroy(x);
  HYPRE_StructVectorDestroy(f);
  HYPRE_StructMatrixDestroy(a);
  HYPRE_StructStencilDestroy(stencil);
  HYPRE_StructGridDestroy(grid);
  return outcome;
}

/// As hypre's manual recommends for such problems in 3D: PMIS, extended+i, few entries a row.
Outcome boomer_amg(const Problem& problem, double tolerance) {
  const MPI_Comm comm = MPI_COMM_WORLD;
  const HYPRE_BigInt first = 0, last = problem.n_rows() - 1;
  HYPRE_IJMatrix ij;
  HYPRE_IJMatrixCreate(comm, first, last, first, last, &ij);
  HYPRE_IJMatrixSetObjectType(ij, HYPRE_PARCSR);
  HYPRE_IJMatrixInitialize(ij);
  for_each_entry_of(problem, [&](HYPRE_BigInt row, HYPRE_BigInt column, double value) {
    HYPRE_Int one = 1;
    HYPRE_IJMatrixSetValues(ij, 1, &one, &row, &column, &value);
  });
  HYPRE_IJMatrixAssemble(ij);
  std::vector<double> rhs(problem.n_rows()), zero(problem.n_rows(), 0);
  std::vector<HYPRE_BigInt> ids(problem.n_rows());
  const auto b = problem.rhs->getData();
  for (int row = 0; row < problem.n_rows(); ++row) {
    ids[row] = row;
    rhs[row] = b[row];
  }
  HYPRE_IJVector f_ij, x_ij;
  for (auto [vector, from] : {std::pair{&f_ij, &rhs}, std::pair{&x_ij, &zero}}) {
    HYPRE_IJVectorCreate(comm, first, last, vector);
    HYPRE_IJVectorSetObjectType(*vector, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*vector);
    HYPRE_IJVectorSetValues(*vector, problem.n_rows(), ids.data(), from->data());
    HYPRE_IJVectorAssemble(*vector);
  }
  HYPRE_ParCSRMatrix a;
  HYPRE_ParVector f, x;
  HYPRE_IJMatrixGetObject(ij, reinterpret_cast<void**>(&a));
  HYPRE_IJVectorGetObject(f_ij, reinterpret_cast<void**>(&f));
  HYPRE_IJVectorGetObject(x_ij, reinterpret_cast<void**>(&x));

  HYPRE_Solver solver, cycle;
  HYPRE_ParCSRPCGCreate(comm, &solver);
  HYPRE_ParCSRPCGSetMaxIter(solver, most_iterations);
  HYPRE_ParCSRPCGSetTol(solver, tolerance);
  HYPRE_ParCSRPCGSetTwoNorm(solver, 1);
  HYPRE_BoomerAMGCreate(&cycle);
  HYPRE_BoomerAMGSetCoarsenType(cycle, 8);
  HYPRE_BoomerAMGSetInterpType(cycle, 6);
  HYPRE_BoomerAMGSetPMaxElmts(cycle, 4);
  HYPRE_BoomerAMGSetAggNumLevels(cycle, 1);
  HYPRE_BoomerAMGSetStrongThreshold(cycle, 0.5);
  HYPRE_BoomerAMGSetRelaxType(cycle, 6);  // symmetric hybrid Gauss-Seidel
  HYPRE_BoomerAMGSetTol(cycle, 0);
  HYPRE_BoomerAMGSetMaxIter(cycle, 1);
  HYPRE_ParCSRPCGSetPrecond(solver, HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup, cycle);
  Outcome outcome;
  const double start = seconds();
  HYPRE_ParCSRPCGSetup(solver, a, f, x);
  outcome.setup = seconds() - start;
  HYPRE_ParCSRPCGSolve(solver, a, f, x);
  outcome.solve = seconds() - start - outcome.setup;
  HYPRE_Int iterations = 0;
  HYPRE_ParCSRPCGGetNumIterations(solver, &iterations);
  outcome.iterations = iterations;
  HYPRE_IJVectorGetValues(x_ij, problem.n_rows(), ids.data(), zero.data());
  outcome.x = make_vector(problem.matrix->getDomainMap());
  for (int row = 0; row < problem.n_rows(); ++row)
    outcome.x->replaceLocalValue(row, zero[row]);
  HYPRE_BoomerAMGDestroy(cycle);
  HYPRE_ParCSRPCGDestroy(solver);
  HYPRE_IJVectorDestroy(x_ij);
  HYPRE_IJVectorDestroy(f_ij);
  HYPRE_IJMatrixDestroy(ij);
  return outcome;
}

}  // namespace lockstep
