#include "studies/case_files.hpp"

#include <filesystem>
#include <map>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "output/checksum.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/untyped.hpp"

namespace lockstep {

namespace {

namespace fs = std::filesystem;

/// All texts in a list that might name a file.
void collect_texts(const ParameterList& list, std::vector<std::string>& texts) {
  for (const auto& [name, entry] : entries(list)) {
    const ParameterEntry value = inferred(entry);
    if (entry.isList()) {
      collect_texts(list.sublist(name), texts);
    } else if (value_type(value) == ValueType::text) {
      texts.push_back(value_text(value));
    } else if (value_type(value) == ValueType::texts) {
      for (const std::string& text : Teuchos::getValue<ParameterArray<std::string>>(value))
        texts.push_back(text);
    }
  }
}

/// Returns the texts in a parameter file; none if the file is something else.
std::vector<std::string> texts_in(const std::string& content, const std::string& file) {
  std::vector<std::string> texts;
  try {
    collect_texts(read_parameters_text(content, file, FormulaPolicy::kept).list, texts);
  } catch (const InputError&) {
    texts.clear();  // a mesh; or simulate will say what is wrong
  }
  return texts;
}

/// "A=b", "A={b, c}": b and c.
std::vector<std::string> texts_of(const std::string& assignment) {
  std::string value = trimmed(assignment.substr(assignment.find('=') + 1));
  std::vector<std::string> texts{value};
  if (value.size() > 1 && value.front() == '{' && value.back() == '}')
    value = value.substr(1, value.size() - 2);
  for (std::size_t begin = 0; begin <= value.size();) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    texts.push_back(trimmed(value.substr(begin, end - begin)));
    begin = end + 1;
  }
  return texts;
}

/// Adds the file and what it names, once each.
void add_file(const std::string& path, std::map<std::string, std::string>& checksums) {
  const std::string file = fs::path(path).lexically_normal();
  if (checksums.count(file) != 0)
    return;
  std::string failure;
  const std::string content = read_regular_file(file, failure);
  if (!failure.empty())
    return;
  checksums[file] = fmt::format("{:08x} {}", checksum_of(content), content.size());
  for (const std::string& text : texts_in(content, file)) {
    if (!text.empty())
      add_file(resolve_path(file, text), checksums);
  }
}

}  // namespace

std::string checksums_of_inputs(const StudyCase& study_case) {
  std::map<std::string, std::string> checksums;
  add_file(study_case.scene_file, checksums);
  check_input(!checksums.empty(), "Cannot read the scene '{}'.", study_case.scene_file);
  for (const std::string& assignment : study_case.assignments) {
    for (const std::string& text : texts_of(assignment)) {
      if (!text.empty())
        add_file(resolve_path(study_case.scene_file, text), checksums);
    }
  }
  std::string lines;
  for (const auto& [file, checksum] : checksums)
    lines += fmt::format("{} {}\n", file, checksum);
  return lines;
}

}  // namespace lockstep
