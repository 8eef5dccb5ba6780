#include "parameters/strict_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/errors.hpp"
#include "base/shortened.hpp"

namespace lockstep {

namespace {

struct TypeName {
  ValueType type;
  const char* name;
};
constexpr std::array<TypeName, 7> type_names = {{{ValueType::real, "double"},
                                                 {ValueType::integer, "int"},
                                                 {ValueType::boolean, "bool"},
                                                 {ValueType::text, "string"},
                                                 {ValueType::reals, "Array(double)"},
                                                 {ValueType::integers, "Array(int)"},
                                                 {ValueType::texts, "Array(string)"}}};

/// Reads a number of type T from all of `text`; the error of from_chars, or of what follows.
template <typename T>
std::errc read_number(std::string text, T& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+')
    text.erase(0, 1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc())
    return error;
  return stop == end ? std::errc() : std::errc::invalid_argument;
}

double parse_real(const std::string& text) {
  check_input(!text.empty(), "is empty, but must be a number");
  double value = 0;
  const std::errc error = read_number(text, value);
  check_input(error != std::errc::result_out_of_range, "is \"{}\", which no double can hold",
              shortened(text));
  const bool comma = text.find(',') != std::string::npos;
  check_input(error == std::errc(), "is \"{}\", which is not a number{}", shortened(text),
              comma ? " (the decimal mark is a point)" : "");
  check_input(std::isfinite(value), "is \"{}\", but must be finite", shortened(text));
  return value;
}

int parse_integer(const std::string& text) {
  check_input(!text.empty(), "is empty, but must be an integer");
  int value = 0;
  const std::errc error = read_number(text, value);
  check_input(error != std::errc::result_out_of_range, "is \"{}\", which no int can hold",
              shortened(text));
  if (error == std::errc())
    return value;
  double real = 0;
  const bool whole = read_number(text, real) == std::errc() && std::isfinite(real) &&
                     std::abs(real) < 2e9 && real == std::floor(real);
  throw InputError(fmt::format("is \"{}\", which is not an integer{}", shortened(text),
                               whole ? fmt::format(" (write {})", std::lround(real)) : ""));
}

bool parse_boolean(const std::string& text) {
  for (const char* word : {"true", "yes", "1"}) {
    if (text == word)
      return true;
  }
  for (const char* word : {"false", "no", "0"}) {
    if (text == word)
      return false;
  }
  throw InputError(fmt::format("is \"{}\", but a bool is true or false", shortened(text)));
}

std::string parse_word(const std::string& text) {
  check_input(!text.empty(), "is empty");
  return text;
}

/// The next comma that is no argument's: "min(x, 1), 2".
std::size_t next_comma(const std::string& text, std::size_t start) {
  int depth = 0;
  for (std::size_t i = start; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (text[i] == ',' && depth <= 0)
      return i;
  }
  return std::string::npos;
}

template <typename T, typename Parse>
ParameterEntry parse_array(const std::string& text, Parse parse) {
  check_input(text.size() >= 2 && text.front() == '{' && text.back() == '}',
              "is \"{}\", but an array is written in braces: {{1, 2, 3}}", shortened(text));
  const std::string inside = trimmed(text.substr(1, text.size() - 2));
  check_input(inside.find_first_of("{}") == std::string::npos, "is \"{}\": arrays do not nest",
              shortened(text));
  ParameterArray<T> array;
  for (std::size_t start = 0; !inside.empty() && start != std::string::npos;) {
    const std::size_t comma = next_comma(inside, start);
    try {
      array.push_back(parse(trimmed(inside.substr(start, comma - start))));
    } catch (const InputError& error) {
      throw InputError(fmt::format("is \"{}\", whose component {} {}", shortened(text),
                                   array.size() + 1, error.what()));
    }
    start = comma == std::string::npos ? comma : comma + 1;
  }
  return ParameterEntry(array);
}

template <typename T>
std::string array_text(const ParameterEntry& entry, std::string (*text)(const T&)) {
  std::vector<std::string> parts;
  for (const T& component : Teuchos::getValue<ParameterArray<T>>(entry)) {
    parts.push_back(text(component));
  }
  return fmt::format("{{{}}}", fmt::join(parts, ", "));
}

}  // namespace

ValueType value_type(const ParameterEntry& entry) {
  if (entry.isList())
    return ValueType::list;
  if (entry.isType<double>())
    return ValueType::real;
  if (entry.isType<int>())
    return ValueType::integer;
  if (entry.isType<bool>())
    return ValueType::boolean;
  if (entry.isType<std::string>())
    return ValueType::text;
  if (entry.isType<ParameterArray<double>>())
    return ValueType::reals;
  if (entry.isType<ParameterArray<int>>())
    return ValueType::integers;
  if (entry.isType<ParameterArray<std::string>>())
    return ValueType::texts;
  return ValueType::other;
}

std::string type_name(ValueType type) {
  for (const TypeName& known : type_names) {
    if (known.type == type)
      return known.name;
  }
  return type == ValueType::list ? "list" : "other";
}

std::optional<ValueType> value_type(const std::string& name) {
  for (const TypeName& known : type_names) {
    if (known.name == name)
      return known.type;
  }
  return std::nullopt;
}

std::string known_type_names() {
  std::vector<std::string> names;
  for (const TypeName& known : type_names)
    names.emplace_back(known.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

ParameterEntry parse_value(ValueType type, const std::string& text) {
  switch (type) {
    case ValueType::real:
      return ParameterEntry(parse_real(trimmed(text)));
    case ValueType::integer:
      return ParameterEntry(parse_integer(trimmed(text)));
    case ValueType::boolean:
      return ParameterEntry(parse_boolean(trimmed(text)));
    case ValueType::text:
      return ParameterEntry(text);
    case ValueType::reals:
      return parse_array<double>(trimmed(text), parse_real);
    case ValueType::integers:
      return parse_array<int>(trimmed(text), parse_integer);
    case ValueType::texts:
      return parse_array<std::string>(trimmed(text), parse_word);
    default:
      throw InputError("has a type that cannot be written as text");
  }
}

ParameterEntry infer_value(const std::string& text) {
  if (text == "true" || text == "false")
    return ParameterEntry(text == "true");
  for (const ValueType type : {ValueType::integer, ValueType::real}) {
    try {
      return parse_value(type, text);
    } catch (const InputError&) {
      continue;
    }
  }
  return ParameterEntry(text);
}

std::string number_text(double value) {
  std::array<char, 40> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  LOCKSTEP_ASSERT(error == std::errc());
  static_cast<void>(error);
  std::string text(buffer.data(), end);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
    return text;
  const std::string sign = text[exponent + 1] == '-' ? "-" : "";
  const std::size_t digits = text.find_first_not_of("+-0", exponent + 1);
  return text.substr(0, exponent) + "e" + sign + text.substr(digits);
}

std::string value_text(const ParameterEntry& entry) {
  switch (value_type(entry)) {
    case ValueType::real:
      return number_text(Teuchos::getValue<double>(entry));
    case ValueType::integer:
      return std::to_string(Teuchos::getValue<int>(entry));
    case ValueType::boolean:
      return Teuchos::getValue<bool>(entry) ? "true" : "false";
    case ValueType::text:
      return Teuchos::getValue<std::string>(entry);
    case ValueType::reals:
      return array_text<double>(entry, [](const double& value) { return number_text(value); });
    case ValueType::integers:
      return array_text<int>(entry, [](const int& value) { return std::to_string(value); });
    case ValueType::texts:
      return array_text<std::string>(entry, [](const std::string& value) { return value; });
    default:
      return "(" + entry.getAny(false).typeName() + ")";
  }
}

std::string quoted_value(const ParameterEntry& entry) {
  const std::string text = value_text(entry);
  return entry.isType<std::string>() ? fmt::format("\"{}\"", text) : text;
}

std::string quoted_list(const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos)
    return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace lockstep
