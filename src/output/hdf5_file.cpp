#include "output/hdf5_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/hdf5_handle.hpp"
#include "output/on_root.hpp"

namespace lockstep {

static_assert(std::is_same_v<hid_t, std::int64_t>);

namespace hdf5 {
namespace {
herr_t keep_description(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc != nullptr)
    *static_cast<std::string*>(text) = error->desc;
  return 0;
}
}  // namespace

std::string last_error() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_description, &text);
  H5Eclear2(H5E_DEFAULT);
  const std::string quote = "error message = '";
  const std::size_t begin = text.find(quote);
  if (begin != std::string::npos) {
    const std::size_t from = begin + quote.size();
    text = text.substr(from, text.find('\'', from) - from);
  }
  return text.empty() ? "HDF5 gives no reason" : text;
}

void silence_errors() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
}  // namespace hdf5

namespace {
/// Runs `action` on rank 0, which alone holds the structure of a file being written.
template <typename Action>
std::string try_on_root(const Communicator& comm, const Action& action) {
  return !is_root(comm) || action() ? "" : hdf5::last_error();
}

hdf5::Handle text_type(std::size_t length) {
  hdf5::Handle type = hdf5::own_type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::string without_padding(const std::string& text) {
  return text.substr(0, std::min(text.find('\0'), text.size()));
}
}  // namespace

Hdf5File::Hdf5File(const Communicator& comm, const std::string& path, bool writing)
    : comm_(comm), path_(path), writing_(writing) {
  hdf5::silence_errors();
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : comm_(other.comm_),
      path_(std::move(other.path_)),
      writing_(other.writing_),
      id_(std::exchange(other.id_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

Hdf5File Hdf5File::create(const Communicator& comm, const std::string& path) {
  Hdf5File file(comm, path, true);
  file.create_file();
  return file;
}

Hdf5File Hdf5File::open(const Communicator& comm, const std::string& path) {
  Hdf5File file(comm, path, false);
  file.open_file();
  return file;
}

void Hdf5File::create_file() {
  const std::string part = part_name(path_);
  const auto open_descriptor = [&](int flags) {
    descriptor_ = ::open(part.c_str(), O_WRONLY | flags, 0666);
    return std::string(descriptor_ < 0 ? std::strerror(errno) : "");
  };
  // The plain call comes first because it gives the shorter reason.
  agree(is_root(comm_) ? open_descriptor(O_CREAT | O_TRUNC) : "", "create it");
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle access = hdf5::own_properties(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    id_ = H5Fcreate(part.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    return id_ >= 0;
  });
  agree(failure, "create it");
  agree(is_root(comm_) ? "" : open_descriptor(0), "create it");
}

void Hdf5File::open_file() {
  const hdf5::Handle access = hdf5::own_properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  id_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access);
  agree(id_ < 0 ? hdf5::last_error() : "", "open it");
}

Hdf5File::~Hdf5File() {
  if (writing_) {
    abandon();
  } else if (id_ >= 0) {
    H5Fclose(id_);
  }
}

void Hdf5File::abandon() noexcept {
  if (descriptor_ < 0)
    return;
  ::close(std::exchange(descriptor_, -1));
  if (!is_root(comm_))
    return;
  // Closing writes what is still in memory, and HDF5 breaks if that fails. On a full disk, giving
  // the space of the unfinished file back lets it pass; else the file stays open until the program
  // ends.
  const bool emptied = truncate(part_name(path_).c_str(), 0) == 0;
  if (id_ >= 0 && emptied && H5Fflush(id_, H5F_SCOPE_GLOBAL) >= 0)
    H5Fclose(id_);
  id_ = -1;
  H5Eclear2(H5E_DEFAULT);
  discard_part(path_);
}

std::string Hdf5File::refusal_to_grow(GlobalIndex n_bytes) const {
  // HDF5 cannot close a file whose end it was unable to reach (a limit of the file size), so this
  // is tried first, with room for the structure. Nobody else writes at this moment.
  constexpr GlobalIndex room_for_structure = 1 << 20;
  struct stat status {};
  hsize_t size = 0;
  H5Fget_filesize(id_, &size);
  const auto wanted = static_cast<off_t>(size) + n_bytes + room_for_structure;
  const bool possible = fstat(descriptor_, &status) == 0 &&
                        (status.st_size >= wanted || (ftruncate(descriptor_, wanted) == 0 &&
                                                      ftruncate(descriptor_, status.st_size) == 0));
  return possible ? "" : std::strerror(errno);
}

void Hdf5File::agree(const std::string& failure, const std::string& action) const {
  std::string message;
  if (!failure.empty()) {
    message = fmt::format("HDF5 file '{}': cannot {}: {}.", path_, action, failure);
    if (failure == std::strerror(ENOSPC))
      message += " Free some space or choose another --output.";
  }
  throw_on_all(comm_, message, static_cast<int>(ExitCode::output_failed));
}

void Hdf5File::close() {
  if (!writing_) {
    H5Fclose(std::exchange(id_, -1));
    return;
  }
  agree(fsync(descriptor_) == 0 ? "" : std::strerror(errno), "write it to its end");
  agree(try_on_root(comm_, [&] { return H5Fflush(id_, H5F_SCOPE_GLOBAL) >= 0; }),
        "write it to its end");
  const std::string failure =
      try_on_root(comm_, [&] { return H5Fclose(std::exchange(id_, -1)) >= 0; });
  agree(failure, "close it");
  ::close(std::exchange(descriptor_, -1));
  on_root(comm_, [&] { commit_part(path_); });
}

void Hdf5File::create_group(const std::string& name) {
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle links = hdf5::own_properties(H5Pcreate(H5P_LINK_CREATE));
    H5Pset_create_intermediate_group(links, 1);
    return hdf5::own_group(H5Gcreate2(id_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT)).valid();
  });
  agree(failure, fmt::format("create the group '{}'", name));
}

bool Hdf5File::exists(const std::string& name) const {
  if (name.empty() || name == "/")
    return true;
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const htri_t found = H5Lexists(id_, name.substr(0, slash).c_str(), H5P_DEFAULT);
    if (found <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    if (slash == std::string::npos)
      return true;
  }
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  const htri_t found = H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT);
  H5Eclear2(H5E_DEFAULT);
  return found > 0;
}

std::vector<std::string> Hdf5File::names(const std::string& group) const {
  std::vector<std::string> result;
  const auto append = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  const herr_t status = H5Literate_by_name(id_, group.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
                                           append, &result, H5P_DEFAULT);
  agree(status < 0 ? hdf5::last_error() : "", fmt::format("list the group '{}'", group));
  return result;
}

void Hdf5File::link_external(const std::string& name, const std::string& file,
                             const std::string& target) {
  const std::string failure = try_on_root(comm_, [&] {
    return H5Lcreate_external(file.c_str(), target.c_str(), id_, name.c_str(), H5P_DEFAULT,
                              H5P_DEFAULT) >= 0;
  });
  agree(failure, fmt::format("link '{}'", name));
}

template <typename T>
void Hdf5File::write_attribute(const std::string& object, const std::string& name, const T& value) {
  hdf5::Handle text;
  hid_t type = H5I_INVALID_HID;
  const void* data = &value;
  std::string failure;
  if constexpr (std::is_same_v<T, std::string>) {
    text = text_type(value.size());
    type = text;
    data = value.c_str();
  } else {
    type = hdf5::native_type<T>();
    if (!std::isfinite(static_cast<double>(value)))
      failure = "it is not a finite number";
  }
  agree(failure, fmt::format("write the attribute '{}'", name));
  failure = try_on_root(comm_, [&] {
    const hdf5::Handle space = hdf5::own_space(H5Screate(H5S_SCALAR));
    const hdf5::Handle owner = hdf5::own_object(H5Oopen(id_, object.c_str(), H5P_DEFAULT));
    const hdf5::Handle attribute =
        hdf5::own_attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
    return attribute.valid() && H5Awrite(attribute, type, data) >= 0;
  });
  agree(failure, fmt::format("write the attribute '{}'", name));
}

template <typename T>
T Hdf5File::read_attribute(const std::string& object, const std::string& name) const {
  T value{};
  const hdf5::Handle attribute = hdf5::own_attribute(
      H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  herr_t status = attribute.valid() ? 0 : -1;
  if (attribute.valid()) {
    if constexpr (std::is_same_v<T, std::string>) {
      const hdf5::Handle type = hdf5::own_type(H5Aget_type(attribute));
      value.resize(H5Tget_size(type));
      status = H5Aread(attribute, type, value.data());
      value = without_padding(value);
    } else {
      status = H5Aread(attribute, hdf5::native_type<T>(), &value);
    }
  }
  agree(status < 0 ? hdf5::last_error() : "",
        fmt::format("read the attribute '{}' of '{}'", name, object));
  return value;
}

void Hdf5File::write_text(const std::string& name, const std::string& text) {
  const auto length = static_cast<GlobalIndex>(text.size());
  agree(is_root(comm_) ? refusal_to_grow(length) : "", fmt::format("write the text '{}'", name));
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle type = text_type(text.size());
    const hdf5::Handle space = hdf5::own_space(H5Screate(H5S_SCALAR));
    const hdf5::Handle dataset = hdf5::own_dataset(
        H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    return dataset.valid() &&
           H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0;
  });
  agree(failure, fmt::format("write the text '{}'", name));
}

std::string Hdf5File::read_text(const std::string& name) const {
  const hdf5::Handle dataset = hdf5::own_dataset(H5Dopen2(id_, name.c_str(), H5P_DEFAULT));
  std::string text;
  bool done = dataset.valid();
  if (done) {
    const hdf5::Handle type = hdf5::own_type(H5Dget_type(dataset));
    text.resize(H5Tget_size(type));
    done = H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
  }
  agree(done ? "" : hdf5::last_error(), fmt::format("read the text '{}'", name));
  return without_padding(text);
}

template void Hdf5File::write_attribute(const std::string&, const std::string&, const double&);
template void Hdf5File::write_attribute(const std::string&, const std::string&, const long long&);
template void Hdf5File::write_attribute(const std::string&, const std::string&, const std::string&);
template double Hdf5File::read_attribute(const std::string&, const std::string&) const;
template long long Hdf5File::read_attribute(const std::string&, const std::string&) const;
template std::string Hdf5File::read_attribute(const std::string&, const std::string&) const;

}  // namespace lockstep
