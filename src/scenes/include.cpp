#include "scenes/include.hpp"

#include <algorithm>
#include <filesystem>

#include "base/errors.hpp"
#include "parameters/command_line.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/untyped.hpp"

namespace lockstep {
namespace {

/// The paths that a parameter of the top level names.
std::vector<std::string> named_paths(const Document& document, const std::string& name,
                                     const std::string& what) {
  if (!document.list.isParameter(name))
    return {};
  const ParameterEntry entry = inferred(document.list.getEntry(name));
  if (entry.isType<std::string>())
    return {Teuchos::getValue<std::string>(entry)};
  check_readable(entry);
  check_input(entry.isType<ParameterArray<std::string>>(),
              "{}: \"{}\" must be a string or an Array(string): the paths of {}.",
              document.source.place(name), name, what);
  std::vector<std::string> paths;
  for (const std::string& path : Teuchos::getValue<ParameterArray<std::string>>(entry))
    paths.push_back(path);
  return paths;
}

std::vector<std::string> take_included_names(Document& document) {
  std::vector<std::string> names = named_paths(document, "Include", "scene files");
  document.list.remove("Include", false);
  return names;
}

const std::string plug_ins = "Plug-ins";

std::vector<std::string> named_plug_ins(const Document& document) {
  return named_paths(document, plug_ins, "libraries of plug-ins");
}

/// Adds the libraries that a part of a scene needs, relative to `folder_of`, to those of the scene:
/// one list in place of the two.
void take_plug_ins(Document& part, const std::string& folder_of, Document& document) {
  ParameterArray<std::string> files;
  for (const std::string& file : named_plug_ins(document))
    files.push_back(file);
  for (const std::string& file : named_plug_ins(part))
    files.push_back(resolve_path(folder_of, file));
  part.list.remove(plug_ins, false);
  if (files.size() > 0)
    document.list.set(plug_ins, files);
}

/// Files that an included scene names are relative to it; from here on to the one that includes it.
void move_files(ParameterList& list, const std::string& included) {
  for (const auto& [name, entry] : entries(list)) {
    if (entry.isList()) {
      move_files(list.sublist(name), included);
    } else if (name == "File" && inferred(entry).isType<std::string>()) {
      const std::string file = Teuchos::getValue<std::string>(inferred(entry));
      if (!file.empty())
        list.set(name, resolve_path(included, file));
    }
  }
}

/// Reads an included file; messages name the file that includes it, too.
Document read_included(const std::string& file, const std::string& place,
                       const Communicator& comm) {
  try {
    return read_parameters(file, comm, FormulaPolicy::kept);
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
    take_plug_ins(part, name, document);
    merge(document, "", part);
  }
}

/// Takes the `--set` of a parameter of the top level out of `settings`.
std::vector<std::string> take_settings(const std::string& name,
                                       std::vector<std::string>& settings) {
  const auto others =
      std::stable_partition(settings.begin(), settings.end(), [&name](const std::string& setting) {
        return trimmed(setting.substr(0, setting.find('='))) == name;
      });
  std::vector<std::string> taken(settings.begin(), others);
  settings.erase(settings.begin(), others);
  return taken;
}

/// A document without parameters, for those that `--set` gives; one path is an array, too.
Document blank(const Document& document, const std::string& name) {
  Document result{ParameterList(document.list.name()),
                  {document.source.file, {}, document.source.setting}};
  result.list.set(name, ParameterArray<std::string>());
  return result;
}

}  // namespace

void include_scenes(Document& document, std::vector<std::string>& settings,
                    const Communicator& comm) {
  for (const std::string& setting : take_settings(plug_ins, settings)) {
    document.list.set(plug_ins, ParameterArray<std::string>());
    set_unchecked(document, setting);
  }
  include_into(document, {}, comm);
  const std::vector<std::string> includes = take_settings("Include", settings);
  if (!includes.empty()) {
    Document whole = blank(document, "Include");
    whole.list.remove("Include");
    for (const std::string& setting : includes) {
      Document included = blank(document, "Include");
      set_unchecked(included, setting);
      include_into(included, {}, comm);
      take_plug_ins(included, "", whole);
      merge(whole, "", included);
    }
    take_plug_ins(document, "", whole);
    merge(whole, "", document);
    document = std::move(whole);
  }
  Document none;
  take_plug_ins(none, "", document);
}

std::vector<std::string> plug_in_files(const Document& document) {
  std::vector<std::string> files;
  for (const std::string& file : named_plug_ins(document)) {
    check_input(!file.empty(), "{}: \"{}\" names no file.", document.source.place(plug_ins),
                plug_ins);
    files.push_back(resolve_path(document.source.file, file));
  }
  return files;
}

void add_plug_in_files(const std::vector<std::string>& files, Document& document) {
  Document given;
  ParameterArray<std::string> paths;
  for (const std::string& file : files)
    paths.push_back(std::filesystem::absolute(file).string());
  given.list.set(plug_ins, paths);
  take_plug_ins(given, "", document);
}

}  // namespace lockstep
