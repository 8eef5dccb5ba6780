#include "output/frames.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/on_root.hpp"
#include "output/xdmf.hpp"

namespace lockstep {

namespace fs = std::filesystem;

namespace {
Communicator serial_communicator() {
  return Teuchos::rcp(new Teuchos::SerialComm<int>());
}

std::string frame_name(long long number) {
  return fmt::format("frame-{:06}", number);
}
/// Relative to the output folder.
std::string frame_file(long long number) {
  return "frames/" + frame_name(number) + ".h5";
}

/// Vectors get three components, because ParaView knows no others.
std::vector<double> padded(const std::vector<double>& values, int n_components) {
  std::vector<double> result;
  const std::size_t n = values.size() / n_components;
  result.reserve(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) {
      result.push_back(c < n_components ? values[i * n_components + c] : 0.0);
    }
  }
  return result;
}

/// Frames are removed from this folder, so that it must not be a link to another.
void make_folder(const std::string& path) {
  check_output(!fs::is_symlink(path), "'{}' is a link, but must be a folder: remove it.", path);
  fs::create_directories(path);
}

}  // namespace

FrameWriter::FrameWriter(const Communicator& comm, const std::string& directory,
                         const BoxStorage& storage)
    : comm_(comm), directory_(directory), storage_(storage) {
  check_input(storage.compression_level >= 0 && storage.compression_level <= 9,
              "The compression level of frames is {}; it must lie between 0 and 9.",
              storage.compression_level);
}

std::string FrameWriter::frame_path(long long number) const {
  return directory_ + "/" + frame_file(number);
}

void FrameWriter::start() {
  on_root(comm_, [&] {
    make_folder(directory_ + "/frames");
    entries_.clear();
    write_index();
    for (const fs::path& file : frame_files()) {
      fs::remove(file);
    }
  });
  share_state();
}

void FrameWriter::resume(double time) {
  on_root(comm_, [&] {
    make_folder(directory_ + "/frames");
    entries_ = find_entries();
    const auto later = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& entry) { return entry.time > time; });
    const std::vector<Entry> dropped(later, entries_.end());
    entries_.erase(later, entries_.end());
    write_index();
    for (const Entry& entry : dropped) {
      fs::remove(frame_path(entry.number));
    }
  });
  share_state();
}

std::vector<fs::path> FrameWriter::frame_files() const {
  std::vector<fs::path> files;
  for (const fs::directory_entry& item : fs::directory_iterator(directory_ + "/frames")) {
    const std::string name = item.path().filename();
    if (item.path().extension() == ".part") {
      fs::remove(item.path());
    } else if (name.rfind("frame-", 0) == 0 && item.path().extension() == ".h5") {
      files.push_back(item.path());
    }
  }
  return files;
}

std::vector<FrameWriter::Entry> FrameWriter::find_entries() const {
  std::vector<Entry> found;
  for (const fs::path& path : frame_files()) {
    const Hdf5File file = Hdf5File::open(serial_communicator(), path);
    found.push_back({file.read_attribute<long long>("/", "number"),
                     file.read_attribute<long long>("/", "step"),
                     file.read_attribute<double>("/", "time"), file.read_text("xdmf")});
  }
  std::sort(found.begin(), found.end(),
            [](const Entry& a, const Entry& b) { return a.time < b.time; });
  return found;
}

void FrameWriter::write(long long step, double time, const std::vector<BoxFrame>& boxes,
                        const std::vector<SurfaceFrame>& surfaces) {
  check_output(time > last_time_, "Frame at {} s is not later than the last one at {} s.", time,
               last_time_);
  Hdf5File file = Hdf5File::create(comm_, frame_path(next_number_));
  file.write_attribute<long long>("/", "number", next_number_);
  file.write_attribute<double>("/", "time", time);
  file.write_attribute<long long>("/", "step", step);
  write_origin(file, origin_);
  const std::string relative = frame_file(next_number_);
  std::string grids;
  for (const BoxFrame& box : boxes) {
    write_box(file, box);
    grids += xdmf::box_grid(box, relative, storage_.precision);
  }
  for (const SurfaceFrame& surface : surfaces) {
    write_surface(file, surface);
    grids += xdmf::surface_grid(surface, relative, storage_.precision);
  }
  const std::string xdmf_text = xdmf::frame(time, grids);
  file.write_text("xdmf", xdmf_text);
  file.close();
  on_root(comm_, [&] {
    entries_.push_back({next_number_, step, time, xdmf_text});
    write_index();
  });
  share_state();
}

void FrameWriter::write_box(Hdf5File& file, const BoxFrame& box) const {
  const std::string group = "/" + xdmf::stored_name(box.name);
  file.create_group(group);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    file.write_attribute<double>(group, "origin_" + letter, box.origin[axis]);
    file.write_attribute<double>(group, "spacing_" + letter, box.spacing[axis]);
  }
  std::size_t n_cells = 0;
  for (const CellBlock& block : box.blocks) {
    n_cells += std::size_t(block.size[0]) * block.size[1] * block.size[2];
  }
  for (const BoxField& field : box.fields) {
    std::vector<double> values(n_cells * field.n_components);
    double* next = values.data();
    for (std::size_t i = 0; i < box.blocks.size(); ++i) {
      const CellBlock& block = box.blocks[i];
      field.fill(i, next);
      next += std::size_t(block.size[0]) * block.size[1] * block.size[2] * field.n_components;
    }
    const std::string dataset = group + "/" + xdmf::stored_name(field.name);
    file.write_box(dataset, box.n_cells, field.n_components, box.blocks, values, storage_);
    file.write_attribute<std::string>(dataset, "unit", field.unit);
  }
}

void FrameWriter::write_surface(Hdf5File& file, const SurfaceFrame& surface) const {
  const std::string group = "/solids/" + xdmf::stored_name(surface.name);
  file.create_group(group);
  file.write_replicated(group + "/vertices", padded(surface.vertices, surface.dimension), 3);
  file.write_attribute<std::string>(group + "/vertices", "unit", "m");
  file.write_replicated(group + "/simplices", surface.simplices, surface.simplex_size);
  for (const SurfaceField& field : surface.fields) {
    const std::size_t n_entities = field.place == SurfaceField::Place::vertices
                                       ? surface.vertices.size() / surface.dimension
                                       : surface.simplices.size() / surface.simplex_size;
    const bool fits = !is_root(comm_) || field.values.size() == n_entities * field.n_components;
    throw_on_all(comm_,
                 fits ? ""
                      : fmt::format("Field '{}' of surface '{}' has {} values for {} places.",
                                    field.name, surface.name, field.values.size(), n_entities),
                 static_cast<int>(ExitCode::output_failed));
    const std::string dataset = group + "/" + xdmf::stored_name(field.name);
    const bool is_vector = field.n_components == 2 || field.n_components == 3;
    file.write_replicated(dataset,
                          is_vector ? padded(field.values, field.n_components) : field.values,
                          is_vector ? 3 : field.n_components, storage_.precision);
    file.write_attribute<std::string>(dataset, "unit", field.unit);
  }
}

void FrameWriter::write_index() const {
  std::vector<double> times;
  std::vector<long long> steps;
  std::string grids;
  Hdf5File index = Hdf5File::create(serial_communicator(), directory_ + "/frames.h5");
  write_origin(index, origin_);
  for (const Entry& entry : entries_) {
    times.push_back(entry.time);
    steps.push_back(entry.step);
    grids += entry.xdmf;
    index.link_external(frame_name(entry.number), frame_file(entry.number), "/");
  }
  index.write_replicated("times", times);
  index.write_attribute<std::string>("times", "unit", "s");
  index.write_replicated("steps", steps);
  index.close();
  write_file_atomically(directory_ + "/frames.xmf", xdmf::document(grids));
}

void FrameWriter::share_state() {
  const bool empty = entries_.empty();
  double state[3] = {static_cast<double>(entries_.size()),
                     empty ? 0.0 : static_cast<double>(entries_.back().number + 1),
                     empty ? -std::numeric_limits<double>::infinity() : entries_.back().time};
  MPI_Bcast(state, 3, MPI_DOUBLE, 0, raw_communicator(comm_));
  n_frames_ = static_cast<int>(state[0]);
  next_number_ = static_cast<long long>(state[1]);
  last_time_ = state[2];
}

}  // namespace lockstep
