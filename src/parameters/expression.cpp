#include "parameters/expression.hpp"

#include <muParser.h>

#include <cctype>
#include <cmath>
#include <vector>

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
         fmt::format(" Known names: {}.", fmt::join(names, ", "));
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
                       const std::string& where) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t open = text.find('[', begin);
    result += text.substr(begin, open - begin);
    if (open == std::string::npos)
      break;
    const std::size_t close = text.find(']', open);
    check_input(close != std::string::npos, "{}: \"{}\" has a '[' without ']'.", where, text);
    result += number_text(evaluate(text.substr(open + 1, close - open - 1), variables, where));
    begin = close + 1;
  }
  return result;
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
