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
  document.constants = take_constants(document);
  const Variables& constants = document.constants;
  keep_mistakes(document.list, "Defaults", [&] { apply_defaults(document, solid_types); });
  make_copies(document, scene_dimension(document), constants);
  evaluate_formulas(document.list, constants, document.source);
}

namespace {

const char* const defaults_doc =
    "Values for all solids that do not say otherwise; a list that bears the name of a type, "
    "\"rigid body\", for those of that type, of which there may be none.";

void declare_include_and_constants(ParameterList& scene) {
  declare_optional<std::string>(
      scene, "Include",
      "Another scene file, relative to this one, whose parameters hold where this file is silent; "
      "an Array(string) names several. With --set they win over this file.");
  declare_free_sublist(
      scene, "Constants",
      "Named numbers (double or int). Any number of the scene may be a formula of them in "
      "brackets, "
      "value=\"[2*R]\" or \"{[R], 0}\", in the syntax of muParser; a constant of those before it. "
      "Some may also be formulas of the place x, y, z and the time t, whose names constants hide. "
      "So may numbers of settings (--set).");
}

/// Solids with what `add` puts beside the parameters of each type.
template <typename Add>
std::vector<TypedSchema> with(std::vector<TypedSchema> solids, const Add& add) {
  for (TypedSchema& solid : solids) {
    solid.parameters.remove("Type", false);
    add(solid.parameters);
  }
  return solids;
}

/// The list "Copies" of a solid, with overrides for single copies.
void declare_written_copies(ParameterList& solid, int dimension,
                            const std::vector<TypedSchema>& solids) {
  declare_copies(solid, dimension);
  const ParameterEntry entry = solid.getEntry("Copies");
  std::vector<TypedSchema> types = with(list_rule(entry).schemas, [&](ParameterList& copies) {
    declare_named_sublists(copies, "Overrides", "What is different in the copy of this number.",
                           solids);
  });
  solid.remove("Copies");
  declare_typed_sublist(solid, "Copies", entry.docString(), types);
}

}  // namespace

ParameterList written_scene(ParameterList scene, int dimension) {
  const ParameterEntry entry = scene.getEntry("Solids");
  const std::vector<TypedSchema> solids = with(list_rule(entry).schemas, [](ParameterList&) {});
  const std::vector<TypedSchema> copied =
      with(solids, [&](ParameterList& solid) { declare_written_copies(solid, dimension, solids); });
  const std::vector<TypedSchema> defaults = with(copied, [&](ParameterList& general) {
    for (const TypedSchema& solid : copied)
      declare_list(general, solid.type, solid.documentation) = solid.parameters;
  });
  scene.remove("Solids");
  declare_named_sublists(scene, "Solids", entry.docString(), copied);
  declare_include_and_constants(scene);
  declare_typed_sublist(scene, "Defaults", defaults_doc, defaults);
  return scene;
}

void declare_scene_language(ParameterList& scene, int dimension) {
  declare_include_and_constants(scene);
  declare_free_sublist(scene, "Defaults", defaults_doc);
  declare_copies(
      declare_list(scene, "(any solid)", "Parameters that every solid may have beside its own."),
      dimension);
}

}  // namespace lockstep
