#include "parameters/parameter_list.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"

namespace lockstep {

namespace {

bool is_declarable(const ParameterList& list, const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos && !list.isParameter(name);
}

template <typename T>
void add(ParameterList& list, const std::string& name, const T& value, const std::string& doc,
         Presence presence = Presence::has_default) {
  check_input(
      is_declarable(list, name),
      "A parameter cannot be declared as \"{}\": the name is empty, holds a '/' or is taken.",
      name);
  const auto rule = Teuchos::rcp(new ValueRule);
  rule->presence = presence;
  list.setEntry(name, ParameterEntry(value, true, false, doc, rule));
}

void check_finite(const std::string& name, double value) {
  check_input(std::isfinite(value), "The default of parameter \"{}\" must be finite.", name);
}

ListRule& add_list(ParameterList& list, const std::string& name, const std::string& doc,
                   ListForm form) {
  check_input(is_declarable(list, name),
              "A list cannot be declared as \"{}\": the name is empty, holds a '/' or is taken.",
              name);
  list.sublist(name, false, doc);
  const auto rule = Teuchos::rcp(new ListRule);
  rule->form = form;
  list.getEntryRCP(name)->setValidator(rule);
  return *rule;
}

void set_types(ListRule& rule, const std::vector<TypedSchema>& types,
               const std::string& default_type) {
  rule.default_type = default_type;
  rule.schemas = types;
  const ParameterList type_only = rule.type_declaration();
  for (TypedSchema& schema : rule.schemas) {
    ParameterList parameters = type_only;
    for (const auto& [name, entry] : entries(schema.parameters)) {
      check_input(name != "Type", "The type \"{}\" must not declare a parameter \"Type\" itself.",
                  schema.type);
      parameters.setEntry(name, entry);
    }
    schema.parameters = parameters;
  }
}

}  // namespace

void declare(ParameterList& list, const std::string& name, double value, const std::string& doc) {
  check_finite(name, value);
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, int value, const std::string& doc) {
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, bool value, const std::string& doc) {
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, const char* value,
             const std::string& doc) {
  add(list, name, std::string(value), doc);
}
void declare(ParameterList& list, const std::string& name, const std::string& value,
             const std::string& doc) {
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, const ParameterArray<double>& value,
             const std::string& doc) {
  for (const double component : value)
    check_finite(name, component);
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, const ParameterArray<int>& value,
             const std::string& doc) {
  add(list, name, value, doc);
}
void declare(ParameterList& list, const std::string& name, const ParameterArray<std::string>& value,
             const std::string& doc) {
  add(list, name, value, doc);
}

void declare(ParameterList& list, const std::string& name, std::initializer_list<double> value,
             const std::string& doc) {
  declare(list, name, make_array(value), doc);
}
void declare(ParameterList& list, const std::string& name, std::initializer_list<int> value,
             const std::string& doc) {
  declare(list, name, make_array(value), doc);
}
void declare(ParameterList& list, const std::string& name, std::initializer_list<std::string> value,
             const std::string& doc) {
  declare(list, name, make_array(value), doc);
}

template <typename T>
void declare_required(ParameterList& list, const std::string& name, const std::string& doc) {
  add(list, name, T{}, doc, Presence::required);
}
template <typename T>
void declare_optional(ParameterList& list, const std::string& name, const std::string& doc) {
  add(list, name, T{}, doc, Presence::optional);
}

void set_positive(ParameterList& list, const std::string& name) {
  change_rule(list, name, [](ValueRule& rule) {
    rule.lower = 0;
    rule.lower_excluded = true;
  });
}
void set_at_least(ParameterList& list, const std::string& name, double lower) {
  change_rule(list, name, [&](ValueRule& rule) { rule.lower = lower; });
}
void set_between(ParameterList& list, const std::string& name, double lower, double upper) {
  change_rule(list, name, [&](ValueRule& rule) {
    rule.lower = lower;
    rule.upper = upper;
  });
}

void declare_positive(ParameterList& list, const std::string& name, double value,
                      const std::string& doc) {
  declare(list, name, value, doc);
  set_positive(list, name);
}
void declare_positive(ParameterList& list, const std::string& name, int value,
                      const std::string& doc) {
  declare(list, name, value, doc);
  set_positive(list, name);
}
void declare_at_least(ParameterList& list, const std::string& name, double value, double lower,
                      const std::string& doc) {
  declare(list, name, value, doc);
  set_at_least(list, name, lower);
}
void declare_at_least(ParameterList& list, const std::string& name, int value, int lower,
                      const std::string& doc) {
  declare(list, name, value, doc);
  set_at_least(list, name, lower);
}
void declare_between(ParameterList& list, const std::string& name, double value, double lower,
                     double upper, const std::string& doc) {
  declare(list, name, value, doc);
  set_between(list, name, lower, upper);
}
void declare_between(ParameterList& list, const std::string& name, int value, int lower, int upper,
                     const std::string& doc) {
  declare(list, name, value, doc);
  set_between(list, name, lower, upper);
}
void declare_tolerance(ParameterList& list, const std::string& name, double value,
                       const std::string& doc) {
  declare_positive(list, name, value, doc);
  change_rule(list, name, [](ValueRule& rule) {
    rule.upper = 1;
    rule.upper_excluded = true;
  });
}
void declare_required_positive(ParameterList& list, const std::string& name,
                               const std::string& doc) {
  declare_required<double>(list, name, doc);
  set_positive(list, name);
}

void set_choices(ParameterList& list, const std::string& name,
                 const std::vector<std::string>& choices) {
  change_rule(list, name, [&](ValueRule& rule) { rule.choices = choices; });
}
void declare_choice(ParameterList& list, const std::string& name, const std::string& value,
                    const std::vector<std::string>& choices, const std::string& doc) {
  declare(list, name, value, doc);
  set_choices(list, name, choices);
}
void declare_required_choice(ParameterList& list, const std::string& name,
                             const std::vector<std::string>& choices, const std::string& doc) {
  declare_required<std::string>(list, name, doc);
  set_choices(list, name, choices);
}

void set_length(ParameterList& list, const std::string& name, int n_components) {
  change_rule(list, name, [&](ValueRule& rule) { rule.n_components = n_components; });
}
void declare_vector(ParameterList& list, const std::string& name,
                    const ParameterArray<double>& value, int n_components, const std::string& doc) {
  declare(list, name, value, doc);
  set_length(list, name, n_components);
}
void declare_vector(ParameterList& list, const std::string& name, const ParameterArray<int>& value,
                    int n_components, const std::string& doc) {
  declare(list, name, value, doc);
  set_length(list, name, n_components);
}
void declare_vector(ParameterList& list, const std::string& name,
                    std::initializer_list<double> value, int n_components, const std::string& doc) {
  declare_vector(list, name, make_array(value), n_components, doc);
}
void declare_vector(ParameterList& list, const std::string& name, std::initializer_list<int> value,
                    int n_components, const std::string& doc) {
  declare_vector(list, name, make_array(value), n_components, doc);
}
template <typename T>
void declare_required_vector(ParameterList& list, const std::string& name, int n_components,
                             const std::string& doc) {
  declare_required<ParameterArray<T>>(list, name, doc);
  set_length(list, name, n_components);
}

void set_variables(ParameterList& list, const std::string& name,
                   const std::vector<std::string>& variables) {
  change_rule(list, name, [&](ValueRule& rule) { rule.variables = variables; });
}

ParameterList& declare_list(ParameterList& list, const std::string& name, const std::string& doc) {
  add_list(list, name, doc, ListForm::plain);
  return list.sublist(name);
}
ParameterList& declare_optional_list(ParameterList& list, const std::string& name,
                                     const std::string& doc) {
  add_list(list, name, doc, ListForm::optional);
  return list.sublist(name);
}
void declare_free_sublist(ParameterList& list, const std::string& name, const std::string& doc) {
  add_list(list, name, doc, ListForm::free);
}
void declare_typed_sublist(ParameterList& list, const std::string& name, const std::string& doc,
                           const std::vector<TypedSchema>& types, const std::string& default_type) {
  set_types(add_list(list, name, doc, ListForm::typed), types, default_type);
}
void declare_named_sublists(ParameterList& list, const std::string& name, const std::string& doc,
                            const ParameterList& element) {
  add_list(list, name, doc, ListForm::named).schemas = {{"", "", element}};
}
void declare_named_sublists(ParameterList& list, const std::string& name, const std::string& doc,
                            const std::vector<TypedSchema>& types,
                            const std::string& default_type) {
  set_types(add_list(list, name, doc, ListForm::named_typed), types, default_type);
}

template void declare_required<double>(ParameterList&, const std::string&, const std::string&);
template void declare_required<int>(ParameterList&, const std::string&, const std::string&);
template void declare_required<bool>(ParameterList&, const std::string&, const std::string&);
template void declare_required<std::string>(ParameterList&, const std::string&, const std::string&);
template void declare_required<ParameterArray<double>>(ParameterList&, const std::string&,
                                                       const std::string&);
template void declare_required<ParameterArray<int>>(ParameterList&, const std::string&,
                                                    const std::string&);
template void declare_required<ParameterArray<std::string>>(ParameterList&, const std::string&,
                                                            const std::string&);
template void declare_optional<double>(ParameterList&, const std::string&, const std::string&);
template void declare_optional<int>(ParameterList&, const std::string&, const std::string&);
template void declare_optional<bool>(ParameterList&, const std::string&, const std::string&);
template void declare_optional<std::string>(ParameterList&, const std::string&, const std::string&);
template void declare_optional<ParameterArray<double>>(ParameterList&, const std::string&,
                                                       const std::string&);
template void declare_optional<ParameterArray<int>>(ParameterList&, const std::string&,
                                                    const std::string&);
template void declare_optional<ParameterArray<std::string>>(ParameterList&, const std::string&,
                                                            const std::string&);
template void declare_required_vector<double>(ParameterList&, const std::string&, int,
                                              const std::string&);
template void declare_required_vector<int>(ParameterList&, const std::string&, int,
                                           const std::string&);
template void declare_required_vector<std::string>(ParameterList&, const std::string&, int,
                                                   const std::string&);

}  // namespace lockstep
