#include "stepping/scene_file.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <new>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "base/wait_for_all.hpp"
#include "parameters/command_line.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/untyped.hpp"
#include "parameters/validate.hpp"
#include "solve/solver_file.hpp"

namespace lockstep {
namespace {

const std::string solver_file_setting = "Solver/File=";

std::string named_solver_file(const Document& document) {
  if (!document.list.isSublist("Solver"))
    return "";
  const ParameterList& solver = document.list.sublist("Solver");
  return solver.isType<std::string>("File") ? solver.get<std::string>("File") : "";
}

/// True if the strategy has a tolerance, which solver files bring along, and the scene's own is not
/// given.
bool strategy_sets_tolerance(const Document& document) {
  if (!document.list.isSublist("Solver"))
    return false;
  const ParameterList& solver = document.list.sublist("Solver");
  return !solver.isParameter("Tolerance") && solver.isSublist("Strategy") &&
         solver.sublist("Strategy").isParameter("Tolerance");
}

/// Kinds of joints that there are in space alone, and what the plane has in their place.
const std::map<std::string, std::string> spatial_joints = {
    {"ball", "a ball is a hinge, so write \"hinge\""},
    {"universal", "what turns is a hinge, so write \"hinge\""},
    {"cylinder", "nothing turns about the axis that it slides along, so write \"slider\""},
    {"planar", "solids slide and turn like that without a joint, so leave it out"}};

/// Scenes are copied from space into the plane: what their joints are there, unless a plug-in has
/// such joints there too.
void check_flat_joints(Document& document, const ParameterList& valid) {
  if (!document.list.isSublist("Joints") || !valid.isSublist("Joints"))
    return;
  const ListRule& offered = list_rule(valid.getEntry("Joints"));
  ParameterList& joints = document.list.sublist("Joints");
  for (const auto& [name, entry] : entries(joints)) {
    if (!joints.isSublist(name) || !joints.sublist(name).isType<std::string>("Type"))
      continue;
    if (offered.schema_for(joints.sublist(name)))
      continue;
    const auto kind = spatial_joints.find(joints.sublist(name).get<std::string>("Type"));
    keep_mistakes(joints.sublist(name), "Type", [&, &name = name] {
      check_input(kind == spatial_joints.end(),
                  "{}: the joint \"{}\" is a \"{}\", which needs three dimensions; in 2D there are "
                  "\"hinge\", \"slider\" and \"weld\": {}.",
                  document.source.place("Joints/" + name + "/Type"), name, kind->first,
                  kind->second);
    });
  }
}

/// Before a schema is chosen by the "Type" of the strategy.
void check_strategy(Document& document) {
  if (!document.list.isSublist("Solver") || !document.list.sublist("Solver").isSublist("Strategy"))
    return;
  ParameterList& strategy = document.list.sublist("Solver").sublist("Strategy");
  keep_mistakes(strategy, "Type", [&] {
    check_strategy_is_not_gone(strategy, document.source.place("Solver/Strategy/Type"));
  });
}

}  // namespace

void complete_scene(Document& document, const std::vector<std::string>& settings,
                    const ParameterList& valid, const Communicator& comm) {
  const int dimension = document.list.get<int>("Dimension");
  // The file must be known before the other settings, whose types it may fix.
  for (const std::string& setting : settings) {
    if (setting.rfind(solver_file_setting, 0) == 0)
      set_from_command_line(document, setting, valid);
  }
  const std::string file = named_solver_file(document);
  if (!file.empty())
    keep_mistakes(document.list.sublist("Solver"), "File", [&] {
      merge(document, "Solver/Strategy",
            read_solver_file(resolve_path(document.source.file, file), comm));
      assign_types(document.list, valid, document.source, FormulaPolicy::refused);
    });
  Mistakes mistakes;
  check_strategy(document);
  for (const std::string& setting : settings) {
    if (setting.rfind(solver_file_setting, 0) == 0)
      continue;
    mistakes.collect([&] { set_from_command_line(document, setting, valid); });
    check_strategy(document);
  }
  if (dimension == 2)
    check_flat_joints(document, valid);
  const bool tolerance_of_strategy = strategy_sets_tolerance(document);
  mistakes.collect([&] { validate(document, valid); });
  mistakes.throw_all();
  if (tolerance_of_strategy) {
    ParameterList& solver = document.list.sublist("Solver");
    solver.set("Tolerance", solver.sublist("Strategy").get<double>("Tolerance"));
  }
  check_input(
      document.list.get<int>("Dimension") == dimension,
      "{}: the scene has {} dimensions, which all its vectors follow; choose another scene.",
      document.source.place("Dimension"), dimension);
}

int run_and_report(const Communicator& comm, const std::function<int()>& body) {
  std::string message;
  int code = 0;
  try {
    return body();
  } catch (const Failure& failure) {
    message = failure.what();
    code = static_cast<int>(failure.exit_code());
  } catch (const std::bad_alloc&) {
    message = "There is not enough memory for this scene: take fewer cells, or more machines.";
    code = static_cast<int>(ExitCode::solve_failed);
  } catch (const std::filesystem::filesystem_error& error) {
    message = fmt::format("Files cannot be worked with: {}.", library_message(error));
    code = static_cast<int>(ExitCode::output_failed);
  } catch (const std::exception& error) {
    message = fmt::format(
        "A library that Lockstep builds on failed ({}). Please report it, with the scene.",
        library_message(error));
    code = static_cast<int>(ExitCode::solve_failed);
  }
  // Failures are raised on all ranks alike; if this one is alone, the others cannot be reached any
  // more.
  if (is_root(comm))
    std::fprintf(stderr, "lockstep: %s\n", message.c_str());
  if (!wait_for_all(comm)) {
    if (!is_root(comm)) {
      std::fprintf(stderr, "lockstep: rank %d: %s\n", comm->getRank(), message.c_str());
    }
    MPI_Abort(raw_communicator(comm), code);
  }
  return code;
}

}  // namespace lockstep
