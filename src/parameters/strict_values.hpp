#pragma once
#include <optional>
#include <string>
#include <vector>

#include "parameters/parameter_rule.hpp"

/// The values parameters may have, and their only way from and to text. Nothing is accepted in
/// part: Teuchos reads "abc" as 0 and "1e3" as the integer 1.
namespace lockstep {

enum class ValueType { real, integer, boolean, text, reals, integers, texts, list, other };

ValueType value_type(const ParameterEntry& entry);
/// Name in XML: "double", "Array(int)", ...
std::string type_name(ValueType type);
std::optional<ValueType> value_type(const std::string& type_name);
/// All type names that XML may use, for messages.
std::string known_type_names();

/// Reads all of `text` as `type`. Throws InputError whose message is the predicate of a sentence:
/// `is "abc", which is not a number`.
ParameterEntry parse_value(ValueType type, const std::string& text);
/// For a parameter whose type nobody declares: bool, int, double or string, the first that fits.
ParameterEntry infer_value(const std::string& text);

/// Shortest text that reads back to the same double: "1e-8".
std::string number_text(double value);
/// As in XML: "1e-8", "{1, 2}", without quotes around strings.
std::string value_text(const ParameterEntry& entry);
/// As in messages: like `value_text`, strings in quotes.
std::string quoted_value(const ParameterEntry& entry);
/// `"a", "b", "c"`.
std::string quoted_list(const std::vector<std::string>& names);
std::string trimmed(const std::string& text);

}  // namespace lockstep
