#include "parameters/untyped.hpp"

#include <algorithm>
#include <ostream>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/mistakes.hpp"

namespace lockstep {

namespace {

using Scalar = Untyped::Scalar;

bool is_array(ValueType type) {
  return type == ValueType::reals || type == ValueType::integers || type == ValueType::texts;
}

/// The value as XML has it: "{1, 2}".
std::string xml_text(const Untyped& value) {
  if (!value.is_array)
    return value.scalars.front().text;
  std::vector<std::string> texts;
  for (const Scalar& scalar : value.scalars)
    texts.push_back(scalar.text);
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

/// The value for messages: "[1, 2]", without quotes if it is no array.
std::string written(const Untyped& value) {
  std::string text = xml_text(value);
  if (value.is_array) {
    text.front() = '[';
    text.back() = ']';
  }
  return shortened(text);
}

bool has_formula(const Untyped& value) {
  return std::any_of(value.scalars.begin(), value.scalars.end(), [](const Scalar& scalar) {
    return scalar.text.find('[') != std::string::npos;
  });
}

bool is_number(const Scalar& scalar) {
  if (scalar.is_quoted)
    return false;
  try {
    parse_value(ValueType::real, scalar.text);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool are_numbers(const Untyped& value) {
  return std::all_of(value.scalars.begin(), value.scalars.end(), is_number);
}

/// Strings of arrays are joined by commas where parameters are written as XML.
ParameterEntry as_texts(const Untyped& value) {
  ParameterArray<std::string> texts;
  for (const Scalar& scalar : value.scalars)
    texts.push_back(scalar.text);
  const ParameterEntry joined = parse_value(ValueType::texts, xml_text(value));
  check_input(Teuchos::getValue<ParameterArray<std::string>>(joined) == texts,
              "is {}, but strings of an array hold no comma and neither begin nor end with a blank",
              written(value));
  return joined;
}

void check_form(const Untyped& value, ValueType type) {
  check_input(value.is_array || !is_array(type),
              "is \"{}\", but an array is written in brackets: [1, 2, 3]", written(value));
  check_input(!value.is_array || is_array(type),
              "is the array {}, but must be one value; a formula in brackets is written in quotes: "
              "\"[2*R]\"",
              written(value));
}

ParameterEntry as_boolean(const Scalar& scalar) {
  const bool is_boolean = !scalar.is_quoted && (scalar.text == "true" || scalar.text == "false");
  check_input(is_boolean, "is \"{}\", but a bool is written true or false, without quotes",
              shortened(scalar.text));
  return ParameterEntry(scalar.text == "true");
}

/// `is_expression`: strings may stand in place of the numbers.
ParameterEntry as_numbers(const Untyped& value, ValueType type, bool is_expression,
                          FormulaPolicy formulas) {
  if (formulas == FormulaPolicy::kept && has_formula(value)) {
    if (value.is_array)
      as_texts(value);  // a comma in a formula must not make two of it
    return ParameterEntry(Formula{type, xml_text(value)});
  }
  if (is_expression && !are_numbers(value))
    return value.is_array ? as_texts(value) : ParameterEntry(value.scalars.front().text);
  for (const Scalar& scalar : value.scalars) {
    check_input(!scalar.is_quoted,
                "is the string \"{}\", but must be a number: take the quotes away",
                shortened(scalar.text));
  }
  return parse_value(type, xml_text(value));
}

/// Throws InputError with the predicate of a sentence.
ParameterEntry typed(const Untyped& value, ValueType type, bool is_expression,
                     FormulaPolicy formulas) {
  check_form(value, type);
  switch (type) {
    case ValueType::text:
      return ParameterEntry(value.scalars.front().text);
    case ValueType::texts:
      return as_texts(value);
    case ValueType::boolean:
      return as_boolean(value.scalars.front());
    default:
      return as_numbers(value, type, is_expression, formulas);
  }
}

ParameterEntry inferred(const Untyped& value, FormulaPolicy formulas) {
  if (formulas == FormulaPolicy::kept && has_formula(value))
    return typed(value, value.is_array ? ValueType::reals : ValueType::real, false, formulas);
  if (!value.is_array) {
    const Scalar& scalar = value.scalars.front();
    return scalar.is_quoted ? ParameterEntry(scalar.text) : infer_value(scalar.text);
  }
  if (!are_numbers(value))
    return as_texts(value);
  try {
    return parse_value(ValueType::integers, xml_text(value));
  } catch (const InputError&) {
    return parse_value(ValueType::reals, xml_text(value));
  }
}

/// Schemas that a list may have: several as long as no "Type" chooses, none of a free list.
using Schemas = std::vector<const ParameterList*>;

/// Schemas of the list `given` of a rule that has some.
Schemas schemas_of(const ListRule& rule, const ParameterList& given) {
  const TypedSchema* chosen = rule.schema_for(given);
  if (chosen && (given.isParameter("Type") || rule.schemas.size() == 1))
    return {&chosen->parameters};
  Schemas schemas;  // an included file, a default or a solver file may say the type
  if (chosen)
    schemas.push_back(&chosen->parameters);
  for (const TypedSchema& schema : rule.schemas)
    schemas.push_back(&schema.parameters);
  return schemas;
}

/// Walks through a list and its schemas.
class TypeAssigner {
 public:
  TypeAssigner(const Source& source, FormulaPolicy formulas)
      : source_(source), formulas_(formulas) {}

  void assign(ParameterList& list, const Schemas& schemas, const std::string& path) const {
    for (const auto& [name, entry] : entries(list)) {
      if (entry.isType<Untyped>())
        put(list, name, path, [&, &name = name, &entry = entry] {
          return value_of(Teuchos::getValue<Untyped>(entry), schemas, name);
        });
    }
    for (const auto& [name, entry] : entries(list)) {
      if (entry.isList())
        assign_sublist(list.sublist(name), schemas, name, join_path(path, name));
    }
  }

  /// Puts what `make` returns into the list, or a `Mistake` with the predicate that it throws.
  template <typename Make>
  void put(ParameterList& list, const std::string& name, const std::string& path,
           const Make& make) const {
    try {
      list.setEntry(name, make());
    } catch (const InputError& error) {
      list.setEntry(name, ParameterEntry(Mistake{{fmt::format(
                              "{}: {}, \"{}\" {}.", source_.place(join_path(path, name)),
                              in_list(path), name, error.what())}}));
    }
  }

 private:
  ParameterEntry value_of(const Untyped& value, const Schemas& schemas,
                          const std::string& name) const {
    for (const ParameterList* schema : schemas) {
      const ParameterEntry* valid = schema->getEntryPtr(name);
      if (!valid)
        continue;
      check_input(!valid->isList(),
                  "must be a list, with its parameters indented in the lines below, not a value");
      const ValueType type = value_type(*valid);
      try {
        return typed(value, type, !value_rule(*valid).variables.empty(), formulas_);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{} (type \"{}\")", error.what(), type_name(type)));
      }
    }
    return inferred(value, formulas_);
  }

  void assign_sublist(ParameterList& list, const Schemas& schemas, const std::string& name,
                      const std::string& path) const {
    Schemas inner;
    for (const ParameterList* schema : schemas) {
      const ParameterEntry* valid = schema->getEntryPtr(name);
      if (!valid || !valid->isList())
        continue;
      const ListRule& rule = list_rule(*valid);
      if (holds_named_lists(rule))
        return assign_elements(list, rule, path);
      if (rule.form == ListForm::typed) {
        assign_type(list, "Type", ValueType::text, source_, path);
        for (const ParameterList* one : schemas_of(rule, list))
          inner.push_back(one);
      } else if (rule.form != ListForm::free) {
        inner.push_back(&Teuchos::getValue<ParameterList>(*valid));
      }
    }
    assign(list, inner, path);
  }

  void assign_elements(ParameterList& list, const ListRule& rule, const std::string& path) const {
    for (const auto& [name, entry] : entries(list)) {
      if (entry.isType<Untyped>())
        put(list, name, path, []() -> ParameterEntry {
          throw InputError(
              "is a value, but this list holds lists only, each with its parameters indented below "
              "its name");
        });
      if (!entry.isList())
        continue;
      ParameterList& element = list.sublist(name);
      const std::string here = join_path(path, name);
      if (rule.form == ListForm::named_typed)
        assign_type(element, "Type", ValueType::text, source_, here);
      assign(element, schemas_of(rule, element), here);
    }
  }

  const Source& source_;
  FormulaPolicy formulas_;
};

}  // namespace

bool operator==(const Untyped& a, const Untyped& b) {
  const auto same = [](const Scalar& x, const Scalar& y) {
    return x.text == y.text && x.is_quoted == y.is_quoted;
  };
  return a.is_array == b.is_array && a.scalars.size() == b.scalars.size() &&
         std::equal(a.scalars.begin(), a.scalars.end(), b.scalars.begin(), same);
}

std::ostream& operator<<(std::ostream& out, const Untyped& value) {
  return out << written(value);
}

bool has_untyped(const ParameterList& list) {
  const std::vector<NamedEntry> all = entries(list);
  return std::any_of(all.begin(), all.end(), [&list](const NamedEntry& child) {
    return child.entry.isType<Untyped>() ||
           (child.entry.isList() && has_untyped(list.sublist(child.name)));
  });
}

void assign_types(ParameterList& list, const ParameterList& valid, const Source& source,
                  FormulaPolicy formulas, const std::string& path) {
  TypeAssigner(source, formulas).assign(list, {&valid}, path);
}

void assign_type(ParameterList& list, const std::string& name, ValueType type, const Source& source,
                 const std::string& path) {
  const ParameterEntry* entry = list.getEntryPtr(name);
  if (!entry || !entry->isType<Untyped>())
    return;
  const Untyped value = Teuchos::getValue<Untyped>(*entry);
  TypeAssigner(source, FormulaPolicy::refused).put(list, name, path, [&] {
    return typed(value, type, false, FormulaPolicy::refused);
  });
}

ParameterEntry inferred(const ParameterEntry& entry) {
  if (!entry.isType<Untyped>())
    return entry;
  try {
    return inferred(Teuchos::getValue<Untyped>(entry), FormulaPolicy::refused);
  } catch (const InputError&) {
    return entry;
  }
}

}  // namespace lockstep
