// Poisson solvers of hypre beside the multigrid here, on one system that `simulate --dump-system`
// wrote with its lattice, with a random right-hand side, on one rank:
//
//   peers system.h5 [tolerance [repeats]]
//
// One line a solver: name, iterations, seconds to set up and to solve (CPU, the least of the
// repeats), true residual |b - A x| / |b|. All start from zero and end at |r| <= tolerance |b|.
#include <HYPRE_utilities.h>
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <iostream>

#include "base/errors.hpp"
#include "linear/symmetry_check.hpp"
#include "output/hdf5_file.hpp"
#include "parameters/registry.hpp"
#include "peers.hpp"
#include "solve/system_file.hpp"
#include "strategies/register_strategies.hpp"

using namespace lockstep;

namespace {

Problem read_problem(const std::string& path, const Communicator& comm) {
  Problem problem;
  const StoredSystem stored = read_system(path, comm);
  problem.system = stored.system;
  check_input(!problem.system.has_solid(), "{} has a solid block: dump F2 of a scene.", path);
  problem.matrix = assembled(problem.system.pressure_block());
  const Hdf5File file = Hdf5File::open(comm, path);
  const auto places = file.read_all<long long>("/lattice/places");
  const auto cells = file.read_all<long long>("/lattice/cells");
  problem.cell_of_row.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto& cell = problem.cell_of_row.at(problem.matrix->getRowMap()->getLocalElement(places[i]));
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<int>(cells.at(3 * i + axis));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    problem.n[axis] = static_cast<int>(file.read_attribute<long long>("/lattice", "cells " + name));
    problem.periodic[axis] = file.read_attribute<long long>("/lattice", "periodic " + name) != 0;
  }
  problem.rhs = make_vector(problem.matrix->getRowMap());
  pseudo_random(*problem.rhs, 1);
  relative_part_removed(problem.system.null_space, *problem.rhs);
  return problem;
}

Outcome lockstep_multigrid(const Problem& problem, double tolerance) {
  BlockSystem system = problem.system;
  StrategyRegistry strategies("solver strategy");
  register_strategies(strategies);
  const auto strategy = strategies.create("schur-cg", strategies.valid_parameters("schur-cg"));
  // Parts that depend on the grid alone are kept from one geometry to the next.
  strategy->prepare(system);
  ++system.geometry_version;
  Outcome outcome;
  const double start = seconds();
  strategy->prepare(system);
  outcome.setup = seconds() - start;
  outcome.x = make_vector(problem.matrix->getDomainMap());
  BlockVector x{outcome.x, Teuchos::null};
  outcome.iterations =
      strategy->solve(system, {problem.rhs, Teuchos::null}, x, {"peers", tolerance}).iterations;
  outcome.solve = seconds() - start - outcome.setup;
  return outcome;
}

double true_residual(const Problem& problem, const Vector& x) {
  Vector residual(*problem.rhs, Teuchos::Copy);
  problem.matrix->apply(x, residual, Teuchos::NO_TRANS, -1, 1);
  return residual.norm2() / problem.rhs->norm2();
}

int run(int argc, char** argv) {
  check_input(argc >= 2, "peers SYSTEM.h5 [tolerance [repeats]]");
  const double tolerance = argc > 2 ? std::atof(argv[2]) : 1e-8;
  const int n_repeats = argc > 3 ? std::atoi(argv[3]) : 3;
  const Problem problem = read_problem(argv[1], Tpetra::getDefaultComm());
  std::cout << "solver,iterations,setup_seconds,solve_seconds,residual,rows,entries\n";
  using Solve = Outcome (*)(const Problem&, double);
  const std::vector<std::pair<const char*, Solve>> solvers = {
      {"Lockstep multigrid CG", lockstep_multigrid},
      {"hypre PFMG-CG", pfmg},
      {"hypre BoomerAMG-CG", boomer_amg}};
  for (const auto& [name, solve] : solvers) {
    Outcome best;
    for (int repeat = 0; repeat < n_repeats; ++repeat) {
      const Outcome outcome = solve(problem, tolerance);
      best = {outcome.iterations, std::min(best.setup, outcome.setup),
              std::min(best.solve, outcome.solve), outcome.x};
    }
    std::cout << fmt::format("{},{},{:.4f},{:.4f},{:.2e},{},{}", name, best.iterations, best.setup,
                             best.solve, true_residual(problem, *best.x), problem.n_rows(),
                             problem.matrix->getGlobalNumEntries())
              << std::endl;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  HYPRE_Init();
  int code = 0;
  try {
    code = run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "peers: " << error.what() << std::endl;
    code = static_cast<int>(ExitCode::bad_input);
  }
  HYPRE_Finalize();
  return code;
}
