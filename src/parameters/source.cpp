#include "parameters/source.hpp"

#include <filesystem>

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"

namespace lockstep {

std::string Source::place(const std::string& path) const {
  std::string current = path;
  while (true) {
    const auto found = places.find(current);
    if (found != places.end())
      return found->second;
    if (current.empty())
      return file;
    const std::size_t slash = current.rfind('/');
    current.resize(slash == std::string::npos ? 0 : slash);
  }
}

std::string join_path(const std::string& list_path, const std::string& name) {
  return list_path.empty() ? name : list_path + "/" + name;
}

std::string in_list(const std::string& list_path) {
  return list_path.empty() ? "at the top level" : fmt::format("in \"{}\"", list_path);
}

std::string resolve_path(const std::string& scene_file, const std::string& relative) {
  const std::filesystem::path path(relative);
  if (path.is_absolute())
    return path.lexically_normal().string();
  return (std::filesystem::path(scene_file).parent_path() / path).lexically_normal().string();
}

namespace {

void merge_list(ParameterList& list, const std::string& path, Source& source,
                const ParameterList& part, const std::string& part_path,
                const Source& part_source) {
  for (const auto& [name, entry] : entries(part)) {
    const std::string here = join_path(path, name);
    const std::string there = join_path(part_path, name);
    if (list.isParameter(name)) {
      check_input(list.isSublist(name) == entry.isList(),
                  "{}: {}, \"{}\" is a {}, but {} has a {} of this name.", source.place(here),
                  in_list(path), name, list.isSublist(name) ? "list" : "parameter",
                  part_source.place(there), entry.isList() ? "list" : "parameter");
    } else if (entry.isList()) {
      list.sublist(name);
      source.places[here] = part_source.place(there);
    } else {
      list.setEntry(name, entry);
      source.places[here] = part_source.place(there);
    }
    if (entry.isList()) {
      merge_list(list.sublist(name), here, source, part.sublist(name), there, part_source);
    }
  }
}

}  // namespace

void merge(Document& document, const std::string& list_path, const Document& part) {
  ParameterList* list = &document.list;
  std::string path;
  for (std::size_t start = 0; !list_path.empty() && start != std::string::npos;) {
    const std::size_t slash = list_path.find('/', start);
    const std::string name = list_path.substr(start, slash - start);
    check_input(!list->isParameter(name) || list->isSublist(name),
                "{}: {}, \"{}\" must be a list, not a parameter.",
                document.source.place(join_path(path, name)), in_list(path), name);
    list = &list->sublist(name);
    path = join_path(path, name);
    start = slash == std::string::npos ? slash : slash + 1;
  }
  merge_list(*list, path, document.source, part.list, "", part.source);
}

}  // namespace lockstep
