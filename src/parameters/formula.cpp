#include "parameters/formula.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "base/errors.hpp"
#include "parameters/mistakes.hpp"

namespace lockstep {

bool operator==(const Formula& a, const Formula& b) {
  return a.type == b.type && a.text == b.text;
}

std::ostream& operator<<(std::ostream& out, const Formula& formula) {
  return out << formula.text;
}

std::vector<std::string> place_and_time(int dimension) {
  return dimension == 2 ? std::vector<std::string>{"x", "y", "t"}
                        : std::vector<std::string>{"x", "y", "z", "t"};
}

ParameterEntry as_strings(const Formula& formula) {
  std::string text = formula.text;
  std::replace(text.begin(), text.end(), '[', '(');
  std::replace(text.begin(), text.end(), ']', ')');
  const bool is_array = formula.type == ValueType::reals || formula.type == ValueType::integers;
  return parse_value(is_array ? ValueType::texts : ValueType::text, text);
}

bool is_formula(ValueType type, const std::string& text) {
  const bool numeric = type == ValueType::real || type == ValueType::integer ||
                       type == ValueType::reals || type == ValueType::integers;
  return numeric && text.find('[') != std::string::npos;
}

ValueType final_type(const ParameterEntry& entry) {
  return entry.isType<Formula>() ? Teuchos::getValue<Formula>(entry).type : value_type(entry);
}

bool uses_mistake(const std::string& formula, const Variables& variables) {
  return std::any_of(variables.begin(), variables.end(), [&](const auto& variable) {
    return std::isnan(variable.second) && formula.find(variable.first) != std::string::npos;
  });
}

ParameterEntry evaluated(const Formula& formula, const Variables& constants,
                         const std::string& where) {
  if (formula.is_reduced || uses_mistake(formula.text, constants))
    return ParameterEntry(formula);
  try {
    const std::string text = substitute(formula.text, constants, where, place_and_time(3));
    return is_formula(formula.type, text) ? ParameterEntry(Formula{formula.type, text, true})
                                          : parse_value(formula.type, text);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool is_whole = message.rfind(where, 0) == 0;
    throw InputError(is_whole ? message
                              : fmt::format("{} = \"{}\" {}.", where, formula.text, message));
  }
}

void evaluate_formulas(ParameterList& list, const Variables& variables, const Source& source,
                       const std::string& path) {
  for (const auto& [name, entry] : entries(list)) {
    if (entry.isList()) {
      evaluate_formulas(list.sublist(name), variables, source, join_path(path, name));
    } else if (entry.isType<Formula>()) {
      const Formula formula = Teuchos::getValue<Formula>(entry);
      const std::string where =
          fmt::format("{}: {}, \"{}\"", source.place(join_path(path, name)), in_list(path), name);
      try {
        list.setEntry(name, evaluated(formula, variables, where));
      } catch (const InputError& error) {
        list.setEntry(name, ParameterEntry(Mistake{{error.what()}}));
      }
    }
  }
}

}  // namespace lockstep
