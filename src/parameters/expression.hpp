#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace lockstep {

/// Names and their values in an expression. A name consists of letters, digits, _ and '.', and does
/// not begin with a digit: "h", "Ball.vx".
using Variables = std::map<std::string, double>;

/// A formula in the syntax of muParser: + - * / ^, comparisons, a ? b : c, sqrt, exp, ln, sin, cos,
/// abs, min(a, b, ...), _pi and so on, and table(t, t1, f1, t2, f2, ...), which is f1 at t = t1 and
/// so on, linear in between and constant beyond. Holds the addresses of the variables it was made
/// with, so that it can be evaluated again cheaply after their values changed.
class Expression {
 public:
  /// `where` says in messages what the formula is for. Throws InputError for bad syntax and unknown
  /// names. `variables` must outlive the expression, and no element may be removed.
  Expression(const std::string& formula, Variables& variables, const std::string& where);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) = delete;

  /// Throws InputError if the result is not a finite number.
  double value() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
  std::string formula_, where_;
};

/// Evaluates once.
double evaluate(const std::string& formula, Variables variables, const std::string& where);

/// Replaces every [formula] in `text` by its value: "Domain/Cells={[n], [2*n]}" -> "{32, 64}". One
/// that names something `free` keeps its brackets; of it the variables alone become numbers.
std::string substitute(const std::string& text, const Variables& variables,
                       const std::string& where, const std::vector<std::string>& free = {});

/// Names of variables, constants and functions in a formula, in their order.
std::vector<std::string> names_in(const std::string& formula);

/// `name` with every character that a variable's name may not hold replaced by '_'.
std::string variable_name(const std::string& name);

}  // namespace lockstep
