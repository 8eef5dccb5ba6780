#include "stepping/restart_check.hpp"

#include <map>
#include <sstream>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "base/shortened.hpp"
#include "output/checksum.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/source.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

const char* const help =
    "Restart with the scene and the settings (--set) of the run that wrote it; only \"Title\", "
    "\"Time\" (but "
    "for its \"Start\"), \"Solver\", \"Output\", \"Observers\" and \"View\" may differ.";

/// A run may go on to another end, with other steps, solvers and outputs. But bodies stand, joints
/// are anchored and pinned nodes begin to turn where their scripts have them at the start.
bool may_differ(const std::string& path) {
  return path == "Title" || (path.rfind("Time/", 0) == 0 && path != "Time/Start") ||
         path == "Solver" || path == "Output" || path == "Observers" || path == "View";
}

/// Difference between two entries, as the end of a sentence; "" if there is none.
std::string difference(const ParameterEntry& before, const ParameterEntry& now) {
  if (before.isList() != now.isList())
    return "is a list in one of the two only";
  return before.getAny(false) == now.getAny(false)
             ? ""
             : fmt::format("was {} and is {} now", shortened(quoted_value(before)),
                           shortened(quoted_value(now)));
}

/// The first difference between two lists: the path in quotes and how it differs.
std::string first_difference(const ParameterList& before, const ParameterList& now,
                             const std::string& path) {
  for (const auto& [name, entry] : entries(now)) {
    const std::string here = join_path(path, name);
    if (may_differ(here))
      continue;
    const ParameterEntry* old = before.getEntryPtr(name);
    if (old == nullptr && entry.isDefault())
      continue;  // an earlier version of the program did not know it yet
    std::string found = old == nullptr ? "is new" : "";
    if (old != nullptr && old->isList() && entry.isList()) {
      const std::string below = first_difference(before.sublist(name), now.sublist(name), here);
      if (!below.empty())
        return below;
    } else if (old != nullptr) {
      found = difference(*old, entry);
    }
    if (!found.empty())
      return fmt::format("\"{}\" {}", here, found);
  }
  for (const auto& [name, entry] : entries(before)) {
    const std::string here = join_path(path, name);
    if (!may_differ(here) && now.getEntryPtr(name) == nullptr)
      return fmt::format("\"{}\" is missing now", here);
  }
  return "";
}

/// Calls visit(path, file) for each parameter "File" that names one.
template <typename Visit>
void for_each_file(const ParameterList& list, const std::string& path, const Visit& visit) {
  for (const auto& [name, entry] : entries(list)) {
    const std::string here = join_path(path, name);
    if (may_differ(here))
      continue;
    if (entry.isList()) {
      for_each_file(list.sublist(name), here, visit);
    } else if (name == "File" && value_type(entry) == ValueType::text && value_text(entry) != "") {
      visit(here, value_text(entry));
    }
  }
}

std::map<std::string, std::string> checksums_by_path(const std::string& lines) {
  std::map<std::string, std::string> result;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t end = line.rfind(' ');
    if (end != std::string::npos)
      result[line.substr(0, end)] = line.substr(end + 1);
  }
  return result;
}

}  // namespace

std::string checksums_of_files(const ParameterList& scene, const std::string& scene_file,
                               const Communicator& comm) {
  std::string lines, message;
  if (is_root(comm)) {
    for_each_file(scene, "", [&](const std::string& path, const std::string& file) {
      std::string failure;
      const std::string text = read_regular_file(resolve_path(scene_file, file), failure);
      if (!failure.empty())
        message = fmt::format("Cannot read '{}', the file of \"{}\": {}.", file, path, failure);
      lines += fmt::format("{} {:08x}\n", path, checksum_of(text));
    });
  }
  throw_on_all(comm, message, static_cast<int>(ExitCode::bad_input));
  int size = static_cast<int>(lines.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, raw_communicator(comm));
  lines.resize(static_cast<std::size_t>(size));
  MPI_Bcast(lines.data(), size, MPI_CHAR, 0, raw_communicator(comm));
  return lines;
}

void check_same_scene(const ParameterList& scene, const std::string& files,
                      const CheckpointHeader& header, const std::string& checkpoint) {
  const ParameterList before = read_xml_string(header.parameters, checkpoint).list;
  const std::string found = first_difference(before, scene, "");
  check_input(found.empty(), "Checkpoint '{}' belongs to another scene: {}. {}", checkpoint, found,
              help);
  const auto old_files = checksums_by_path(header.files);
  for (const auto& [path, checksum] : checksums_by_path(files)) {
    const auto old = old_files.find(path);
    check_input(
        old != old_files.end() && old->second == checksum,
        "Checkpoint '{}' belongs to another scene: the content of the file that \"{}\" names "
        "has changed. {}",
        checkpoint, path, help);
  }
}

}  // namespace lockstep
