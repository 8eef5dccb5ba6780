#include "parameters/command_line.hpp"

#include <vector>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/formula.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"
#include "parameters/validate.hpp"

namespace lockstep {

namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t start = 0; start != std::string::npos;) {
    const std::size_t slash = path.find('/', start);
    names.push_back(trimmed(path.substr(start, slash - start)));
    start = slash == std::string::npos ? slash : slash + 1;
  }
  return names;
}

/// Walks the given list and its schema down the path together.
class Setter {
 public:
  Setter(Document& document, const std::string& assignment, const ParameterList* valid)
      : document_(document),
        place_(fmt::format("{} \"{}\"", document.source.setting, shortened(assignment, 100))),
        list_(&document.list),
        valid_(valid),
        formulas_(valid ? FormulaPolicy::refused : FormulaPolicy::kept) {
    const std::size_t equals = assignment.find('=');
    check_input(equals != std::string::npos && equals > 0,
                "{}: write a path and a value, as in --set \"List/Sub list/Name=value\".", place_);
    names_ = split(assignment.substr(0, equals));
    value_ = assignment.substr(equals + 1);
  }

  void run() {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
      descend(names_[i]);
    set(names_.back());
  }

 private:
  /// `valid_` is null in a free list; `elements_` is set in a list of named lists.
  void descend(const std::string& name) {
    if (elements_) {
      descend_to_element(name);
    } else if (valid_) {
      const ParameterEntry& entry = known(name);
      check_input(entry.isList(), "{}: {}, \"{}\" is a parameter, not a list.", place_,
                  in_list(path_), name);
      enter(name);
      follow(entry);
    } else {
      check_input(!list_->isParameter(name) || list_->isSublist(name),
                  "{}: {}, \"{}\" is a parameter, not a list.", place_, in_list(path_), name);
      enter(name);
    }
  }

  void follow(const ParameterEntry& entry) {
    const ListRule& rule = list_rule(entry);
    if (rule.form == ListForm::free) {
      valid_ = nullptr;
    } else if (holds_named_lists(rule)) {
      elements_ = &rule;
    } else if (rule.form == ListForm::typed) {
      choose_schema(rule);
    } else {
      valid_ = &Teuchos::getValue<ParameterList>(entry);
    }
  }

  void descend_to_element(const std::string& name) {
    std::vector<std::string> names;
    for (const auto& [element, entry] : entries(*list_))
      names.push_back(element);
    const std::string nearest = nearest_name(name, names);
    check_input(list_->isSublist(name), "{}: {}, there is no list \"{}\".{}\nThere are: {}.",
                place_, in_list(path_), name,
                nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
                names.empty() ? "none" : quoted_list(names));
    enter(name);
    choose_schema(*elements_);
    elements_ = nullptr;
  }

  /// A "Type" that is being set now decides itself what is valid beside it.
  void choose_schema(const ListRule& rule) {
    if (names_.back() == "Type" && path_ == parent_path() && rule.form != ListForm::named) {
      type_only_ = rule.type_declaration();
      valid_ = &type_only_;
    } else {
      valid_ = &chosen_schema(rule, *list_, document_.source, path_);
    }
  }

  std::string parent_path() const {
    std::string path;
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
      path = join_path(path, names_[i]);
    return path;
  }

  void enter(const std::string& name) {
    list_ = &list_->sublist(name);
    path_ = join_path(path_, name);
  }

  const ParameterEntry& known(const std::string& name) const {
    const ParameterEntry* entry = valid_->getEntryPtr(name);
    if (!entry)
      throw InputError(unknown_name(place_, path_, name, *valid_));
    return *entry;
  }

  void set(const std::string& name) {
    check_input(!name.empty(), "{}: the name of the parameter is empty.", place_);
    const ParameterEntry* declared = list_->getEntryPtr(name);
    if (valid_)
      declared = elements_ ? nullptr : &known(name);
    check_input(!elements_ && !(declared && declared->isList()),
                "{}: {}, \"{}\" is a list; name one of its parameters, \"{}/...\".", place_,
                in_list(path_), name, join_path(path_, name));
    const std::string where = fmt::format("{}: {}, \"{}\"", place_, in_list(path_), name);
    try {
      list_->setEntry(name, declared ? parse_like(*declared) : inferred());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{} {}.", where, error.what()));
    }
    if (const ParameterEntry& entry = list_->getEntry(name);
        entry.isType<Formula>() && formulas_ == FormulaPolicy::refused)
      list_->setEntry(name,
                      evaluated(Teuchos::getValue<Formula>(entry), document_.constants, where));
    document_.source.places[join_path(path_, name)] = place_;
  }

  /// Reads numbers, or else formulas: of place and time in brackets or not, others in brackets.
  ParameterEntry parse_like(const ParameterEntry& declared) const {
    const ValueType type = final_type(declared);
    if (is_formula(type, value_))
      return ParameterEntry(Formula{type, in_braces(type)});
    try {
      return parse_value(type, in_braces(type));
    } catch (const InputError&) {
      if (!valid_ || value_rule(declared).variables.empty())
        throw;
    }
    return ParameterEntry(Formula{type, in_brackets(type)});
  }

  /// Reads a parameter whose type nobody declares.
  ParameterEntry inferred() const {
    if (formulas_ == FormulaPolicy::refused || !is_formula(ValueType::real, value_))
      return infer_value(value_);
    const bool is_array = trimmed(value_).substr(0, 1) == "{";
    return ParameterEntry(Formula{is_array ? ValueType::reals : ValueType::real, value_});
  }

  /// Puts each number in brackets: "y, 0" as "{[y], [0]}".
  std::string in_brackets(ValueType type) const {
    if (type != ValueType::reals && type != ValueType::integers)
      return "[" + value_ + "]";
    const ParameterEntry entry = parse_value(ValueType::texts, in_braces(type));
    std::vector<std::string> formulas;
    for (const std::string& formula : Teuchos::getValue<ParameterArray<std::string>>(entry))
      formulas.push_back("[" + formula + "]");
    return fmt::format("{{{}}}", fmt::join(formulas, ", "));
  }

  /// A shell makes several words of {1,2}, so the braces of an array may be left out.
  std::string in_braces(ValueType type) const {
    const bool array =
        type == ValueType::reals || type == ValueType::integers || type == ValueType::texts;
    const bool bare = array && trimmed(value_).substr(0, 1) != "{";
    return bare ? "{" + value_ + "}" : value_;
  }

  Document& document_;
  std::string place_, value_, path_;
  std::vector<std::string> names_;
  ParameterList* list_;
  const ParameterList* valid_;
  FormulaPolicy formulas_;  ///< kept where the constants are not known yet
  const ListRule* elements_ = nullptr;
  ParameterList type_only_;
};

}  // namespace

void set_from_command_line(Document& document, const std::string& assignment,
                           const ParameterList& valid) {
  Setter(document, assignment, &valid).run();
}

long long parse_count(const std::string& option, const std::string& text) {
  constexpr std::size_t most_digits = 15;
  const bool is_whole = text.find_first_not_of("0123456789") == std::string::npos;
  const bool is_count = is_whole && !text.empty() && text.size() <= most_digits;
  const long long count = is_count ? std::stoll(text) : 0;
  check_input(count > 0, "{}: \"{}\" is not a whole number from 1 to 10^{}; give how many.", option,
              text, most_digits);
  return count;
}

void set_unchecked(Document& document, const std::string& assignment) {
  Setter(document, assignment, nullptr).run();
}

}  // namespace lockstep
