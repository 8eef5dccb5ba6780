#pragma once
#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterList.hpp>
#include <initializer_list>
#include <string>
#include <vector>

/// Declaring parameters. A *valid list* (schema) is a ParameterList of all parameters a class
/// knows, each with default, docstring (give the unit) and rule; `validate` holds a given list
/// against it. Names must not contain '/' and defaults must be finite. A name is declared once.
namespace lockstep {

using ParameterList = Teuchos::ParameterList;
/// Converts from std::vector. It has no constructor from a braced list: {0.0, 1.0} would be size
/// and value; use `make_array`.
template <typename T>
using ParameterArray = Teuchos::Array<T>;
template <typename T>
ParameterArray<T> make_array(std::initializer_list<T> values) {
  return ParameterArray<T>(std::vector<T>(values));
}

/// One alternative of a list whose contents depend on its parameter "Type".
struct TypedSchema {
  std::string type;
  std::string documentation;
  ParameterList parameters;  // without "Type", which is added
  bool is_plug_in = false;   ///< libraries may bring more of its kind
};

/// A parameter with a default.
void declare(ParameterList& list, const std::string& name, double value, const std::string& doc);
void declare(ParameterList& list, const std::string& name, int value, const std::string& doc);
void declare(ParameterList& list, const std::string& name, bool value, const std::string& doc);
void declare(ParameterList& list, const std::string& name, const char* value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, const std::string& value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, const ParameterArray<double>& value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, const ParameterArray<int>& value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, const ParameterArray<std::string>& value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, std::initializer_list<double> value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, std::initializer_list<int> value,
             const std::string& doc);
void declare(ParameterList& list, const std::string& name, std::initializer_list<std::string> value,
             const std::string& doc);

/// T is double, int, bool, std::string or a ParameterArray of double, int, std::string.
/// Required: leaving it out is an error. Optional: stays absent unless given (ask `isParameter`).
template <typename T>
void declare_required(ParameterList& list, const std::string& name, const std::string& doc);
template <typename T>
void declare_optional(ParameterList& list, const std::string& name, const std::string& doc);

/// Numbers with bounds, which hold for every component of an array. `set_*` adds the bound to a
/// parameter that is declared already (a required one, an array).
void set_positive(ParameterList& list, const std::string& name);
void set_at_least(ParameterList& list, const std::string& name, double lower);
void set_between(ParameterList& list, const std::string& name, double lower, double upper);
void declare_positive(ParameterList& list, const std::string& name, double value,
                      const std::string& doc);
void declare_positive(ParameterList& list, const std::string& name, int value,
                      const std::string& doc);
void declare_at_least(ParameterList& list, const std::string& name, double value, double lower,
                      const std::string& doc);
void declare_at_least(ParameterList& list, const std::string& name, int value, int lower,
                      const std::string& doc);
void declare_between(ParameterList& list, const std::string& name, double value, double lower,
                     double upper, const std::string& doc);
void declare_between(ParameterList& list, const std::string& name, int value, int lower, int upper,
                     const std::string& doc);
/// Greater than 0 and less than 1: of tolerances, which a solve that does nothing must not keep.
void declare_tolerance(ParameterList& list, const std::string& name, double value,
                       const std::string& doc);
void declare_required_positive(ParameterList& list, const std::string& name,
                               const std::string& doc);

/// A string (or array of strings) out of `choices`.
void set_choices(ParameterList& list, const std::string& name,
                 const std::vector<std::string>& choices);
void declare_choice(ParameterList& list, const std::string& name, const std::string& value,
                    const std::vector<std::string>& choices, const std::string& doc);
void declare_required_choice(ParameterList& list, const std::string& name,
                             const std::vector<std::string>& choices, const std::string& doc);

/// An array of exactly `n_components` components.
void set_length(ParameterList& list, const std::string& name, int n_components);
void declare_vector(ParameterList& list, const std::string& name,
                    const ParameterArray<double>& value, int n_components, const std::string& doc);
void declare_vector(ParameterList& list, const std::string& name, const ParameterArray<int>& value,
                    int n_components, const std::string& doc);
void declare_vector(ParameterList& list, const std::string& name,
                    std::initializer_list<double> value, int n_components, const std::string& doc);
void declare_vector(ParameterList& list, const std::string& name, std::initializer_list<int> value,
                    int n_components, const std::string& doc);
/// T is double, int or std::string: the type of a component.
template <typename T>
void declare_required_vector(ParameterList& list, const std::string& name, int n_components,
                             const std::string& doc);

/// Lets formulas of these variables stand in place of the number, or of each number of the array,
/// that a declared parameter is: "[2*y]" in a scene, or a string (see `Expression`). FieldFormula
/// reads such a parameter.
void set_variables(ParameterList& list, const std::string& name,
                   const std::vector<std::string>& variables);

/// An ordinary sublist; declare its parameters in the list returned. An absent optional one stays
/// absent, so that its required parameters are required only where the list is given.
ParameterList& declare_list(ParameterList& list, const std::string& name, const std::string& doc);
ParameterList& declare_optional_list(ParameterList& list, const std::string& name,
                                     const std::string& doc);
/// A sublist whose content is handed on unchecked (Stratimikos and its friends check their own).
void declare_free_sublist(ParameterList& list, const std::string& name, const std::string& doc);
/// A sublist whose parameter "Type" chooses among `types`. With an empty `default_type`, "Type" is
/// required.
void declare_typed_sublist(ParameterList& list, const std::string& name, const std::string& doc,
                           const std::vector<TypedSchema>& types,
                           const std::string& default_type = "");
/// A sublist that holds any number of freely named sublists, all of the same form, or each of the
/// form that its own parameter "Type" chooses.
void declare_named_sublists(ParameterList& list, const std::string& name, const std::string& doc,
                            const ParameterList& element);
void declare_named_sublists(ParameterList& list, const std::string& name, const std::string& doc,
                            const std::vector<TypedSchema>& types,
                            const std::string& default_type = "");

}  // namespace lockstep
