// Runs a study: one scene along a ladder (grid, time step, ranks, any parameter), measured against
// a reference.
//
//   converge xml-params/studies/added-mass-disc.xml --output results
//   converge study.xml --rungs 1:4 --jobs 2        converge study.xml --list
//   converge --parameters                          what a study file may say
//
// Writes DIR/table.csv, DIR/table.md and DIR/plot.png, and DIR/curves.csv and curves.png if the
// study asks for curves; the runs are kept in DIR/runs and used again
// if neither scene, case nor program changed. Runs serially and starts `simulate`, which lies
// beside it, through mpirun where a case asks for ranks.
//
// Exit codes: 0 done, 2 bad input (a quantity or curve that cannot be measured among it), 4 output
// failed;
// that of the first failed run otherwise; in both cases after the table of the rest is written.
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "base/shortened.hpp"
#include "output/atomic_file.hpp"
#include "output/progress.hpp"
#include "output/provenance/build_information.hpp"
#include "parameters/reference.hpp"
#include "studies/child_process.hpp"
#include "studies/curves.hpp"
#include "studies/expression_check.hpp"
#include "studies/orders.hpp"
#include "studies/status_line.hpp"
#include "studies/study_table.hpp"
#include "studies/work_precision.hpp"

using namespace lockstep;
namespace fs = std::filesystem;

namespace {

struct Arguments {
  std::string study_file, rungs, series;
  RunnerOptions runner;
  bool list = false, parameters = false;
  std::string format = "text";
};

/// The folder of this program.
fs::path program_folder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

/// Writes a picture of DIR/`table` with a program of tools/; that it cannot is worth a warning
/// only.
void plot(const std::string& directory, const std::string& tool, const std::string& table,
          const std::string& picture) {
  std::string script = LOCKSTEP_TOOLS_DIRECTORY "/" + tool;
  const fs::path installed = program_folder().parent_path() / "share/lockstep/tools" / tool;
  if (!fs::exists(script))
    script = installed;
  const std::string errors = directory + "/plot-errors.txt";
  const int exit_code =
      fs::exists(script) ? run_child({script, directory + "/" + table, directory + "/" + picture},
                                     "/dev/null", errors)
                               .exit_code
                         : 127;
  if (exit_code != 0) {
    std::cerr << fmt::format("Warning: no plot was made: {}\n", fs::exists(errors)
                                                                    ? read_whole_file(errors)
                                                                    : script + " does not exist.");
  }
  std::error_code ignored;
  fs::remove(errors, ignored);
}

std::string outcome_text(const CaseOutcome& outcome) {
  if (outcome.reused)
    return "used again";
  const std::string seconds = format_seconds(outcome.seconds);
  return outcome.done ? fmt::format("done in {}", seconds)
                      : fmt::format("failed after {} with exit code {}: {}", seconds,
                                    outcome.exit_code, outcome.message);
}

/// Columns of the terminal that shows what we say; 0 if none does.
std::size_t terminal_width() {
  winsize size = {};
  if (isatty(STDOUT_FILENO) == 0)
    return 0;
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::vector<CaseOutcome> run_cases_and_tell(const std::vector<StudyCase>& cases,
                                            const RunnerOptions& options) {
  StatusLine status(std::cout, std::cerr, cases.size(), terminal_width());
  return run_cases(
      cases, options,
      [&](std::size_t i, const CaseOutcome& outcome) {
        status.ended(cases[i].directory, outcome_text(outcome), !outcome.done);
      },
      [&](std::size_t i, const std::string& log) { status.started(cases[i].directory, log); });
}

/// Removes the results of an earlier call, which must not pass for those of this one.
void remove_results(const std::string& directory) {
  for (const char* file : {"table.csv", "table.md", "plot.png", "curves.csv", "curves.png"}) {
    std::error_code error;
    fs::remove(fs::path(directory) / file, error);
    check_output(!error, "Cannot remove '{}/{}': {}.", directory, file, error.message());
  }
}

int run_study(const Study& study, const Arguments& arguments) {
  // 3. The cases.
  const std::vector<StudyCase> cases =
      study_cases(study, arguments.rungs.empty() ? RungRange() : parse_rungs(arguments.rungs));
  check_expressions(study, cases);
  if (arguments.list) {
    for (const StudyCase& one : cases) {
      std::cout << fmt::format("{} ({} ranks)\n", one.directory, one.ranks);
      for (const std::string& assignment : one.assignments)
        std::cout << "  " << assignment << "\n";
    }
    return 0;
  }

  // 4. Run them.
  const std::string& directory = arguments.runner.output_directory;
  fs::create_directories(directory);
  forward_signals_to_children();
  const std::vector<CaseOutcome> outcomes = run_cases_and_tell(cases, arguments.runner);

  // 5. Measure what is there.
  remove_results(directory);
  bool all_measured = true;
  const auto tell = [&all_measured](const std::string& sentence) {
    std::cerr << "converge: " << sentence << "\n";
    all_measured = false;
  };
  const std::vector<StudyRow> table = study_table(study, cases, outcomes, tell);
  write_file_atomically(directory + "/table.csv", table_csv(study, table));
  write_file_atomically(directory + "/table.md", table_markdown(study, table) +
                                                     orders_markdown(study, table) +
                                                     targets_markdown(study, table));
  if (const std::string note = note_on_abscissa(study, table); !note.empty())
    std::cerr << "converge: " << note << "\n";
  if (!table.empty())
    plot(directory, "plot-study", "table.csv", "plot.png");
  const std::string curves = curves_csv(study, cases, outcomes, tell);
  if (!curves.empty()) {
    write_file_atomically(directory + "/curves.csv", curves);
    plot(directory, "plot-curves", "curves.csv", "curves.png");
  }
  std::cout << fmt::format("{} of {} cases, {} rows in {}/table.md\n",
                           std::count_if(outcomes.begin(), outcomes.end(),
                                         [](const CaseOutcome& one) { return one.done; }),
                           cases.size(), table.size(), directory);
  for (const CaseOutcome& outcome : outcomes) {
    if (outcome.exit_code != 0)
      return outcome.exit_code;
  }
  if (forwarded_signal() != 0)
    return 128 + forwarded_signal();
  return all_measured ? 0 : static_cast<int>(ExitCode::bad_input);
}

int run(int argc, char** argv) {
  // 1. The command line.
  Arguments arguments;
  CLI::App app("Runs a study: a scene along a ladder of parameters, with tables and a plot.");
  app.set_version_flag("--version", "lockstep " + build_information().version + " (" +
                                        build_information().git_hash + ")");
  app.add_option("study", arguments.study_file, "study file (xml-params/studies)");
  app.add_option("--output", arguments.runner.output_directory,
                 "output folder; default: the name of the study");
  app.add_option("--rungs", arguments.rungs, "part of the ladder, counted from 1: first:last");
  app.add_option("--series", arguments.series, "only series whose names match this expression");
  app.add_option("--jobs", arguments.runner.n_jobs,
                 "cases at a time; their seconds are marked as shared")
      ->check(CLI::PositiveNumber);
  app.add_flag("--fresh", arguments.runner.fresh, "run everything again");
  app.add_flag("--list", arguments.list, "print the cases without running them");
  app.add_option("--simulate", arguments.runner.simulate, "program to run instead of simulate");
  app.add_option("--plug-in", arguments.runner.plug_ins,
                 "library of plug-ins that it loads; may be repeated")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--parameters", arguments.parameters, "print what a study file may say");
  app.add_option("--format", arguments.format, "of --parameters: text or json")
      ->check(CLI::IsMember({"text", "json"}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
      return app.exit(error);
    throw InputError(shortened(error.what(), 200) + " (see converge --help).");
  }
  if (arguments.parameters) {
    std::cout << (arguments.format == "json" ? reference_json(study_parameters())
                                             : reference_text(study_parameters()));
    return 0;
  }
  check_input(!arguments.study_file.empty(),
              "Which study? Name a file, for example xml-params/studies/added-mass-disc.xml.");
  if (arguments.runner.simulate.empty())
    arguments.runner.simulate = program_folder() / "simulate";
  if (arguments.runner.output_directory.empty())
    arguments.runner.output_directory = fs::path(arguments.study_file).stem();

  // 2. The study file, read strictly.
  Study study = read_study(arguments.study_file);
  if (!arguments.series.empty())
    keep_series(arguments.series, study);
  return run_study(study, arguments);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Failure& failure) {
    std::cerr << failure.what() << std::endl;
    return static_cast<int>(failure.exit_code());
  } catch (const std::exception& error) {
    std::cerr << fmt::format("The study cannot go on: {}.", library_message(error)) << std::endl;
    return static_cast<int>(ExitCode::output_failed);
  }
}
