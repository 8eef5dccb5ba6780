#include "parameters/schema/relax_ng.hpp"

#include <algorithm>
#include <vector>

#include "base/errors.hpp"
#include "base/xml_text.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/schema/definitions.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

const char* const header = R"xml(<?xml version="1.0" encoding="UTF-8"?>
<!-- Scenes of Lockstep, made by simulate with its option schema. What RELAX NG cannot say is allowed:
     a name that is given twice, numbers of arrays out of bounds, formulas of names that there are not
     (all that has brackets passes as a formula), what a library checks itself. No parameter is
     required: an included file may have it. A list without a "Type" may hold the parameters of all
     types, as "Defaults" or an included file may say the type. -->
<grammar xmlns="http://relaxng.org/ns/structure/1.0"
         xmlns:a="http://relaxng.org/ns/compatibility/annotations/1.0"
         datatypeLibrary="http://www.w3.org/2001/XMLSchema-datatypes">
<define name="notes">
<optional><attribute name="docString"/></optional><optional><attribute name="id"/></optional>
<optional><attribute name="isDefault"/></optional><optional><attribute name="isUsed"/></optional>
</define>
<define name="anything">
<zeroOrMore><choice>
<element name="Parameter"><attribute name="name"/><attribute name="type"/><attribute name="value"/><ref name="notes"/></element>
<element name="ParameterList"><attribute name="name"/><ref name="notes"/><ref name="anything"/></element>
</choice></zeroOrMore>
</define>
)xml";

const char* const real_pattern = "[+\\-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+\\-]?[0-9]+)?";
const char* const integer_pattern = "[+\\-]?[0-9]+";
const char* const formula_pattern = "[^\\[]*\\[[\\s\\S]*";

std::string pattern(const std::string& type, const std::string& text,
                    const std::string& bounds = "") {
  return fmt::format("<data type=\"{}\"><param name=\"pattern\">{}</param>{}</data>", type,
                     xml_escaped(text), bounds);
}

std::string constant(const std::string& text) {
  return fmt::format("<value type=\"string\">{}</value>", xml_escaped(text));
}

std::string choice(const std::vector<std::string>& alternatives) {
  if (alternatives.empty())
    return "<empty/>";
  return alternatives.size() == 1 ? alternatives.front()
                                  : fmt::format("<choice>{}</choice>", fmt::join(alternatives, ""));
}

/// Bounds of numbers of this type; XML knows no exponents of integers.
std::string bounds(ValueType type, const ValueRule& rule) {
  const auto bound = [type](const std::string& name, double number) {
    const std::string text =
        type == ValueType::integer ? fmt::format("{:.0f}", number) : number_text(number);
    return fmt::format("<param name=\"{}\">{}</param>", name, text);
  };
  std::string text;
  if (rule.lower)
    text += bound(rule.lower_excluded ? "minExclusive" : "minInclusive", *rule.lower);
  if (rule.upper)
    text += bound(rule.upper_excluded ? "maxExclusive" : "maxInclusive", *rule.upper);
  return text;
}

/// "{1, 2}" of so many components, or of any number.
std::string array_pattern(const std::string& component, int n_components) {
  const std::string next = "\\s*,\\s*" + component;
  std::string inside = component;
  for (int i = 1; i < n_components; ++i)
    inside += next;
  if (n_components == 0)
    inside = "(" + component + "(" + next + ")*)?";
  return "\\s*\\{\\s*" + inside + "\\s*\\}\\s*";
}

/// Values of this type, but formulas.
std::string plain_value(ValueType type, const ValueRule& rule) {
  switch (type) {
    case ValueType::real:
      return pattern("double", real_pattern, bounds(type, rule));
    case ValueType::integer:
      return pattern("int", integer_pattern, bounds(type, rule));
    case ValueType::boolean:
      return choice({constant("true"), constant("false"), constant("yes"), constant("no"),
                     constant("1"), constant("0")});
    case ValueType::reals:
      return pattern("string", array_pattern(real_pattern, rule.n_components));
    case ValueType::integers:
      return pattern("string", array_pattern(integer_pattern, rule.n_components));
    case ValueType::texts:
      return pattern("string", "\\s*\\{[^{}]*\\}\\s*");
    default:
      break;
  }
  std::vector<std::string> alternatives;
  for (const std::string& word : rule.choices)
    alternatives.push_back(constant(word));
  return rule.choices.empty() ? "<text/>" : choice(alternatives);
}

std::string value(ValueType type, const std::string& content) {
  return fmt::format(
      "<attribute name=\"type\">{}</attribute><attribute name=\"value\">{}</attribute>",
      constant(type_name(type)), content);
}

/// A parameter or a list of this name, of any name if it is empty.
std::string element(const std::string& kind, const std::string& name,
                    const std::string& documentation, const std::string& content) {
  const std::string any_name = "<data type=\"string\"><param name=\"minLength\">1</param></data>";
  return fmt::format(
      "<element name=\"{}\"><a:documentation>{}</a:documentation><attribute name=\"name\">{}"
      "</attribute><ref name=\"notes\"/>{}</element>",
      kind, xml_escaped(documentation), name.empty() ? any_name : constant(name), content);
}

std::string parameter(const std::string& name, const ParameterEntry& entry) {
  const ValueType type = value_type(entry);
  const ValueRule& rule = value_rule(entry);
  std::vector<std::string> content = {plain_value(type, rule)};
  const bool is_array = type == ValueType::reals || type == ValueType::integers;
  if (is_array || type == ValueType::real || type == ValueType::integer)
    content.push_back(pattern("string", formula_pattern));
  std::vector<std::string> values = {value(type, choice(content))};
  if (!rule.variables.empty())  // formulas as strings
    values.push_back(value(is_array ? ValueType::texts : ValueType::text, "<text/>"));
  const bool names_files = name == "Include" || name == "Plug-ins";  // one or several
  if (names_files)
    values.push_back(
        value(type == ValueType::text ? ValueType::texts : ValueType::text, "<text/>"));
  for (std::string& one : values)
    one = "<group>" + one + "</group>";
  return element("Parameter", name, entry.docString(), choice(values));
}

std::string fixed_parameter(const std::string& name, ValueType type, const std::string& text,
                            const std::string& doc) {
  return element("Parameter", name, doc, value(type, constant(text)));
}

class RelaxNgWriter {
 public:
  /// Content of a list in any order, which holds `fixed` among it; nothing of the name `without`.
  std::string content(const ParameterList& valid, const std::string& without = "",
                      const std::string& fixed = "") {
    const std::string others = repeated(names_in(valid, without));
    return fixed.empty() ? others : fmt::format("<group>{}{}{}</group>", others, fixed, others);
  }

  std::string define(const std::string& hint, const std::string& pattern) {
    const std::string name = names_.name_of(hint, pattern);
    if (names_.is_new())
      definitions_ += fmt::format("<define name=\"{}\">{}</define>\n", name, pattern);
    return fmt::format("<ref name=\"{}\"/>", name);
  }

  const std::string& definitions() const { return definitions_; }

 private:
  static std::string repeated(const std::vector<std::string>& alternatives) {
    return alternatives.empty() ? "<empty/>"
                                : fmt::format("<zeroOrMore>{}</zeroOrMore>", choice(alternatives));
  }

  std::vector<std::string> names_in(const ParameterList& valid, const std::string& without) {
    std::vector<std::string> names;
    for (const auto& [name, entry] : entries(valid)) {
      if (name != without)
        names.push_back(
            define(name, entry.isList() ? sublist(name, entry) : parameter(name, entry)));
    }
    return names;
  }

  std::string sublist(const std::string& name, const ParameterEntry& entry) {
    const ListRule& rule = list_rule(entry);
    std::string inside;
    if (rule.form == ListForm::free)
      inside = "<ref name=\"anything\"/>";
    else if (holds_named_lists(rule))
      inside = repeated({element("ParameterList", "", "", chosen(name, rule))});
    else if (rule.form == ListForm::typed)
      inside = chosen(name, rule);
    else
      inside = define(name + " content", content(Teuchos::getValue<ParameterList>(entry)));
    return element("ParameterList", name, entry.docString(), inside);
  }

  /// Content of a list whose "Type" chooses among schemas.
  std::string chosen(const std::string& name, const ListRule& rule) {
    if (rule.form == ListForm::named)
      return define(name + " element", content(rule.schemas.front().parameters));
    std::vector<std::string> alternatives, all;
    for (const TypedSchema& schema : rule.schemas) {
      const std::string type =
          fixed_parameter("Type", ValueType::text, schema.type, schema.documentation);
      alternatives.push_back(define(schema.type, content(schema.parameters, "Type", type)));
      for (const std::string& one : names_in(schema.parameters, "Type")) {
        if (std::find(all.begin(), all.end(), one) == all.end())
          all.push_back(one);
      }
    }
    alternatives.push_back(define(name + " of any type", repeated(all)));
    return choice(alternatives);
  }

  Definitions names_;
  std::string definitions_;
};

std::string scene(const std::string& content) {
  return fmt::format(
      "<element name=\"ParameterList\"><optional><attribute name=\"name\"/></optional>"
      "<ref name=\"notes\"/>{}</element>",
      content);
}

}  // namespace

std::string relax_ng(const ParameterList& plane, const ParameterList& space) {
  RelaxNgWriter writer;
  std::vector<std::string> scenes;
  const std::string name = "Dimension";
  for (const ParameterList* valid : {&plane, &space}) {
    const std::string dimension = fixed_parameter(
        name, ValueType::integer, valid == &plane ? "2" : "3", valid->getEntry(name).docString());
    scenes.push_back(writer.define("scene", scene(writer.content(*valid, name, dimension))));
    scenes.push_back(writer.define("to include", scene(writer.content(*valid, name))));
  }
  return fmt::format("{}<start>{}</start>\n{}</grammar>\n", header, choice(scenes),
                     writer.definitions());
}

}  // namespace lockstep
