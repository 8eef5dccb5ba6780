// Compares solver strategies on one system that `simulate --dump-system` wrote.
//
//   solve tests/data/two-balls.h5 xml-params/solvers/*.xml --output results
//   mpirun -n 2 solve system.h5 xml-params/solvers/paper.xml --tolerance 1e-10
//   solve system.h5 mine.xml --plug-in libmine.so
//   solve system.h5 xml-params/solvers/*.xml --history --repeat 5 --output results
//
// Prints one row a strategy and writes DIR/solvers.csv: iterations, seconds to set up and to solve,
// the residual of each block, the largest difference to the strategy direct, memory, the inverses
// that were used. With --history a row for each power of ten down to the tolerance, each solved
// from zero, so that any strategy has a history of its true residuals and errors.
//
// Exit codes: 0 done, 2 bad input, 3 a strategy failed (the others are in the table), 4 input or
// output failed.
#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/errors.hpp"
#include "base/lone_process.hpp"
#include "base/memory.hpp"
#include "base/shortened.hpp"
#include "output/on_root.hpp"
#include "output/run_record.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/validate.hpp"
#include "programs/load_plug_ins.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "solve/solver_file.hpp"
#include "solve/system_file.hpp"
#include "stepping/scene_file.hpp"
#include "studies/process_memory.hpp"

using namespace lockstep;

namespace {

struct Arguments {
  std::string system_file, output_directory;
  std::vector<std::string> solver_files, libraries;
  double tolerance = 0;  // 0: that of each file
  int most_direct_unknowns = 100000, n_repeats = 1;
  bool wants_history = false;
};

/// Result of one strategy.
struct Row {
  std::string file, strategy, failure, inverses;
  double tolerance = 0;
  SolveReport report;
  std::optional<double> error;
  double memory_mb = 0;
};

/// A solver file holds a strategy, or the list "Solver" of a scene with the strategy inside.
ParameterList strategy_list(const std::string& file, const StrategyRegistry& strategies,
                            double& tolerance, const Communicator& comm) {
  Document document = read_solver_file(file, comm);
  const bool nested = document.list.isSublist("Strategy");
  if (document.list.isParameter("Tolerance"))
    check_readable(document.list.getEntry("Tolerance"));
  const bool is_given = nested && document.list.isType<double>("Tolerance");
  if (is_given)
    tolerance = document.list.get<double>("Tolerance");
  check_input(tolerance > 0 && tolerance < 1, "{}: \"Tolerance\" {} must lie between 0 and 1.",
              file, tolerance);
  Document strategy{ParameterList(), document.source};
  strategy.list.sublist("Strategy") = nested ? document.list.sublist("Strategy") : document.list;
  check_strategy_is_not_gone(strategy.list.sublist("Strategy"), file);
  const bool has_own = strategy.list.sublist("Strategy").isParameter("Tolerance");
  ParameterList valid;
  declare_typed_sublist(valid, "Strategy", "The solver strategy.", strategies.schemas());
  validate(strategy, valid);
  const ParameterList& list = strategy.list.sublist("Strategy");
  if (!is_given && has_own)
    tolerance = list.get<double>("Tolerance");
  return list;
}

BlockVector zero_like(const BlockVector& vector) {
  return {make_vector(vector.pressure->getMap()),
          vector.solid.is_null() ? Teuchos::null : make_vector(vector.solid->getMap())};
}

double relative_difference(const Vector& x, const Vector& exact) {
  Vector difference(x, Teuchos::Copy);
  difference.update(-1, exact, 1);
  const double size = exact.norm2();
  return size > 0 ? difference.norm2() / size : difference.norm2();
}

double error_against(const BlockVector& exact, const BlockVector& solution) {
  const double pressure = relative_difference(*solution.pressure, *exact.pressure);
  return exact.solid.is_null()
             ? pressure
             : std::max(pressure, relative_difference(*solution.solid, *exact.solid));
}

/// The solution to round-off, or why there is none.
struct Reference {
  std::optional<BlockVector> solution;
  std::string note;
};

Reference exact_solution(const StoredSystem& stored, const StrategyRegistry& strategies,
                         int most_unknowns) {
  if (stored.rhs.pressure->getGlobalLength() > static_cast<std::size_t>(most_unknowns))
    return {std::nullopt,
            fmt::format("more than {} pressure unknowns (--direct-limit)", most_unknowns)};
  try {
    const auto direct = strategies.create("direct", strategies.valid_parameters("direct"));
    BlockVector solution = zero_like(stored.rhs);
    direct->prepare(stored.system);
    direct->solve(stored.system, stored.rhs, solution, {"reference", 1e-11});
    return {solution, ""};
  } catch (const SolveError& error) {
    return {std::nullopt, error.what()};
  }
}

/// A strategy that is to be tried.
struct Candidate {
  std::string file;
  ParameterList list;
  double tolerance = 1e-8;
};

/// The system, its exact solution and the strategies that are tried on them.
struct Trial {
  const StoredSystem& stored;
  const Reference& exact;
  const StrategyRegistry& strategies;
  const Communicator& comm;
};

Row try_strategy(const Candidate& candidate, const Trial& trial) {
  const StoredSystem& stored = trial.stored;
  Row row;
  row.file = candidate.file;
  row.strategy = candidate.list.get<std::string>("Type");
  row.tolerance = candidate.tolerance;
  const double memory_before = restart_peak_memory();
  try {
    const auto strategy = trial.strategies.create(row.strategy, candidate.list);
    BlockVector solution = zero_like(stored.rhs);
    strategy->prepare(stored.system);
    row.report = strategy->solve(stored.system, stored.rhs, solution, {"S2", candidate.tolerance});
    row.inverses = strategy->inverses();
    if (trial.exact.solution)
      row.error = error_against(*trial.exact.solution, solution);
  } catch (const SolveError& error) {
    row.failure = error.what();
  }
  row.memory_mb = sum_all(trial.comm, peak_memory_since_restart() - memory_before);
  return row;
}

/// Tries it anew each time, set-up included: of the seconds the least count, as other programs only
/// ever add to them.
Row least_of(int n_repeats, const Candidate& candidate, const Trial& trial) {
  Row row = try_strategy(candidate, trial);
  for (int k = 1; k < n_repeats && row.failure.empty(); ++k) {
    const Row again = try_strategy(candidate, trial);
    row.report.setup_seconds = std::min(row.report.setup_seconds, again.report.setup_seconds);
    row.report.solve_seconds = std::min(row.report.solve_seconds, again.report.solve_seconds);
  }
  return row;
}

/// The tolerances .1, .01, ... above that of the candidate, then this.
std::vector<Candidate> with_history(const Candidate& candidate) {
  constexpr double nearly = 1.001;  // 1e-8 is no power of .1 to the last bit
  std::vector<Candidate> all;
  for (int digits = 1; std::pow(10., -digits) > nearly * candidate.tolerance; ++digits) {
    all.push_back(candidate);
    all.back().tolerance = std::pow(10., -digits);
  }
  all.push_back(candidate);
  return all;
}

std::string csv(const std::vector<Row>& rows) {
  std::string text =
      "# setup, solve [s]; residuals: of each block over its scale; error: largest relative "
      "difference of a block to the strategy direct\n"
      "# memory [MB]: peak of all ranks while setting up and solving, less what was there before\n"
      "# inverses: those that approximate A and C, as the strategy has chosen them\n"
      "file,strategy,tolerance,iterations,setup_seconds,solve_seconds,pressure_residual,"
      "solid_residual,error,memory_mb,inverses\n";
  for (const Row& row : rows) {
    if (row.failure.empty()) {
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},\"{}\"\n", row.file, row.strategy,
                          row.tolerance, row.report.iterations, row.report.setup_seconds,
                          row.report.solve_seconds, row.report.pressure_residual,
                          row.report.solid_residual, row.error ? fmt::format("{}", *row.error) : "",
                          row.memory_mb, row.inverses);
    }
  }
  return text;
}

/// The file's name tells more than the strategy's: several lists are of one strategy.
std::string line(const Row& row) {
  const std::string name = std::filesystem::path(row.file).stem().string();
  if (!row.failure.empty())
    return fmt::format("{:<18} failed: {}", name, row.failure);
  return fmt::format("{:<18} {:>10} {:>9.3f} {:>9.3f} {:>10.2e} {:>10.2e} {:>10} {:>8.1f}  {}",
                     name, row.report.iterations, row.report.setup_seconds,
                     row.report.solve_seconds, row.report.pressure_residual,
                     row.report.solid_residual, row.error ? fmt::format("{:.2e}", *row.error) : "-",
                     row.memory_mb, row.inverses);
}

std::vector<Candidate> read_candidates(const Arguments& arguments,
                                       const StrategyRegistry& strategies,
                                       const Communicator& comm) {
  std::vector<Candidate> candidates;
  for (const std::string& file : arguments.solver_files) {
    Candidate candidate{file, {}};
    candidate.list = strategy_list(file, strategies, candidate.tolerance, comm);
    if (arguments.tolerance > 0)
      candidate.tolerance = arguments.tolerance;
    if (arguments.wants_history) {
      for (Candidate& one : with_history(candidate))
        candidates.push_back(std::move(one));
    } else {
      candidates.push_back(std::move(candidate));
    }
  }
  return candidates;
}

/// The command line; none: it asked for help, which has been printed. Throws InputError.
std::optional<Arguments> read_arguments(int argc, char** argv, const Communicator& comm) {
  Arguments arguments;
  CLI::App app("Compares solver strategies on a stored system.");
  app.add_option("system", arguments.system_file, "file of simulate --dump-system")->required();
  app.add_option("solvers", arguments.solver_files, "solver files (xml-params/solvers)")
      ->required();
  app.add_option("--output", arguments.output_directory, "folder for solvers.csv; default: none");
  const auto* tolerance = app.add_option("--tolerance", arguments.tolerance,
                                         "residual to reach; default: that of each solver file");
  app.add_option("--direct-limit", arguments.most_direct_unknowns,
                 "no error is computed for systems with more pressure unknowns");
  app.add_option("--repeat", arguments.n_repeats,
                 "set up and solve so often; the least seconds count (1)");
  app.add_flag("--history", arguments.wants_history,
               "solve to .1, .01, ... down to the tolerance, each from zero");
  app.add_option("--plug-in", arguments.libraries, "library of plug-ins to load; may be repeated")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      if (is_root(comm))
        app.exit(error);
      return std::nullopt;
    }
    throw InputError(shortened(error.what(), 200) + " (see solve --help).");
  }

  check_input(tolerance->count() == 0 || (arguments.tolerance > 0 && arguments.tolerance < 1),
              "--tolerance {} must lie between 0 and 1.", arguments.tolerance);
  check_input(arguments.most_direct_unknowns >= 0, "--direct-limit {} must not be negative.",
              arguments.most_direct_unknowns);
  check_input(arguments.n_repeats >= 1, "--repeat {} must be at least 1.", arguments.n_repeats);
  return arguments;
}

int run(int argc, char** argv, const Communicator& comm) {
  // 1. The command line.
  const std::optional<Arguments> given = read_arguments(argc, argv, comm);
  if (!given)
    return static_cast<int>(ExitCode::done);
  const Arguments& arguments = *given;

  // 2. The strategies to try, the system, its exact solution.
  PlugIns plug_ins = shipped_plug_ins();
  load_plug_ins(arguments.libraries, plug_ins, comm);
  const StrategyRegistry& strategies = plug_ins.space.strategies;
  const std::vector<Candidate> candidates = read_candidates(arguments, strategies, comm);
  const StoredSystem stored = read_system(arguments.system_file, comm);
  const Reference exact = exact_solution(stored, strategies, arguments.most_direct_unknowns);
  const auto print = [&comm](const std::string& text) {
    if (is_root(comm))
      std::cout << text << std::endl;
  };
  print(fmt::format("{}: {} pressure unknowns, {} solid unknowns, {} null vectors, {} ranks",
                    stored.system.name, stored.rhs.pressure->getGlobalLength(),
                    stored.system.has_solid() ? stored.rhs.solid->getGlobalLength() : 0,
                    stored.system.null_space.size(), comm->getSize()));
  if (!exact.solution)
    print("no errors, as there is no reference: " + exact.note);
  print(fmt::format("{:<18} {:>10} {:>9} {:>9} {:>10} {:>10} {:>10} {:>8}  {}", "list",
                    "iterations", "setup [s]", "solve [s]", "res. p", "res. V", "error", "MB",
                    "inverses"));

  // 3. One after another, each from zero; the table has them as soon as they are done.
  if (!arguments.output_directory.empty())
    create_output_directory(comm, arguments.output_directory);
  std::vector<Row> rows;
  for (const Candidate& candidate : candidates) {
    rows.push_back(least_of(arguments.n_repeats, candidate, {stored, exact, strategies, comm}));
    print(line(rows.back()));
    if (!arguments.output_directory.empty())
      on_root(comm, [&] {
        write_file_atomically(arguments.output_directory + "/solvers.csv", csv(rows));
      });
  }
  const bool failed =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return !row.failure.empty(); });
  return static_cast<int>(failed ? ExitCode::solve_failed : ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  expect_no_other_ranks();
  int n_for_kokkos = 1;  // the program's name alone: of --help it would print its own
  Tpetra::ScopeGuard scope(&n_for_kokkos, &argv);
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] { return run(argc, argv, comm); });
}
