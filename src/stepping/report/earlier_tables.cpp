#include "stepping/report/earlier_tables.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <filesystem>
#include <set>

#include "base/errors.hpp"
#include "output/on_root.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/parameter_rule.hpp"

namespace lockstep {
namespace {

namespace fs = std::filesystem;

bool has_entries(const ParameterList& scene, const std::string& list) {
  return scene.isSublist(list) && scene.sublist(list).numParams() > 0;
}

/// Names of the tables of a scene that not every run has.
std::set<std::string> tables_of(const ParameterList& scene) {
  std::set<std::string> names;
  if (has_entries(scene, "Joints"))
    names.insert("joints.csv");
  if (has_entries(scene, "Solids")) {
    for (const auto& [name, entry] : entries(scene.sublist("Solids"))) {
      if (scene.sublist("Solids").sublist(name).isParameter("Solids"))  // a line
        names.insert("lines.csv");
    }
  }
  if (has_entries(scene, "Observers")) {
    for (const auto& [name, entry] : entries(scene.sublist("Observers")))
      names.insert(name + ".csv");
  }
  return names;
}

std::set<std::string> recorded_tables(const std::string& directory) {
  const std::string file = directory + "/used-parameters.xml";
  try {
    return fs::exists(file)
               ? tables_of(
                     read_parameters(file, Communicator(Teuchos::rcp(new Teuchos::SerialComm<int>)))
                         .list)
               : std::set<std::string>();
  } catch (const Failure&) {
    return {};  // the file is somebody else's
  }
}

}  // namespace

void remove_earlier_tables(const Communicator& comm, const std::string& directory,
                           const ParameterList& scene) {
  on_root(comm, [&] {
    const std::set<std::string> kept = tables_of(scene);
    for (const std::string& name : recorded_tables(directory)) {
      const fs::path table = fs::path(directory) / name;
      // Names of observers are no paths.
      if (kept.count(name) > 0 || table.filename() != name ||
          !fs::is_regular_file(fs::symlink_status(table)))
        continue;
      std::error_code error;
      fs::remove(table, error);
      check_output(!error, "Cannot remove '{}', a table of an earlier run: {}.", table.string(),
                   error.message());
    }
  });
}

}  // namespace lockstep
