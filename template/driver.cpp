// The frame of every Lockstep program: start MPI and Kokkos, work, report a failure once.
// The work here: the hydrostatic pressure of a water column, open at the top.
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <cstdio>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/preconditioner.hpp"
#include "linear/triplet_matrix.hpp"

namespace {

using namespace lockstep;

constexpr int n_cells_per_rank = 16;
constexpr double height = 2;           // [m]
constexpr double weight = 1000 * 9.8;  // density times gravity [N/m^3]

// The rows of h^2 G^T G: a wall below the first cell, p = 0 half a cell above the last.
RCP<CrsMatrix> pressure_matrix(const RCP<const Map>& cells) {
  const GlobalIndex last = cells->getMaxAllGlobalIndex();
  std::vector<Triplet> triplets;
  for (GlobalIndex cell = cells->getMinGlobalIndex(); cell <= cells->getMaxGlobalIndex(); ++cell) {
    if (cell == last) {
      triplets.push_back({cell, cell, 2.0});
    } else {
      triplets.push_back({cell, cell, 1.0});
      triplets.push_back({cell, cell + 1, -1.0});
      triplets.push_back({cell + 1, cell, -1.0});
      triplets.push_back({cell + 1, cell + 1, 1.0});
    }
  }
  return assemble_triplets(std::move(triplets), cells, cells);
}

void run(const Communicator& comm) {
  // 1. The unknowns, distributed, and the operator.
  const RCP<const Map> cells = make_map(n_cells_per_rank, comm);
  const RCP<const LinearOperator> matrix = as_operator(pressure_matrix(cells));
  const double h = height / static_cast<double>(cells->getGlobalNumElements());

  // 2. Gravity pulls on every face but the wall, whose cell keeps the difference.
  const RCP<Vector> rhs = make_vector(cells);
  if (cells->isNodeGlobalElement(0))
    rhs->replaceGlobalValue(0, weight * h);

  // 3. A preconditioner by name, and the solve.
  Teuchos::ParameterList list;
  list.set("Type", "Jacobi");
  const auto jacobi = preconditioner_from_list(matrix, list, "pressure block");
  const RCP<Vector> pressure = make_vector(cells);
  ConjugateGradientsRequest request;
  request.name = "hydrostatic pressure";
  request.target = 1e-10 * rhs->norm2();
  request.maximum_iterations = 1000;
  const int iterations = conjugate_gradients(
      [&](const Vector& x, Vector& y) { apply(*matrix, x, y); },
      [&](const Vector& x, Vector& y) { apply(*jacobi, x, y); }, *rhs, *pressure, request);

  // 4. Compare the pressure of the lowest cell, the largest, with the exact one.
  const double found = pressure->normInf();
  const double exact = weight * (height - 0.5 * h);
  check_solve(std::abs(found - exact) < 1e-6 * exact,
              "The pressure at the bottom is {} Pa instead of {} Pa after {} iterations.", found,
              exact, iterations);
  if (is_root(comm)) {
    fmt::print("{} ranks, {} iterations: {:.1f} Pa at the bottom, as it should be.\n",
               comm->getSize(), iterations, found);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const Communicator comm = Tpetra::getDefaultComm();
  try {
    run(comm);
  } catch (const Failure& failure) {
    if (is_root(comm))
      fmt::print(stderr, "{}\n", failure.what());
    return static_cast<int>(failure.exit_code());
  }
  return 0;
}
