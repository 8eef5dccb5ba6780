#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "parameters/formula.hpp"
#include "parameters/source.hpp"

/// Values of files that do not say their types, as YAML: each gets that of the parameter it is for.
namespace lockstep {

/// A value as written. A list that was read from YAML holds it in place of the value until
/// `assign_types` puts the value there.
struct Untyped {
  struct Scalar {
    std::string text;
    bool is_quoted;
  };
  std::vector<Scalar> scalars;  ///< one if it is no array
  bool is_array = false;
};
bool operator==(const Untyped& a, const Untyped& b);
std::ostream& operator<<(std::ostream& out, const Untyped& value);

/// True if a value in the list, or in one inside of it, is untyped still.
bool has_untyped(const ParameterList& list);

/// Puts the value that is meant in the place of each untyped one of `list`, which stands at `path`.
/// Its type is that of the parameter of this name in `valid`, where "Type" is not given in one of
/// the schemas that it chooses among. Names that `valid` does not have, and those of free lists,
/// get what their text looks like: bool, int, double, a formula of a double, else string. What
/// cannot be of its type becomes a `Mistake`, as the reader of XML makes it.
void assign_types(ParameterList& list, const ParameterList& valid, const Source& source,
                  FormulaPolicy formulas, const std::string& path = "");

/// Gives one parameter of the list its type, which is known without a schema, if it is there.
void assign_type(ParameterList& list, const std::string& name, ValueType type, const Source& source,
                 const std::string& path);

/// Returns what an untyped value looks like; any other, and one that looks like nothing, as it is.
ParameterEntry inferred(const ParameterEntry& entry);

}  // namespace lockstep
