#include "parameters/write.hpp"

#include "base/errors.hpp"
#include "base/xml_text.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/source.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

std::string attribute(const std::string& name, const std::string& value) {
  return value.empty() ? "" : fmt::format(" {}=\"{}\"", name, xml_escaped(value));
}

/// The text of a value, proven to read back to the same value.
std::string readable_text(const std::string& name, const ParameterEntry& entry) {
  const ValueType type = value_type(entry);
  const std::string text = value_text(entry);
  bool same = false;
  try {
    same = type != ValueType::other && parse_value(type, text).getAny(false) == entry.getAny(false);
  } catch (const InputError&) {
    same = false;
  }
  check_output(same, "The value {} of parameter \"{}\" cannot be written as XML.", text, name);
  return text;
}

void add_list(std::string& xml, const ParameterList& list, const std::string& name,
              const std::string& documentation, int depth) {
  const std::string indent(2 * depth, ' ');
  xml += fmt::format("{}<ParameterList name=\"{}\"{}>\n", indent, xml_escaped(name),
                     attribute("docString", documentation));
  for (const auto& [child, entry] : entries(list)) {
    if (entry.isList()) {
      add_list(xml, list.sublist(child), child, entry.docString(), depth + 1);
    } else {
      xml += fmt::format("{}  <Parameter name=\"{}\" type=\"{}\" value=\"{}\"{}{}/>\n", indent,
                         xml_escaped(child), type_name(value_type(entry)),
                         xml_escaped(readable_text(child, entry)),
                         entry.isDefault() ? " isDefault=\"true\"" : "",
                         attribute("docString", entry.docString()));
    }
  }
  xml += indent + "</ParameterList>\n";
}

void add_differences(std::vector<std::string>& lines, const ParameterList& list,
                     const ParameterList* valid, const std::string& path);

/// `valid` of a free list is null: all that stands in it is the user's.
void add_sublist_differences(std::vector<std::string>& lines, const ParameterList& list,
                             const ParameterEntry* valid, const std::string& path) {
  const ListRule rule = valid ? list_rule(*valid) : ListRule();
  if (!valid || rule.form == ListForm::free) {
    add_differences(lines, list, nullptr, path);
  } else if (holds_named_lists(rule)) {
    for (const auto& [name, entry] : entries(list)) {
      const TypedSchema* schema = entry.isList() ? rule.schema_for(list.sublist(name)) : nullptr;
      if (!schema)
        continue;
      add_differences(lines, list.sublist(name), &schema->parameters, join_path(path, name));
    }
  } else if (rule.form == ListForm::typed) {
    const TypedSchema* schema = rule.schema_for(list);
    add_differences(lines, list, schema ? &schema->parameters : nullptr, path);
  } else {
    add_differences(lines, list, &Teuchos::getValue<ParameterList>(*valid), path);
  }
}

void add_differences(std::vector<std::string>& lines, const ParameterList& list,
                     const ParameterList* valid, const std::string& path) {
  for (const auto& [name, entry] : entries(list)) {
    const ParameterEntry* valid_entry = valid ? valid->getEntryPtr(name) : nullptr;
    const std::string here = join_path(path, name);
    if (entry.isList()) {
      add_sublist_differences(lines, list.sublist(name), valid_entry, here);
      continue;
    }
    const bool has_default =
        valid_entry && value_rule(*valid_entry).presence == Presence::has_default;
    if (has_default && valid_entry->getAny(false) == entry.getAny(false))
      continue;
    lines.push_back(
        fmt::format("{} = {}{}", here, quoted_value(entry),
                    has_default ? fmt::format(" (default {})", quoted_value(*valid_entry)) : ""));
  }
}

}  // namespace

std::string to_xml(const ParameterList& list) {
  std::string xml;
  add_list(xml, list, list.name(), "", 0);
  return xml;
}

std::vector<std::string> differences_from_default(const ParameterList& list,
                                                  const ParameterList& valid) {
  std::vector<std::string> lines;
  add_differences(lines, list, &valid, "");
  return lines;
}

}  // namespace lockstep
