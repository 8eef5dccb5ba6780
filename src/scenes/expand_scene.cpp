#include "scenes/expand_scene.hpp"

#include <algorithm>
#include <limits>

#include "base/errors.hpp"
#include "parameters/command_line.hpp"
#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "scenes/copies.hpp"
#include "scenes/defaults.hpp"

namespace lockstep {
namespace {

bool concerns_the_language(const std::string& setting) {
  const std::string path = setting.substr(0, setting.find('='));
  return path.rfind("Constants/", 0) == 0 || path.rfind("Defaults/", 0) == 0 ||
         (path.rfind("Solids/", 0) == 0 && path.find("/Copies/") != std::string::npos);
}

std::string text_of(const ParameterEntry& entry) {
  return entry.isType<Formula>() ? Teuchos::getValue<Formula>(entry).text : value_text(entry);
}

/// A number, or a formula: in brackets like those of the scene, or a string as in studies.
double constant_value(const ParameterEntry& entry, const Variables& known,
                      const std::string& where) {
  switch (final_type(entry)) {
    case ValueType::text:
      return evaluate(Teuchos::getValue<std::string>(entry), known, where);
    case ValueType::integer:
    case ValueType::real:
      if (entry.isType<Formula>()) {
        const std::string text = Teuchos::getValue<Formula>(entry).text;
        return Teuchos::getValue<double>(
            parse_value(ValueType::real, substitute(text, known, where)));
      }
      return entry.isType<int>() ? Teuchos::getValue<int>(entry) : Teuchos::getValue<double>(entry);
    default:
      throw InputError(
          fmt::format("{} must be a double, an int, or a string with a formula.", where));
  }
}

/// Constants in the order of the file; each may use those before it. One that is a mistake is nan.
Variables take_constants(Document& document) {
  Variables constants;
  ParameterList& list = document.list;
  if (!list.isParameter("Constants"))
    return constants;
  const Source& source = document.source;
  check_input(list.isSublist("Constants"), "{}: \"Constants\" must be a list.",
              source.place("Constants"));
  const ParameterList given = list.sublist("Constants");
  for (const auto& [name, entry] : entries(given)) {
    const std::string where = fmt::format("{}: in \"Constants\", \"{}\"",
                                          source.place(join_path("Constants", name)), name);
    const bool is_name = name == variable_name(name) && name != "copy";
    double value = std::numeric_limits<double>::quiet_NaN();
    keep_mistakes(list, join_path("Constants", name), [&, &entry = entry] {
      check_readable(entry);
      check_input(
          is_name,
          "{} cannot be the name of a number; use letters, digits and _, no digit first, and "
          "not \"copy\".",
          where);
      if (!uses_mistake(text_of(entry), constants))
        value = constant_value(entry, constants, where);
    });
    if (is_name)
      constants[name] = value;
  }
  list.remove("Constants");
  return constants;
}

}  // namespace

int scene_dimension(const Document& document) {
  const ParameterList& list = document.list;
  if (list.isParameter("Dimension"))
    check_readable(list.getEntry("Dimension"));
  check_input(list.isType<int>("Dimension"), "{}: \"Dimension\" (int) is required; it is 2 or 3.",
              document.source.file);
  const int dimension = list.get<int>("Dimension");
  check_input(dimension == 2 || dimension == 3, "{}: \"Dimension\" is {}; it must be 2 or 3.",
              document.source.place("Dimension"), dimension);
  return dimension;
}

void expand_scene(Document& document, std::vector<std::string>& settings,
                  const std::vector<TypedSchema>& solid_types) {
  const auto others =
      std::stable_partition(settings.begin(), settings.end(), concerns_the_language);
  for (auto setting = settings.begin(); setting != others; ++setting)
    set_unchecked(document, *setting);
  settings.erase(settings.begin(), others);
  const Variables constants = take_constants(document);
  keep_mistakes(document.list, "Defaults", [&] { apply_defaults(document, solid_types); });
  make_copies(document, scene_dimension(document), constants);
  evaluate_formulas(document.list, constants, document.source);
}

void declare_scene_language(ParameterList& scene, int dimension) {
  declare_optional<std::string>(
      scene, "Include",
      "Another scene file, relative to this one, whose parameters hold where this file is silent; "
      "an Array(string) names several. With --set they win over this file.");
  declare_free_sublist(
      scene, "Constants",
      "Named numbers (double or int). Any number of the scene may be a formula of them in "
      "brackets, "
      "value=\"[2*R]\" or \"{[R], 0}\", in the syntax of muParser; a constant of those before it. "
      "Some may also be formulas of the place x, y, z and the time t, whose names constants hide.");
  declare_free_sublist(
      scene, "Defaults",
      "Values for all solids that do not say otherwise; a list that bears the name of a type, "
      "\"rigid body\", for those of that type, of which there may be none.");
  declare_copies(
      declare_list(scene, "(any solid)", "Parameters that every solid may have beside its own."),
      dimension);
}

}  // namespace lockstep
