#include "parameters/validate.hpp"

#include <algorithm>
#include <vector>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/former_names.hpp"
#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/registry.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"
#include "parameters/untyped.hpp"

namespace lockstep {

namespace {

std::string description(const ParameterEntry& valid) {
  if (valid.isList())
    return "a list";
  const std::string type = type_name(value_type(valid));
  switch (value_rule(valid).presence) {
    case Presence::required:
      return type + ", required";
    case Presence::optional:
      return type + ", optional";
    default:
      return fmt::format("{}, default {}", type, quoted_value(valid));
  }
}

/// Lists are validated in place, so that references into the given list stay alive.
class Validator {
 public:
  Validator(const Source& source, const Variables& constants)
      : source_(source), constants_(constants) {}

  void check_list(ParameterList& given, const ParameterList& valid, const std::string& path) {
    for (const auto& [name, entry] : entries(given)) {
      collect(path, name, [&, &name = name, &entry = entry] {
        check_readable(entry);
        const ParameterEntry* valid_entry = valid.getEntryPtr(name);
        if (!valid_entry)
          throw InputError(unknown_name(source_.place(join_path(path, name)), path, name, valid));
        take_formulas(given, *valid_entry, name, path);
        given.getEntryPtr(name)->setDocString(valid_entry->docString());
        check_entry(entry, *valid_entry, name, path);
      });
    }
    for (const auto& [name, valid_entry] : entries(valid)) {
      collect(path, name, [&, &name = name, &valid_entry = valid_entry] {
        if (!given.isParameter(name))
          fill_in(given, valid_entry, name, path);
        if (given.isSublist(name) && valid_entry.isList())
          check_sublist(given.sublist(name), valid_entry, name, path);
      });
    }
  }

  const Mistakes& mistakes() const { return mistakes_; }

 private:
  /// One message a place and name: copies of a solid share the place.
  template <typename Function>
  void collect(const std::string& path, const std::string& name, const Function& f) {
    mistakes_.collect(f, source_.place(join_path(path, name)) + "/" + name);
  }

  /// Values of a free list need only be readable.
  void check_free_list(const ParameterList& given, const std::string& path) {
    for (const auto& [name, entry] : entries(given)) {
      if (entry.isList())
        check_free_list(given.sublist(name), join_path(path, name));
      else
        collect(path, name, [&entry = entry] { check_readable(entry); });
    }
  }

  std::string subject(const std::string& path, const std::string& name) const {
    return fmt::format("{}: {}, \"{}\"", source_.place(join_path(path, name)), in_list(path), name);
  }

  /// Puts strings in the place of a formula of place and time.
  void take_formulas(ParameterList& given, const ParameterEntry& valid, const std::string& name,
                     const std::string& path) const {
    const ParameterEntry& entry = given.getEntry(name);
    if (!entry.isType<Formula>() || valid.isList())
      return;
    const Formula formula = Teuchos::getValue<Formula>(entry);
    if (!formula.is_reduced)
      return;
    check_input(!value_rule(valid).variables.empty(),
                "{} is \"{}\", a formula of place or time, but takes constants only.",
                subject(path, name), formula.text);
    const ParameterEntry strings = as_strings(formula);
    check_names(formulas_in(strings), constants_, valid, subject(path, name));
    given.setEntry(name, strings);
  }

  /// The formulas of an entry that holds strings, one or an array; empty if it holds none.
  static std::vector<std::string> formulas_in(const ParameterEntry& entry) {
    if (entry.isType<std::string>())
      return {Teuchos::getValue<std::string>(entry)};
    if (entry.isType<ParameterArray<std::string>>())
      return Teuchos::getValue<ParameterArray<std::string>>(entry).toVector();
    return {};
  }

  /// Throws InputError for a formula that cannot be read, or names more than `known` and what the
  /// parameter may be a formula of.
  static void check_names(const std::vector<std::string>& formulas, Variables known,
                          const ParameterEntry& valid, const std::string& subject) {
    for (const std::string& variable : value_rule(valid).variables)
      known[variable] = 0;
    for (const std::string& formula : formulas)
      const Expression readable(formula, known, subject);
  }

  /// True if formulas stand in place of numbers. Throws InputError for one that cannot be read.
  bool are_formulas(const ParameterEntry& entry, const ParameterEntry& valid,
                    const std::string& name, const std::string& path) const {
    if (valid.isList() || value_rule(valid).variables.empty())
      return false;
    const ValueType wanted = value_type(valid);
    const bool is_array = entry.isType<ParameterArray<std::string>>();
    if (wanted != (is_array ? ValueType::reals : ValueType::real))
      return false;
    const std::vector<std::string> formulas = formulas_in(entry);
    for (const std::string& formula : formulas)
      check_brackets(formula, valid, subject(path, name));
    check_names(formulas, {}, valid, subject(path, name));
    return !formulas.empty();
  }

  /// Refuses a constant in a formula without brackets, which knows none.
  void check_brackets(const std::string& formula, const ParameterEntry& valid,
                      const std::string& subject) const {
    for (const std::string& name : names_in(formula)) {
      check_input(constants_.count(name) == 0 || contains(value_rule(valid).variables, name),
                  "{}: \"{}\" names the constant \"{}\", which formulas in brackets know: write "
                  "\"[{}]\" (in XML with type=\"{}\").",
                  subject, formula, name, formula, type_name(value_type(valid)));
    }
  }

  void check_entry(const ParameterEntry& entry, const ParameterEntry& valid,
                   const std::string& name, const std::string& path) const {
    const ValueType type = final_type(entry), wanted = value_type(valid);
    check_input(entry.isList() || !valid.isList(),
                "{} must be a list, <ParameterList name=\"{}\">, not a parameter.",
                subject(path, name), name);
    check_input(!entry.isList() || valid.isList(), "{} must be a parameter ({}), not a list.",
                subject(path, name), type_name(wanted));
    check_input(type == wanted || are_formulas(entry, valid, name, path),
                "{} has type \"{}\", but needs \"{}\"{}.", subject(path, name), type_name(type),
                type_name(wanted), advice(entry, wanted));
    if (entry.isList() || entry.isType<Formula>())  // a formula of a constant that is a mistake
      return;
    const std::string violation = value_rule(valid).violation(entry);
    check_input(violation.empty(), "{} {}{}", subject(path, name), violation,
                violation.empty() || violation.back() == '?' ? "" : ".");
  }

  /// The end of the sentence about a wrong type.
  std::string advice(const ParameterEntry& entry, ValueType wanted) const {
    const bool is_integer = final_type(entry) == ValueType::integer && wanted == ValueType::real;
    return fmt::format(": write type=\"{}\"{}", type_name(wanted),
                       is_integer ? fmt::format(" value=\"{}\"", value_text(entry)) : "");
  }

  void fill_in(ParameterList& given, const ParameterEntry& valid, const std::string& name,
               const std::string& path) const {
    if (valid.isList()) {
      if (list_rule(valid).form != ListForm::optional) {
        given.sublist(name, false, valid.docString());
      }
      return;
    }
    const ValueRule& rule = value_rule(valid);
    if (rule.presence == Presence::optional)
      return;
    const std::string allowed = rule.allowed();
    check_input(rule.presence != Presence::required,
                "{}: {}, the parameter \"{}\" ({}{}) is required: {}", source_.place(path),
                in_list(path), name, type_name(value_type(valid)),
                allowed.empty() ? "" : ", " + allowed, valid.docString());
    ParameterEntry entry = valid;
    entry.setValidator(Teuchos::null);
    given.setEntry(name, entry);
  }

  void check_sublist(ParameterList& given, const ParameterEntry& valid, const std::string& name,
                     const std::string& path) {
    const ListRule& rule = list_rule(valid);
    const std::string here = join_path(path, name);
    if (rule.form == ListForm::free) {
      check_free_list(given, here);
    } else if (rule.form == ListForm::typed) {
      check_list(given, chosen_schema(rule, given, source_, here), here);
    } else if (holds_named_lists(rule)) {
      check_elements(given, rule, here);
    } else {
      check_list(given, Teuchos::getValue<ParameterList>(valid), here);
    }
  }

  void check_elements(ParameterList& given, const ListRule& rule, const std::string& path) {
    for (const auto& [name, entry] : entries(given)) {
      collect(path, name, [&, &name = name, &entry = entry] {
        check_readable(entry);
        check_input(entry.isList(),
                    "{} is a parameter, but this list holds lists only: write "
                    "<ParameterList name=\"{}\">.",
                    subject(path, name), name);
        ParameterList& element = given.sublist(name);
        const std::string here = join_path(path, name);
        check_list(element, chosen_schema(rule, element, source_, here), here);
      });
    }
  }

  const Source& source_;
  const Variables& constants_;
  Mistakes mistakes_;
};

}  // namespace

std::string unknown_name(const std::string& place, const std::string& path, const std::string& name,
                         const ParameterList& valid) {
  const std::string fate = fate_of(path, name);
  if (!fate.empty())
    return fmt::format("{}: {}, \"{}\" {}.", place, in_list(path), name, fate);
  std::vector<std::string> names;
  for (const auto& [known, entry] : entries(valid))
    names.push_back(known);
  const std::string nearest = nearest_name(name, names);
  const std::string suggestion = nearest.empty()
                                     ? ""
                                     : fmt::format(" Did you mean \"{}\" ({})?", nearest,
                                                   description(*valid.getEntryPtr(nearest)));
  return fmt::format("{}: {}, \"{}\" is not a parameter.{}\nValid here: {}.", place, in_list(path),
                     shortened(name), suggestion, names.empty() ? "nothing" : quoted_list(names));
}

const ParameterList& chosen_schema(const ListRule& rule, const ParameterList& given,
                                   const Source& source, const std::string& path) {
  if (const TypedSchema* schema = rule.schema_for(given))
    return schema->parameters;
  ParameterList type;
  if (given.isParameter("Type"))
    type.setEntry("Type", given.getEntry("Type"));
  const bool is_extensible = std::any_of(rule.schemas.begin(), rule.schemas.end(),
                                         [](const TypedSchema& one) { return one.is_plug_in; });
  try {
    validate(type, rule.type_declaration(), source, path);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool is_unknown = is_extensible && given.isType<std::string>("Type");
    throw InputError(message + (is_unknown && message.back() != '?' ? hint_at_libraries : ""));
  }
  throw InputError(
      fmt::format("{}: {}, no \"Type\" is available.", source.place(path), in_list(path)));
}

void validate(ParameterList& given, const ParameterList& valid, const Source& source,
              const std::string& path, const Variables& constants) {
  assign_types(given, valid, source, FormulaPolicy::refused, path);
  Validator validator(source, constants);
  validator.check_list(given, valid, path);
  validator.mistakes().throw_all();
}

void validate(Document& document, const ParameterList& valid) {
  validate(document.list, valid, document.source, "", document.constants);
}

}  // namespace lockstep
