#include "output/hdf5_probe.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

#include "base/regular_file.hpp"
#include "output/hdf5_handle.hpp"

namespace lockstep {

namespace {

constexpr double largest_table = 1e9;  // bytes of a dataset that is tried
constexpr unsigned longest_time = 60;  // [s]

/// Bytes of all values together.
double n_bytes_of(hid_t type, hid_t space) {
  return static_cast<double>(H5Tget_size(type)) *
         static_cast<double>(H5Sget_simple_extent_npoints(space));
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t*, void*) {
  const hdf5::Handle attribute = hdf5::own_attribute(H5Aopen(object, name, H5P_DEFAULT));
  const hdf5::Handle type = hdf5::own_type(H5Aget_type(attribute));
  const hdf5::Handle space = hdf5::own_space(H5Aget_space(attribute));
  const double n_bytes = n_bytes_of(type, space);
  if (!type.valid() || !space.valid() || n_bytes > largest_table)
    return -1;
  std::vector<char> values(static_cast<std::size_t>(n_bytes) + 1);
  return H5Aread(attribute, type, values.data());
}

herr_t read_dataset(hid_t dataset) {
  const hdf5::Handle type = hdf5::own_type(H5Dget_type(dataset));
  const hdf5::Handle space = hdf5::own_space(H5Dget_space(dataset));
  const double n_bytes = n_bytes_of(type, space);
  if (!type.valid() || !space.valid() || n_bytes > largest_table)
    return -1;
  std::vector<char> values(static_cast<std::size_t>(n_bytes) + 1);
  return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* info, void*) {
  const hdf5::Handle object = hdf5::own_object(H5Oopen(file, name, H5P_DEFAULT));
  if (!object.valid())
    return -1;
  hsize_t first = 0;
  if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &first, read_attribute, nullptr) < 0)
    return -1;
  return info->type == H5O_TYPE_DATASET ? read_dataset(object) : 0;
}

/// In the child, which ends here without any of the clean-up that belongs to its parent.
[[noreturn]] void read_everything(const std::string& path) {
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGALRM})
    std::signal(number, SIG_DFL);
  // Last words of libraries are not for the user.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  alarm(longest_time);
  hdf5::silence_errors();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  haddr_t end = 0;
  struct stat status {};
  // The file has more bytes than HDF5 has written: a checksum that is none any more.
  const bool done = file >= 0 && H5Fget_eoa(file, &end) >= 0 && stat(path.c_str(), &status) == 0 &&
                    static_cast<haddr_t>(status.st_size) <= end &&
                    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, read_object, nullptr) >= 0;
  _exit(done ? 0 : 1);
}

}  // namespace

std::string refusal_of_hdf5(const std::string& path) {
  const std::string refusal = refusal_to_read(path);
  if (!refusal.empty())
    return refusal;
  const pid_t child = fork();
  if (child < 0)
    return std::strerror(errno);
  if (child == 0)
    read_everything(path);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR)
      return std::strerror(errno);
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? "" : "HDF5 cannot read all of it";
}

}  // namespace lockstep
