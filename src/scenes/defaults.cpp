#include "scenes/defaults.hpp"

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"
#include "scenes/solids_path.hpp"

namespace lockstep {
namespace {

const std::string defaults_path = "Defaults";

bool says_otherwise(const ParameterList& given, const ParameterList& defaults, const char* key) {
  return given.isType<std::string>(key) && defaults.isType<std::string>(key) &&
         given.get<std::string>(key) != defaults.get<std::string>(key);
}

void fill_in(ParameterList& given, const std::string& path, const ParameterList& defaults,
             const std::string& from, Source& source) {
  for (const auto& [name, entry] : entries(defaults)) {
    const std::string here = join_path(path, name), there = join_path(from, name);
    if (!entry.isList()) {
      if (given.isParameter(name))
        continue;
      given.setEntry(name, entry);
      source.places[here] = source.place(there);
      continue;
    }
    const ParameterList& part = defaults.sublist(name);
    check_input(!given.isParameter(name) || given.isSublist(name),
                "{}: {}, \"{}\" is a parameter, but {} has a list of this name.",
                source.place(here), in_list(path), name, source.place(there));
    if (!given.isSublist(name)) {
      given.sublist(name);
      source.places[here] = source.place(there);
    } else if (says_otherwise(given.sublist(name), part, "Type") ||
               says_otherwise(given.sublist(name), part, "Shape")) {
      continue;
    }
    fill_in(given.sublist(name), here, part, there, source);
  }
}

}  // namespace

void apply_defaults(Document& document, const std::vector<TypedSchema>& types) {
  ParameterList& list = document.list;
  if (!list.isParameter(defaults_path))
    return;
  check_input(list.isSublist(defaults_path), "{}: \"Defaults\" must be a list.",
              document.source.place(defaults_path));
  const ParameterList defaults = list.sublist(defaults_path);
  list.remove(defaults_path);
  if (!list.isSublist(solids_path))  // a preset has defaults for scenes without solids, too
    return;
  ParameterList& solids = list.sublist(solids_path);
  ParameterList general = defaults;
  for (const TypedSchema& schema : types) {
    if (defaults.isSublist(schema.type))
      general.remove(schema.type);
  }
  for (const auto& [name, entry] : entries(solids)) {
    if (!entry.isList())
      continue;
    ParameterList& solid = solids.sublist(name);
    const std::string path = join_path(solids_path, name);
    if (!solid.isParameter("Type") && general.isParameter("Type")) {
      solid.setEntry("Type", *general.getEntryPtr("Type"));
      document.source.places[join_path(path, "Type")] =
          document.source.place(join_path(defaults_path, "Type"));
    }
    const std::string type =
        solid.isType<std::string>("Type") ? solid.get<std::string>("Type") : "";
    if (!type.empty() && defaults.isSublist(type)) {
      fill_in(solid, path, defaults.sublist(type), join_path(defaults_path, type), document.source);
    }
    fill_in(solid, path, general, defaults_path, document.source);
  }
}

}  // namespace lockstep
