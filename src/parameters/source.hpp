#pragma once
#include <map>
#include <string>

#include "parameters/expression.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Where each parameter of a list was given, for messages. A path is the names of the lists and the
/// parameter joined by '/', without the root: "Solids/Ball 1/Density".
struct Source {
  std::string file;
  std::map<std::string, std::string> places;  // path -> "case.xml, line 14"
  std::string setting = "--set";              ///< before a setting in messages: --set "Time/End=1"

  /// The place of `path`, or of the nearest list around it that has one, or the file.
  std::string place(const std::string& path) const;
};

/// Parameters as given, and where.
struct Document {
  ParameterList list;
  Source source;
  Variables constants = {};  ///< named numbers of a scene, for settings; nan where one is a mistake
};

std::string join_path(const std::string& list_path, const std::string& name);
/// `in "Fluid/Initial state"`, or `at the top level` for the empty path.
std::string in_list(const std::string& list_path);

/// The path of a file named in `scene_file`: relative to that file's folder unless absolute.
std::string resolve_path(const std::string& scene_file, const std::string& relative);

/// Puts all of `part` (a solver file, say) into the list at `list_path` of `document`, which is
/// created if absent. What the document itself says at the same path wins. Call it before applying
/// command-line settings, whose types may come from the part. Throws InputError if one of the two
/// has a list where the other has a parameter.
void merge(Document& document, const std::string& list_path, const Document& part);

}  // namespace lockstep
