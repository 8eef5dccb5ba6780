#include "parameters/reference.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/source.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

struct Row {
  std::string name, type, initial, allowed, documentation;
};

/// One list of the reference.
struct Section {
  std::string path, documentation, note;
  int depth;
  std::vector<Row> rows;
};

Row make_row(const std::string& name, const ParameterEntry& entry) {
  const ValueRule& rule = value_rule(entry);
  const std::string initial = rule.presence == Presence::required   ? "required"
                              : rule.presence == Presence::optional ? "unset"
                                                                    : quoted_value(entry);
  return {name, type_name(value_type(entry)), initial, rule.allowed(), entry.docString()};
}

void add_sections(std::vector<Section>& sections, const ParameterList& valid, Section section);

void add_list(std::vector<Section>& sections, const ParameterEntry& entry, const std::string& path,
              int depth) {
  const ListRule& rule = list_rule(entry);
  Section section{path, entry.docString(), "", depth, {}};
  switch (rule.form) {
    case ListForm::free:
      section.note = "Its content is checked by whoever reads it.";
      sections.push_back(section);
      return;
    case ListForm::optional:
      section.note = "The list may be left out.";
      break;
    case ListForm::named:
      section.note = "Holds any number of lists with names of your choice, each with:";
      add_sections(sections, rule.schemas.front().parameters, section);
      return;
    case ListForm::typed:
    case ListForm::named_typed:
      section.note = holds_named_lists(rule)
                         ? "Holds any number of lists with names of your choice. The \"Type\" of "
                           "each decides its parameters:"
                         : "Its \"Type\" decides its parameters:";
      add_sections(sections, rule.type_declaration(), section);
      for (const TypedSchema& schema : rule.schemas) {
        ParameterList parameters = schema.parameters;
        parameters.remove("Type");
        add_sections(sections, parameters,
                     {fmt::format("{} (Type \"{}\")", path, schema.type),
                      schema.documentation,
                      "",
                      depth + 1,
                      {}});
      }
      return;
    case ListForm::plain:
      break;
  }
  add_sections(sections, Teuchos::getValue<ParameterList>(entry), section);
}

void add_sections(std::vector<Section>& sections, const ParameterList& valid, Section section) {
  for (const auto& [name, entry] : entries(valid)) {
    if (!entry.isList())
      section.rows.push_back(make_row(name, entry));
  }
  const std::string path = section.path;
  const int depth = section.depth;
  sections.push_back(std::move(section));
  for (const auto& [name, entry] : entries(valid)) {
    if (entry.isList())
      add_list(sections, entry, join_path(path, name), depth + 1);
  }
}

std::vector<Section> all_sections(const ParameterList& valid) {
  std::vector<Section> sections;
  add_sections(sections, valid, {"", "", "", 0, {}});
  return sections;
}

}  // namespace

std::string reference_text(const ParameterList& valid) {
  std::string text;
  for (const Section& section : all_sections(valid)) {
    const std::string indent(2 * std::max(section.depth - 1, 0), ' ');
    if (!section.path.empty())
      text += fmt::format("\n{}[{}]\n", indent, section.path);
    for (const std::string& line : {section.documentation, section.note}) {
      if (!line.empty())
        text += fmt::format("{}{}\n", indent, line);
    }
    for (const Row& row : section.rows) {
      text += fmt::format("{}  {} : {} = {}{}\n{}      {}\n", indent, row.name, row.type,
                          row.initial, row.allowed.empty() ? "" : "  [" + row.allowed + "]", indent,
                          row.documentation);
    }
  }
  return text;
}

std::string reference_json(const ParameterList& valid) {
  auto lists = nlohmann::ordered_json::array();
  for (const Section& section : all_sections(valid)) {
    auto parameters = nlohmann::ordered_json::array();
    for (const Row& row : section.rows) {
      parameters.push_back({{"name", row.name},
                            {"type", row.type},
                            {"default", row.initial},
                            {"allowed", row.allowed},
                            {"documentation", row.documentation}});
    }
    lists.push_back({{"path", section.path},
                     {"documentation", section.documentation},
                     {"note", section.note},
                     {"parameters", std::move(parameters)}});
  }
  return lists.dump(1) + "\n";
}

std::vector<std::string> undocumented(const ParameterList& valid) {
  std::vector<std::string> paths;
  for (const Section& section : all_sections(valid)) {
    if (!section.path.empty() && trimmed(section.documentation).empty()) {
      paths.push_back(section.path);
    }
    for (const Row& row : section.rows) {
      if (trimmed(row.documentation).empty())
        paths.push_back(join_path(section.path, row.name));
    }
  }
  return paths;
}

}  // namespace lockstep
