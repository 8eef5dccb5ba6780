// Opening, closing and the structure of an Hdf5File; its datasets are written and read in
// hdf5_datasets.cpp.
#include "output/hdf5_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "output/atomic_file.hpp"
#include "output/checksum.hpp"
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

}  // namespace

Hdf5File::Hdf5File(const Communicator& comm, const std::string& path, bool writing)
    : comm_(comm), path_(path), writing_(writing) {
  hdf5::silence_errors();
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : comm_(other.comm_),
      path_(std::move(other.path_)),
      group_(std::move(other.group_)),
      writing_(other.writing_),
      id_(std::exchange(other.id_, -1)),
      structure_(std::move(other.structure_)),
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
  std::string failure;
  if (is_root(comm_))
    descriptor_ = open_part(path_, failure);
  agree(failure, "create it");
  agree(is_root(comm_) ? structure_.create() : "", "create it");
  if (!is_root(comm_)) {
    descriptor_ = ::open(part_name(path_).c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    failure = descriptor_ < 0 ? std::strerror(errno) : "";
  }
  agree(failure, "create it");
}

void Hdf5File::open_file() {
  agree(refusal_to_read(path_), "open it");
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
  if (is_root(comm_))
    discard_part(path_);
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

void Hdf5File::commit() {
  ::close(std::exchange(descriptor_, -1));
  on_root(comm_, [&] { commit_part(path_); });
}

void Hdf5File::finish_part() {
  agree(is_root(comm_) ? structure_.copy_to(descriptor_) : "", "write it to its end");
  agree(fsync(descriptor_) == 0 ? "" : std::strerror(errno), "write it to its end");
}

void Hdf5File::close() {
  if (!writing_) {
    H5Fclose(std::exchange(id_, -1));
    return;
  }
  finish_part();
  commit();
}

void Hdf5File::close_with_checksum() {
  finish_part();
  append_checksum(comm_, part_name(path_));
  commit();
}

std::string Hdf5File::inside(const std::string& name) const {
  if (group_.empty())
    return name;
  const std::size_t begin = name.find_first_not_of('/');
  return begin == std::string::npos ? group_ : group_ + "/" + name.substr(begin);
}

void Hdf5File::create_group(const std::string& name) {
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle links = hdf5::own_properties(H5Pcreate(H5P_LINK_CREATE));
    H5Pset_create_intermediate_group(links, 1);
    return hdf5::own_group(H5Gcreate2(id(), inside(name).c_str(), links, H5P_DEFAULT, H5P_DEFAULT))
        .valid();
  });
  agree(failure, fmt::format("create the group '{}'", name));
}

void Hdf5File::link_external(const std::string& name, const std::string& file,
                             const std::string& target) {
  const std::string failure = try_on_root(comm_, [&] {
    return H5Lcreate_external(file.c_str(), target.c_str(), id(), inside(name).c_str(), H5P_DEFAULT,
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
  create_attribute(object, name, type, data);
}

void Hdf5File::write_text_attribute(const std::string& object, const std::string& name,
                                    const std::string& text) {
  const hdf5::Handle type = text_type(H5T_VARIABLE);
  const char* const data = text.c_str();
  create_attribute(object, name, type, &data);
}

void Hdf5File::create_attribute(const std::string& object, const std::string& name,
                                std::int64_t type, const void* data) {
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle space = hdf5::own_space(H5Screate(H5S_SCALAR));
    const hdf5::Handle owner = hdf5::own_object(H5Oopen(id(), inside(object).c_str(), H5P_DEFAULT));
    const hdf5::Handle attribute =
        hdf5::own_attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
    return attribute.valid() && H5Awrite(attribute, type, data) >= 0;
  });
  agree(failure, fmt::format("write the attribute '{}'", name));
}

void Hdf5File::write_text(const std::string& name, const std::string& text) {
  const std::string failure = try_on_root(comm_, [&] {
    const hdf5::Handle type = text_type(text.size());
    const hdf5::Handle space = hdf5::own_space(H5Screate(H5S_SCALAR));
    const hdf5::Handle dataset = hdf5::own_dataset(
        H5Dcreate2(id(), inside(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    return dataset.valid() &&
           H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0;
  });
  agree(failure, fmt::format("write the text '{}'", name));
}

template void Hdf5File::write_attribute(const std::string&, const std::string&, const double&);
template void Hdf5File::write_attribute(const std::string&, const std::string&, const long long&);
template void Hdf5File::write_attribute(const std::string&, const std::string&, const std::string&);

}  // namespace lockstep
