#include "parameters/parameter_rule.hpp"

#include <algorithm>
#include <ostream>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

std::vector<NamedEntry> entries(const ParameterList& list) {
  std::vector<NamedEntry> result;
  for (const auto& pair : list)
    result.push_back({pair.first, pair.second});
  return result;
}

void Rule::printDoc(const std::string& documentation, std::ostream& out) const {
  out << "# " << documentation;
  if (!allowed().empty())
    out << " [" << allowed() << "]";
  out << "\n";
}

void Rule::validate(const ParameterEntry& entry, const std::string& name,
                    const std::string& list_name) const {
  const std::string wrong = violation(entry);
  check_input(wrong.empty(), "In \"{}\", \"{}\" {}.", list_name, name, wrong);
}

namespace {

std::vector<double> numbers(const ParameterEntry& entry) {
  if (entry.isType<double>())
    return {Teuchos::getValue<double>(entry)};
  if (entry.isType<int>())
    return {static_cast<double>(Teuchos::getValue<int>(entry))};
  if (entry.isType<ParameterArray<double>>()) {
    return Teuchos::getValue<ParameterArray<double>>(entry).toVector();
  }
  if (entry.isType<ParameterArray<int>>()) {
    const auto& array = Teuchos::getValue<ParameterArray<int>>(entry);
    return std::vector<double>(array.begin(), array.end());
  }
  return {};
}

std::vector<std::string> words(const ParameterEntry& entry) {
  if (entry.isType<std::string>())
    return {Teuchos::getValue<std::string>(entry)};
  if (entry.isType<ParameterArray<std::string>>()) {
    return Teuchos::getValue<ParameterArray<std::string>>(entry).toVector();
  }
  return {};
}

/// -1 for what is not an array.
int array_length(const ParameterEntry& entry) {
  switch (value_type(entry)) {
    case ValueType::reals:
    case ValueType::integers:
      return static_cast<int>(numbers(entry).size());
    case ValueType::texts:
      return static_cast<int>(words(entry).size());
    default:
      return -1;
  }
}

}  // namespace

std::string ValueRule::bounds() const {
  std::string text;
  if (lower) {
    text = fmt::format(lower_excluded ? "greater than {}" : "at least {}", number_text(*lower));
  }
  if (upper)
    text += fmt::format("{}{} {}", lower ? " and " : "", upper_excluded ? "less than" : "at most",
                        number_text(*upper));
  return text;
}

std::string ValueRule::allowed() const {
  std::vector<std::string> parts;
  if (n_components > 0)
    parts.push_back(fmt::format("{} components", n_components));
  if (lower || upper)
    parts.push_back(bounds());
  if (!choices.empty())
    parts.push_back("one of " + quoted_list(choices));
  if (!variables.empty())
    parts.push_back(fmt::format("numbers or formulas of {}", fmt::join(variables, ", ")));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string ValueRule::violation(const ParameterEntry& entry) const {
  const int length = array_length(entry);
  if (n_components > 0 && length != n_components) {
    return fmt::format("has {} component{}, {}, but needs {}", length, length == 1 ? "" : "s",
                       shortened(value_text(entry)), n_components);
  }
  for (const double number : numbers(entry)) {
    const bool low = lower && (lower_excluded ? !(number > *lower) : !(number >= *lower));
    const bool high = upper && (upper_excluded ? !(number < *upper) : !(number <= *upper));
    if (low || high) {
      return fmt::format("is {}, but must be {}", shortened(value_text(entry)), bounds());
    }
  }
  for (const std::string& word : words(entry)) {
    if (choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) {
      continue;
    }
    const std::string nearest = nearest_name(word, choices);
    return fmt::format(
        "is \"{}\", but must be {}{}", shortened(word),
        choices.size() == 1 ? quoted_list(choices) : "one of " + quoted_list(choices),
        nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest));
  }
  return "";
}

const TypedSchema* ListRule::schema_for(const ParameterList& given) const {
  if (form == ListForm::named)
    return &schemas.front();
  std::string type = default_type;
  if (given.isType<std::string>("Type"))
    type = given.get<std::string>("Type");
  for (const TypedSchema& schema : schemas) {
    if (schema.type == type)
      return &schema;
  }
  return nullptr;
}

ParameterList ListRule::type_declaration() const {
  std::vector<std::string> names;
  for (const TypedSchema& schema : schemas)
    names.push_back(schema.type);
  ParameterList list;
  const std::string doc = "Type of this list, which decides its other parameters.";
  if (default_type.empty()) {
    declare_required_choice(list, "Type", names, doc);
  } else {
    declare_choice(list, "Type", default_type, names, doc);
  }
  return list;
}

const ValueRule& value_rule(const ParameterEntry& entry) {
  static const ValueRule no_rule;
  const auto* rule = dynamic_cast<const ValueRule*>(entry.validator().get());
  return rule ? *rule : no_rule;
}

const ListRule& list_rule(const ParameterEntry& entry) {
  static const ListRule plain;
  const auto* rule = dynamic_cast<const ListRule*>(entry.validator().get());
  return rule ? *rule : plain;
}

bool holds_named_lists(const ListRule& rule) {
  return rule.form == ListForm::named || rule.form == ListForm::named_typed;
}

}  // namespace lockstep
