// Eq. 16 from a fluid and a solid of your own, solved as an XML file says: driver SOLVER.xml
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "column_fluid.hpp"
#include "coupling/coupled_system.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "piston.hpp"
#include "solve/solver_file.hpp"
#include "stepping/scene_file.hpp"
#include "strategies/register_strategies.hpp"
using namespace lockstep;

void run(const std::string& solver_file, const Communicator& comm) {
  // 1. The two sides, and how they touch: mixed dual cells, from the installed library.
  const double dt = 0.01;
  const ColumnFluid::Options column;
  const Piston::Options plate;
  ColumnFluid fluid(column, comm);
  std::vector<std::unique_ptr<SolidModel<2>>> models;
  models.push_back(std::make_unique<Piston>(plate, comm));
  SolidSystem<2> solids(std::move(models), comm);
  MixedFaceCoupling<2> coupling(MixedFaceOptions{});
  // 2. Eq. 16: [A, -B; -B^T, -C] as a Thyra operator, and its right-hand side.
  CoupledSystem<2> system(fluid, solids, coupling);
  system.freeze(solids.snapshot());
  double removed = 0;
  const BlockVector rhs = system.right_hand_side(*solids.explicit_momentum(0, dt), removed);
  // 3. Belos MINRES with a Teko block preconditioner, or whatever else the file names.
  StrategyRegistry strategies("solver strategy");
  register_strategies(strategies);
  const ParameterList list = read_solver_file(solver_file, comm).list;
  const auto strategy = strategies.create(list.get<std::string>("Type"), list);
  BlockVector solution{make_vector(fluid.pressure_map()), make_vector(solids.map())};
  const SolveReport report =
      strategy->solve(system.blocks(dt), rhs, solution, {"S2", /*tolerance*/ 1e-10});
  // 4. The velocities of both sides: all move together, at dt F / (m + rho A L).
  fluid.project(*solution.pressure);
  solids.set_velocity(*solution.solid);
  const double found = solids.states()[0].velocity.x(), far = fluid.predicted().front();
  const double exact =
      dt * plate.force / (plate.mass + column.density * column.width * column.length);
  check_solve(std::abs(found - exact) < 1e-7 * exact && std::abs(far - exact) < 1e-7 * exact,
              "Piston {} m/s, fluid {} m/s, exact {} m/s.", found, far, exact);
  if (is_root(comm))
    fmt::print("{} ranks, {} iterations: piston {} m/s, fluid {} m/s, exact {} m/s.\n",
               comm->getSize(), report.iterations, found, far, exact);
}

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] {
    check_input(argc == 2, "Usage: driver SOLVER.xml");
    run(argv[1], comm);
    return 0;
  });
}
