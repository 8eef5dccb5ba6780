#pragma once
#include <Teuchos_ParameterEntryValidator.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

/// Properties of an entry of a valid list beyond default and docstring: carried as the Teuchos
/// validator of each entry, so that lists can be copied and merged freely.
namespace lockstep {

using ParameterEntry = Teuchos::ParameterEntry;

/// The entries of a list in their order, which Teuchos' own pairs do not let a range-for take
/// apart.
struct NamedEntry {
  const std::string& name;
  const ParameterEntry& entry;
};
std::vector<NamedEntry> entries(const ParameterList& list);

/// Teuchos' interface, reduced to what our rules need.
class Rule : public Teuchos::ParameterEntryValidator {
 public:
  const std::string getXMLTypeName() const override { return "lockstep"; }
  ValidStringsList validStringValues() const override { return Teuchos::null; }
  void printDoc(const std::string& documentation, std::ostream& out) const override;
  /// Throws InputError if `violation` finds one.
  void validate(const ParameterEntry& entry, const std::string& name,
                const std::string& list_name) const override;
  /// Returns the allowed values for the reference: "> 0", "one of a, b"; empty if anything is
  /// allowed.
  virtual std::string allowed() const = 0;
  /// Returns the fault of the value as the predicate of a sentence ("is -1, but must be ...");
  /// empty if it has none.
  virtual std::string violation(const ParameterEntry& entry) const = 0;
};

enum class Presence { has_default, required, optional };

/// Rule of a parameter.
class ValueRule : public Rule {
 public:
  Presence presence = Presence::has_default;
  std::optional<double> lower, upper;
  bool lower_excluded = false, upper_excluded = false;
  std::vector<std::string> choices;
  int n_components = 0;  // 0: any
  /// Variables of the formulas, as strings, that may stand in place of a number; none: none may.
  std::vector<std::string> variables;

  std::string allowed() const override;
  std::string violation(const ParameterEntry& entry) const override;

 private:
  std::string bounds() const;
};

enum class ListForm { plain, optional, free, typed, named, named_typed };

/// Rule of a sublist.
class ListRule : public Rule {
 public:
  ListForm form = ListForm::plain;
  std::string default_type;          // typed and named_typed; empty: "Type" is required
  std::vector<TypedSchema> schemas;  // one of empty type for `named`; each declares its own "Type"

  std::string allowed() const override { return ""; }
  std::string violation(const ParameterEntry&) const override { return ""; }
  /// The schema for a list of this form (for an element of it, if named); null if its "Type" is
  /// missing or unknown.
  const TypedSchema* schema_for(const ParameterList& given) const;
  /// A list of nothing but "Type": names and validates it when `schema_for` finds no schema.
  ParameterList type_declaration() const;
};

/// The rules of an entry of a valid list; a default one if it has none.
const ValueRule& value_rule(const ParameterEntry& entry);
const ListRule& list_rule(const ParameterEntry& entry);
bool holds_named_lists(const ListRule& rule);

/// Replaces the value rule of entry `name`, which must exist, by a changed copy.
template <typename Change>
void change_rule(ParameterList& list, const std::string& name, Change change) {
  const auto entry = list.getEntryRCP(name);
  const auto rule = Teuchos::rcp(new ValueRule(value_rule(*entry)));
  change(*rule);
  entry->setValidator(rule);
}

}  // namespace lockstep
