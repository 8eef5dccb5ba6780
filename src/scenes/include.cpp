#include "scenes/include.hpp"

#include <algorithm>
#include <filesystem>

#include "base/errors.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/strict_xml.hpp"

namespace lockstep {
namespace {

std::vector<std::string> take_included_names(Document& document) {
  const ParameterEntry* entry = document.list.getEntryPtr("Include");
  if (!entry)
    return {};
  std::vector<std::string> names;
  if (entry->isType<std::string>()) {
    names.push_back(document.list.get<std::string>("Include"));
  } else {
    check_readable(*entry);
    check_input(entry->isType<ParameterArray<std::string>>(),
                "{}: \"Include\" must be a string or an Array(string): the paths of scene files.",
                document.source.place("Include"));
    for (const std::string& name : document.list.get<ParameterArray<std::string>>("Include"))
      names.push_back(name);
  }
  document.list.remove("Include");
  return names;
}

/// Files that an included scene names are relative to it; from here on to the one that includes it.
void move_files(ParameterList& list, const std::string& included) {
  for (const auto& [name, entry] : entries(list)) {
    if (entry.isList()) {
      move_files(list.sublist(name), included);
    } else if (name == "File" && entry.isType<std::string>()) {
      const std::string file = Teuchos::getValue<std::string>(entry);
      if (!file.empty())
        list.set(name, resolve_path(included, file));
    }
  }
}

/// Reads an included file; messages name the file that includes it, too.
Document read_included(const std::string& file, const std::string& place,
                       const Communicator& comm) {
  try {
    return read_xml(file, comm, FormulaPolicy::kept);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: what it includes: {}", place, error.what()));
  }
}

/// `chain`: the files that led here, to see circles.
void include_into(Document& document, std::vector<std::string> chain, const Communicator& comm) {
  const std::string place = document.source.place("Include");
  chain.push_back(std::filesystem::path(document.source.file).lexically_normal().string());
  for (const std::string& name : take_included_names(document)) {
    check_input(!name.empty(), "{}: \"Include\" names no file.", place);
    const std::string file = resolve_path(document.source.file, name);
    check_input(std::find(chain.begin(), chain.end(), file) == chain.end(),
                "{}: \"{}\" includes itself ({} -> {}).", place, file, fmt::join(chain, " -> "),
                file);
    Document part = read_included(file, place, comm);
    include_into(part, chain, comm);
    move_files(part.list, name);
    merge(document, "", part);
  }
}

}  // namespace

void include_scenes(Document& document, const Communicator& comm) {
  include_into(document, {}, comm);
}

}  // namespace lockstep
