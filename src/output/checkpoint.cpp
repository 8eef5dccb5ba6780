#include "output/checkpoint.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <regex>
#include <utility>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "output/checksum.hpp"
#include "output/exchange.hpp"
#include "output/hdf5_probe.hpp"

namespace lockstep {

namespace fs = std::filesystem;

namespace {
constexpr long long format_version = 2;
const std::string format_name = "Lockstep checkpoint";

std::string checkpoint_path(const std::string& directory, long long step) {
  return fmt::format("{}/checkpoint-{:06}.h5", directory, step);
}

/// Steps of the checkpoints in a folder, or of those that killed runs have left half-written, with
/// their files.
std::map<long long, fs::path> checkpoints_in(const std::string& directory, bool whole = true) {
  const std::regex pattern(whole ? "checkpoint-([0-9]{1,18})\\.h5"
                                 : "checkpoint-([0-9]{1,18})\\.h5\\.part");
  std::map<long long, fs::path> found;
  std::error_code error;
  for (const fs::directory_entry& item : fs::directory_iterator(directory, error)) {
    const std::string name = item.path().filename();
    std::smatch match;
    if (std::regex_match(name, match, pattern))
      found[std::stoll(match[1])] = item.path();
  }
  return found;
}

std::string damaged(const std::string& path, const std::string& reason) {
  return fmt::format("Checkpoint '{}' is truncated or damaged, restart from an earlier one. ({})",
                     path, reason);
}

/// Looks at the file by plain means first, to tell a wrong file from a damaged one and to keep
/// HDF5, which may crash on it, from a damaged one.
Hdf5File open_checkpoint(const Communicator& comm, const std::string& path) {
  std::string message;
  ExitCode code = ExitCode::bad_input;
  if (is_root(comm)) {
    const std::string refusal = refusal_to_read(path);
    if (path.empty()) {
      message = "The name of the checkpoint is empty.";
    } else if (!fs::exists(path)) {
      message = fmt::format("Checkpoint '{}' does not exist.", path);
    } else if (!fs::is_regular_file(path)) {
      message = fmt::format("Checkpoint '{}' is not a file: {}.", path, refusal);
    } else if (!refusal.empty()) {
      message = fmt::format("Checkpoint '{}' may not be read ({}): check its permissions.", path,
                            refusal);
      code = ExitCode::output_failed;
    }
  }
  throw_on_all(comm, message, static_cast<int>(code));
  const ChecksumState state = check_checksum(comm, path);
  if (state == ChecksumState::broken)
    throw OutputError(
        damaged(path, "its bytes do not have the checksum that was written with them"));
  if (state == ChecksumState::absent && is_root(comm)) {
    std::ifstream stream(path, std::ios::binary);
    char head[8] = {};
    stream.read(head, sizeof head);
    const auto n_read = static_cast<std::size_t>(stream.gcount());
    const std::string signature = "\x89HDF\r\n\x1a\n";
    const std::string refusal = refusal_of_hdf5(path);
    if (std::string(head, n_read) != signature.substr(0, n_read)) {
      message = fmt::format("'{}' is not a checkpoint: it is no HDF5 file.", path);
    } else if (!refusal.empty()) {
      message = damaged(path, refusal);
      code = ExitCode::output_failed;
    }
  }
  throw_on_all(comm, message, static_cast<int>(code));
  try {
    Hdf5File file = Hdf5File::open(comm, path);
    check_input(file.has_attribute("/", "format") &&
                    file.read_attribute<std::string>("/", "format") == format_name,
                "'{}' is an HDF5 file, but not a checkpoint of this program.", path);
    const auto version = file.read_attribute<long long>("/", "version");
    check_input(
        version == format_version,
        "Checkpoint '{}' has format version {}, this program reads version {}: restart with the "
        "program that wrote it.",
        path, version, format_version);
    if (state == ChecksumState::absent)
      throw OutputError("its checksum is missing");
    return file;
  } catch (const OutputError& error) {
    throw OutputError(damaged(path, error.what()));
  }
}

/// Entities sorted by global number; rank after rank holds the next part of them.
template <typename T>
struct SortedPart {
  std::vector<GlobalIndex> ids;
  std::vector<T> values;
};

template <typename T>
SortedPart<T> sorted(const std::vector<GlobalIndex>& ids, const std::vector<T>& values,
                     int n_components) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  SortedPart<T> part;
  part.ids.reserve(ids.size());
  part.values.reserve(values.size());
  for (const std::size_t i : order) {
    const auto value = values.begin() + i * n_components;
    part.ids.push_back(ids[i]);
    part.values.insert(part.values.end(), value, value + n_components);
  }
  return part;
}

template <typename T>
SortedPart<T> sorted_part(const Communicator& comm, const std::vector<GlobalIndex>& ids,
                          const std::vector<T>& values, int n_components) {
  const int n_ranks = comm->getSize();
  if (n_ranks == 1)  // a checkpoint is what takes most memory
    return sorted(ids, values, n_components);
  const GlobalIndex largest = ids.empty() ? no_index : *std::max_element(ids.begin(), ids.end());
  const GlobalIndex n = max_all(comm, largest) + 1;
  std::vector<std::size_t> counts(n_ranks, 0);
  for (const GlobalIndex id : ids)
    ++counts[rank_of(id, n, n_ranks)];
  std::vector<std::vector<GlobalIndex>> sent_ids(n_ranks);
  std::vector<std::vector<T>> sent_values(n_ranks);
  for (int rank = 0; rank < n_ranks; ++rank) {
    sent_ids[rank].reserve(counts[rank]);
    sent_values[rank].reserve(counts[rank] * n_components);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int rank = rank_of(ids[i], n, n_ranks);
    const auto value = values.begin() + i * n_components;
    sent_ids[rank].push_back(ids[i]);
    sent_values[rank].insert(sent_values[rank].end(), value, value + n_components);
  }
  const std::vector<GlobalIndex> my_ids = send_to_ranks(comm, std::exchange(sent_ids, {}));
  const std::vector<T> my_values = send_to_ranks(comm, std::exchange(sent_values, {}));
  return sorted(my_ids, my_values, n_components);
}
}  // namespace

CheckpointWriter::CheckpointWriter(const Communicator& comm, const std::string& directory,
                                   const CheckpointHeader& header)
    : comm_(comm),
      directory_(directory),
      step_(header.step),
      file_(Hdf5File::create(comm, checkpoint_path(directory, header.step))) {
  file_.write_attribute<std::string>("/", "format", format_name);
  file_.write_attribute<long long>("/", "version", format_version);
  file_.write_attribute<long long>("/", "step", header.step);
  file_.write_attribute<double>("/", "time", header.time);
  file_.write_text("parameters", header.parameters);
  file_.write_text("files", header.files);
}

template <typename T>
void CheckpointWriter::write_distributed(const std::string& name,
                                         const std::vector<GlobalIndex>& global_ids,
                                         const std::vector<T>& values, int n_components) {
  std::string failure;
  if (values.size() != global_ids.size() * n_components) {
    failure = "has a wrong number of values";
  } else if (std::any_of(global_ids.begin(), global_ids.end(), [](auto id) { return id < 0; })) {
    failure = "has a negative number";
  }
  const auto fail_together = [&] {
    throw_on_all(comm_,
                 failure.empty()
                     ? ""
                     : fmt::format("Checkpoint '{}': array '{}' {}.", file_.path(), name, failure),
                 static_cast<int>(ExitCode::output_failed));
  };
  fail_together();
  const SortedPart<T> part = sorted_part(comm_, global_ids, values, n_components);
  const auto twice = std::adjacent_find(part.ids.begin(), part.ids.end());
  if (twice != part.ids.end())
    failure = fmt::format("has number {} twice", *twice);
  fail_together();
  file_.create_group(name);
  file_.write_slices(name + "/ids", part.ids);
  file_.write_slices(name + "/values", part.values, n_components);
}

void CheckpointWriter::finish(int keep) {
  file_.close_with_checksum();
  if (!is_root(comm_))
    return;
  std::map<long long, fs::path> found = checkpoints_in(directory_);
  found.erase(found.upper_bound(step_), found.end());
  for (auto oldest = found.begin(); static_cast<int>(found.size()) > std::max(keep, 1);) {
    std::error_code error;
    fs::remove(oldest->second, error);
    oldest = found.erase(oldest);
  }
}

CheckpointReader::CheckpointReader(const Communicator& comm, const std::string& path)
    : comm_(comm), file_(open_checkpoint(comm, path)) {
  header_.step = file_.read_attribute<long long>("/", "step");
  check(header_.step >= 0, fmt::format("its step is {}", header_.step));
  header_.time = file_.read_attribute<double>("/", "time");
  header_.parameters = file_.read_text("parameters");
  header_.files = file_.read_text("files");
}

void CheckpointReader::check(bool makes_sense, const std::string& what) const {
  throw_on_all(comm_, makes_sense ? "" : damaged(file_.path(), what),
               static_cast<int>(ExitCode::output_failed));
}

template <typename T>
std::vector<T> CheckpointReader::read_distributed(const std::string& name,
                                                  const std::vector<GlobalIndex>& wanted_global_ids,
                                                  int n_components) const {
  check_input(file_.exists(name + "/ids") && file_.exists(name + "/values"),
              "Checkpoint '{}' has no array '{}': it belongs to a scene with other models.",
              file_.path(), name);
  const int n_ranks = comm_->getSize();
  const std::vector<GlobalIndex> shape_of_ids = file_.shape(name + "/ids"),
                                 shape = file_.shape(name + "/values");
  GlobalIndex n_values = 1;
  for (const GlobalIndex extent : shape)
    n_values *= extent;
  check(shape_of_ids.size() == 1 && !shape.empty() && shape.front() == shape_of_ids.front() &&
            n_values == shape_of_ids.front() * n_components,
        fmt::format("the array '{}' does not hold {} values for each of its numbers", name,
                    n_components));
  const GlobalIndex n = shape_of_ids.front();
  const GlobalIndex first = first_of_rank(n, comm_->getRank(), n_ranks);
  const GlobalIndex n_mine = first_of_rank(n, comm_->getRank() + 1, n_ranks) - first;
  const auto ids = file_.read_rows<long long>(name + "/ids", first, n_mine);
  const auto values = file_.read_rows<T>(name + "/values", first, n_mine);

  // The first number on each rank that holds any tells where an entity is.
  const std::vector<GlobalIndex> firsts =
      gather_all(comm_, n_mine > 0 ? std::vector<GlobalIndex>{ids.front(), comm_->getRank()}
                                   : std::vector<GlobalIndex>());
  std::map<GlobalIndex, int> rank_from;
  for (std::size_t i = 0; i < firsts.size(); i += 2) {
    rank_from[firsts[i]] = static_cast<int>(firsts[i + 1]);
  }
  std::vector<std::vector<long long>> asked(n_ranks);
  std::vector<std::vector<std::size_t>> places(n_ranks);
  std::string failure;
  for (std::size_t i = 0; i < wanted_global_ids.size(); ++i) {
    auto after = rank_from.upper_bound(wanted_global_ids[i]);
    if (after == rank_from.begin()) {
      failure = fmt::format("{}", wanted_global_ids[i]);
      continue;
    }
    const int rank = std::prev(after)->second;
    asked[rank].push_back(wanted_global_ids[i]);
    places[rank].push_back(i);
  }
  std::vector<GlobalIndex> n_asked;
  const std::vector<long long> requests = send_to_ranks(comm_, asked, &n_asked);
  std::vector<std::vector<T>> replies(n_ranks);
  auto request = requests.begin();
  for (int rank = 0; rank < n_ranks; ++rank) {
    for (const auto end = request + n_asked[rank]; request != end; ++request) {
      const auto found = std::lower_bound(ids.begin(), ids.end(), *request);
      if (found == ids.end() || *found != *request) {
        failure = fmt::format("{}", *request);
        continue;
      }
      const auto value = values.begin() + (found - ids.begin()) * n_components;
      replies[rank].insert(replies[rank].end(), value, value + n_components);
    }
  }
  if (!failure.empty()) {
    failure = fmt::format(
        "Checkpoint '{}': array '{}' has no entry number {}: the mesh or the grid "
        "has changed.",
        file_.path(), name, failure);
  }
  throw_on_all(comm_, failure, static_cast<int>(ExitCode::bad_input));
  const std::vector<T> received = send_to_ranks(comm_, replies);
  std::vector<T> result(wanted_global_ids.size() * n_components);
  auto value = received.begin();
  for (const std::vector<std::size_t>& of_rank : places) {
    for (const std::size_t place : of_rank) {
      std::copy_n(value, n_components, result.begin() + place * n_components);
      value += n_components;
    }
  }
  return result;
}

std::string latest_checkpoint(const std::string& directory) {
  const std::map<long long, fs::path> found = checkpoints_in(directory);
  return found.empty() ? "" : found.rbegin()->second.string();
}

void discard_checkpoints_after(const Communicator& comm, const std::string& directory,
                               long long step) {
  std::string message;
  if (is_root(comm)) {
    std::map<long long, fs::path> obsolete = checkpoints_in(directory);
    obsolete.erase(obsolete.begin(), obsolete.upper_bound(step));
    std::error_code error;
    for (const auto& files : {obsolete, checkpoints_in(directory, false)}) {
      for (const auto& [number, file] : files) {
        fs::remove(file, error);
        if (error)
          message = fmt::format("Cannot remove the obsolete checkpoint '{}': {}.", file.string(),
                                error.message());
      }
    }
  }
  throw_on_all(comm, message, static_cast<int>(ExitCode::output_failed));
}

template void CheckpointWriter::write_distributed(const std::string&,
                                                  const std::vector<GlobalIndex>&,
                                                  const std::vector<double>&, int);
template void CheckpointWriter::write_distributed(const std::string&,
                                                  const std::vector<GlobalIndex>&,
                                                  const std::vector<long long>&, int);
template std::vector<double> CheckpointReader::read_distributed(const std::string&,
                                                                const std::vector<GlobalIndex>&,
                                                                int) const;
template std::vector<long long> CheckpointReader::read_distributed(const std::string&,
                                                                   const std::vector<GlobalIndex>&,
                                                                   int) const;

}  // namespace lockstep
