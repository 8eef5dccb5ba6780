#include "parameters/schema/json_schema.hpp"

#include <nlohmann/json.hpp>

#include "parameters/parameter_rule.hpp"
#include "parameters/schema/definitions.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

using Json = nlohmann::ordered_json;

/// Text that YAML may take for something else is a string all the same where one is wanted.
const Json any_text = {{"type", {"string", "number", "boolean"}}};

Json number(ValueType type, const ValueRule& rule) {
  const bool is_whole = type == ValueType::integer || type == ValueType::integers;
  Json plain = {{"type", is_whole ? "integer" : "number"}};
  if (rule.lower)
    plain[rule.lower_excluded ? "exclusiveMinimum" : "minimum"] = *rule.lower;
  if (rule.upper)
    plain[rule.upper_excluded ? "exclusiveMaximum" : "maximum"] = *rule.upper;
  Json formula = {{"type", "string"}};
  if (rule.variables.empty())
    formula["pattern"] = "\\[";  // names the scene's constants
  return {{"anyOf", {plain, formula}}};
}

Json component(ValueType type, const ValueRule& rule) {
  if (type == ValueType::boolean)
    return {{"type", "boolean"}};
  if (type != ValueType::text && type != ValueType::texts)
    return number(type, rule);
  return rule.choices.empty() ? any_text : Json{{"enum", rule.choices}};
}

Json default_of(const ParameterEntry& entry) {
  switch (value_type(entry)) {
    case ValueType::real:
      return Teuchos::getValue<double>(entry);
    case ValueType::integer:
      return Teuchos::getValue<int>(entry);
    case ValueType::boolean:
      return Teuchos::getValue<bool>(entry);
    case ValueType::reals:
      return Teuchos::getValue<ParameterArray<double>>(entry).toVector();
    case ValueType::integers:
      return Teuchos::getValue<ParameterArray<int>>(entry).toVector();
    case ValueType::texts:
      return Teuchos::getValue<ParameterArray<std::string>>(entry).toVector();
    default:
      return Teuchos::getValue<std::string>(entry);
  }
}

Json parameter(const ParameterEntry& entry) {
  const ValueRule& rule = value_rule(entry);
  const ValueType type = value_type(entry);
  Json schema = component(type, rule);
  if (type == ValueType::reals || type == ValueType::integers || type == ValueType::texts) {
    schema = {{"type", "array"}, {"items", schema}};
    if (rule.n_components > 0) {
      schema["minItems"] = rule.n_components;
      schema["maxItems"] = rule.n_components;
    }
  }
  schema["description"] = entry.docString();
  if (rule.presence == Presence::has_default)
    schema["default"] = default_of(entry);
  return schema;
}

class JsonWriter {
 public:
  Json scene(const ParameterList& valid) {
    Json schema = content(valid);
    for (const char* name : {"Include", "Plug-ins"}) {  // one file or several
      if (!valid.isParameter(name))
        continue;
      schema["properties"][name] = {{"type", {"string", "array"}},
                                    {"items", {{"type", "string"}}},
                                    {"description", valid.getEntry(name).docString()}};
    }
    return define("scene", schema);
  }

  const Json& definitions() const { return definitions_; }

 private:
  Json define(const std::string& hint, const Json& schema) {
    const std::string name = names_.name_of(hint, schema.dump());
    if (names_.is_new())
      definitions_[name] = schema;
    return {{"$ref", "#/definitions/" + name}};
  }

  /// A list of these parameters and no others.
  Json content(const ParameterList& valid) {
    Json properties = Json::object();
    for (const auto& [name, entry] : entries(valid))
      properties[name] = define(name, entry.isList() ? sublist(name, entry) : parameter(entry));
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  }

  Json sublist(const std::string& name, const ParameterEntry& entry) {
    const ListRule& rule = list_rule(entry);
    Json schema = {{"type", "object"}};
    if (holds_named_lists(rule)) {
      schema["additionalProperties"] = define(name + "-element", element(rule));
    } else if (rule.form == ListForm::typed) {
      schema = element(rule);
    } else if (rule.form != ListForm::free) {
      schema = content(Teuchos::getValue<ParameterList>(entry));
    }
    schema["description"] = entry.docString();
    return schema;
  }

  /// A list whose "Type" chooses its parameters; one without may get it from an included file, from
  /// "Defaults" or from a solver file, and so may have those of all types.
  Json element(const ListRule& rule) {
    if (rule.form == ListForm::named)
      return content(rule.schemas.front().parameters);
    Json cases = Json::array(), any = Json::object();
    for (const TypedSchema& schema : rule.schemas) {
      const Json chosen = content(schema.parameters);
      for (const auto& [name, property] : chosen["properties"].items())
        add_alternative(any[name], property);
      cases.push_back({{"if", type_is(schema.type)}, {"then", define(schema.type, chosen)}});
    }
    const Json untyped = {{"properties", any}, {"additionalProperties", false}};
    cases.push_back({{"if", {{"not", {{"required", Json::array({"Type"})}}}}}, {"then", untyped}});
    const Json type = parameter(rule.type_declaration().getEntry("Type"));
    return {{"type", "object"}, {"properties", {{"Type", type}}}, {"allOf", cases}};
  }

  static Json type_is(const std::string& type) {
    return {{"properties", {{"Type", {{"const", type}}}}}, {"required", Json::array({"Type"})}};
  }

  static void add_alternative(Json& alternatives, const Json& one) {
    if (alternatives.is_null())
      alternatives["anyOf"] = Json::array();
    for (const Json& known : alternatives["anyOf"]) {
      if (known == one)
        return;
    }
    alternatives["anyOf"].push_back(one);
  }

  Definitions names_;
  Json definitions_ = Json::object();
};

Json dimension_is(int dimension) {
  return {{"properties", {{"Dimension", {{"const", dimension}}}}},
          {"required", Json::array({"Dimension"})}};
}

}  // namespace

std::string json_schema(const ParameterList& plane, const ParameterList& space) {
  JsonWriter writer;
  const Json flat = writer.scene(plane), spatial = writer.scene(space);
  const Json any = {{"anyOf", {flat, spatial}}};  // a file to include need not say
  const Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "Lockstep scene"},
      {"$comment",
       "Strings with [ ] stand for formulas. No parameter is required: an included file may have "
       "it. Lists that a library checks itself may hold anything."},
      {"type", "object"},
      {"if", dimension_is(2)},
      {"then", flat},
      {"else", {{"if", dimension_is(3)}, {"then", spatial}, {"else", any}}},
      {"definitions", writer.definitions()}};
  return schema.dump(1) + "\n";
}

}  // namespace lockstep
