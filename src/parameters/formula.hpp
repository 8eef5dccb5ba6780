#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "parameters/expression.hpp"
#include "parameters/source.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

/// A number, or an array of them, that a scene gives by formulas in brackets: "[2*R]" or
/// "{[R], 0.5}". A list that was read with FormulaPolicy::kept holds it in place of the value until
/// `evaluate_formulas` puts the value there. One of place and time stays until `validate` puts
/// strings there, where a parameter may be such a formula.
struct Formula {
  ValueType type;           ///< type of the value: real, integer, reals or integers
  std::string text;         ///< as written
  bool is_reduced = false;  ///< numbers are in place of constants: x, y, z and t are left
};
bool operator==(const Formula& a, const Formula& b);
std::ostream& operator<<(std::ostream& out, const Formula& formula);

/// Treatment of a number that is written as a formula in brackets: refused as a mistake, or kept
/// for `evaluate_formulas`.
enum class FormulaPolicy { refused, kept };

/// True if a value of this type written like this is a formula. Brackets in strings are text.
bool is_formula(ValueType type, const std::string& text);

/// True if a formula names a variable that is nan, as its own value is a `Mistake`.
bool uses_mistake(const std::string& formula, const Variables& variables);

/// The type that an entry has, or will have once its formula is evaluated.
ValueType final_type(const ParameterEntry& entry);

/// The variables of formulas of place and time: x, y, z [m], in 2D x, y, and t [s].
std::vector<std::string> place_and_time(int dimension);

/// A reduced formula as strings, one for each component: "{[2*y], 0}" as {"(2*y)", "0"}. Throws
/// InputError whose message is the predicate of a sentence.
ParameterEntry as_strings(const Formula& formula);

/// The value of a formula, or, where it is one of place and time or uses a mistake, the formula
/// with numbers in place of its constants. `where` begins the message. Throws InputError for bad
/// syntax, unknown names, and a result that is not finite or, where an int is asked for, not whole.
ParameterEntry evaluated(const Formula& formula, const Variables& constants,
                         const std::string& where);

/// Puts values in the place of all formulas in `list`, which stands at `path`, and in its sublists.
/// One with bad syntax, unknown names, or a result that is not finite or, where an int is asked
/// for, not whole becomes a `Mistake` with its place, which `validate` tells of. Formulas
/// that use a mistake are left, and of those of place and time all but their constants.
void evaluate_formulas(ParameterList& list, const Variables& variables, const Source& source,
                       const std::string& path = "");

}  // namespace lockstep
