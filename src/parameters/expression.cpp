#include "parameters/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/errors.hpp"
#include "parameters/former_names.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

namespace {

const char* const name_characters =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.";

/// Sentences about a name that no variable has, each with a blank before it.
std::string help_with(const std::string& unknown, const Variables& variables) {
  if (const std::string fate = fate_of("history.csv", unknown); !fate.empty())
    return fmt::format(" \"{}\" {}.", unknown, fate);
  std::vector<std::string> names;
  for (const auto& [name, value] : variables)
    names.push_back(name);
  const std::string nearest = nearest_name(unknown, names);
  return (nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest)) +
         (names.empty() ? " No names are known here: there are no constants."
                        : fmt::format(" Known names: {}.", fmt::join(names, ", ")));
}

/// table(t, t1, f1, t2, f2, ...): the polygon through the points, constant before and after.
double table(const double* numbers, int n_numbers) {
  if (n_numbers < 5 || n_numbers % 2 == 0)
    throw mu::Parser::exception_type(
        "table(t, t1, f1, t2, f2, ...) wants a value for each of two or more times.");
  const double at = numbers[0], *points = numbers + 1;
  const int n_points = (n_numbers - 1) / 2;
  for (int i = 1; i < n_points; ++i)
    if (!(points[2 * i] > points[2 * i - 2]))
      throw mu::Parser::exception_type("the times of a table must ascend.");
  if (at <= points[0])
    return points[1];
  for (int i = 1; i < n_points; ++i) {
    const double *before = points + 2 * i - 2, *after = points + 2 * i;
    if (at < after[0])
      return before[1] + (after[1] - before[1]) * (at - before[0]) / (after[0] - before[0]);
  }
  return points[2 * n_points - 1];
}

/// Calls f(begin, end) for each name in a formula; the e of 1e-3 is none.
template <typename Function>
void for_each_name(const std::string& formula, const Function& f) {
  const auto is_digit = [&](std::size_t i) {
    return i < formula.size() && std::isdigit(static_cast<unsigned char>(formula[i])) != 0;
  };
  for (std::size_t begin = 0; begin < formula.size();) {
    if (is_digit(begin) || (formula[begin] == '.' && is_digit(begin + 1))) {
      char* end = nullptr;  // std::stod throws where no double can hold the number
      std::strtod(formula.c_str() + begin, &end);
      begin = end - formula.c_str();
    } else if (std::strchr(name_characters, formula[begin]) != nullptr) {
      const std::size_t end = formula.find_first_not_of(name_characters, begin);
      f(begin, std::min(end, formula.size()));
      begin = std::min(end, formula.size());
    } else {
      ++begin;
    }
  }
}

/// The formula with the numbers of its variables in their place.
std::string with_numbers(const std::string& formula, const Variables& variables) {
  std::string result;
  std::size_t last = 0;
  for_each_name(formula, [&](std::size_t begin, std::size_t end) {
    const auto variable = variables.find(formula.substr(begin, end - begin));
    if (variable == variables.end())
      return;
    const std::string number = number_text(variable->second);
    result += formula.substr(last, begin - last);
    result += number.front() == '-' ? "(" + number + ")" : number;
    last = end;
  });
  return result + formula.substr(last);
}

[[noreturn]] void explain(const mu::Parser::exception_type& error, const std::string& formula,
                          const std::string& where, const Variables& variables) {
  const bool is_unknown = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
  const std::string help = is_unknown ? help_with(error.GetToken(), variables) : "";
  throw InputError(
      fmt::format("{}: cannot evaluate \"{}\": {}{}", where, formula, error.GetMsg(), help));
}

}  // namespace

struct Expression::Parser {
  mu::Parser parser;
};

Expression::Expression(const std::string& formula, Variables& variables, const std::string& where)
    : parser_(std::make_unique<Parser>()), formula_(formula), where_(where) {
  check_input(!trimmed(formula).empty(), "{}: the expression is empty.", where);
  try {
    parser_->parser.DefineNameChars(name_characters);
    parser_->parser.DefineFun("table", table);
    for (auto& [name, value] : variables)
      parser_->parser.DefineVar(name, &value);
    parser_->parser.SetExpr(formula);
    int n_results = 0;
    parser_->parser.Eval(n_results);  // parses, so that mistakes show here
    check_input(n_results == 1,
                "{}: \"{}\" is {} numbers with commas between them, but must be one; decimals come "
                "after a point.",
                where, formula, n_results);
  } catch (const mu::Parser::exception_type& error) {
    explain(error, formula, where, variables);
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::value() const {
  const double result = parser_->parser.Eval();
  check_input(std::isfinite(result), "{}: \"{}\" is {}, which is not a finite number.", where_,
              formula_, result);
  return result;
}

double evaluate(const std::string& formula, Variables variables, const std::string& where) {
  return Expression(formula, variables, where).value();
}

std::string substitute(const std::string& text, const Variables& variables,
                       const std::string& where, const std::vector<std::string>& free) {
  const auto is_free = [&](const std::string& name) {
    return variables.count(name) == 0 && std::find(free.begin(), free.end(), name) != free.end();
  };
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t open = text.find('[', begin);
    result += text.substr(begin, open - begin);
    if (open == std::string::npos)
      break;
    const std::size_t close = text.find(']', open);
    check_input(close != std::string::npos, "{}: \"{}\" has a '[' without ']'.", where, text);
    const std::string formula = text.substr(open + 1, close - open - 1);
    const std::vector<std::string> names = free.empty() ? free : names_in(formula);
    result += std::any_of(names.begin(), names.end(), is_free)
                  ? "[" + with_numbers(formula, variables) + "]"
                  : number_text(evaluate(formula, variables, where));
    begin = close + 1;
  }
  return result;
}

std::vector<std::string> names_in(const std::string& formula) {
  std::vector<std::string> names;
  for_each_name(formula, [&](std::size_t begin, std::size_t end) {
    names.push_back(formula.substr(begin, end - begin));
  });
  return names;
}

std::string variable_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0)
      c = '_';
  }
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0)
    result.insert(0, "_");
  return result;
}

}  // namespace lockstep
