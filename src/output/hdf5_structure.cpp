#include "output/hdf5_structure.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include "output/atomic_file.hpp"
#include "output/hdf5_handle.hpp"
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace lockstep::hdf5 {

namespace {

constexpr long long page_size = SparseBytes::page_size;

/// An open file as HDF5's driver for files in memory sees it; `head`, HDF5's own part, comes first.
struct MemoryFile {
  H5FD_t head{};
  SparseBytes* bytes = nullptr;
  haddr_t allocated = 0;
};

MemoryFile& of(H5FD_t* file) {
  return *reinterpret_cast<MemoryFile*>(file);
}
const MemoryFile& of(const H5FD_t* file) {
  return *reinterpret_cast<const MemoryFile*>(file);
}

/// Calls visit(page number, first byte within the page, number of bytes, bytes done before).
template <typename Visit>
void for_each_page(long long begin, long long size, const Visit& visit) {
  for (long long done = 0; done < size;) {
    const long long page = (begin + done) / page_size, from = (begin + done) % page_size;
    const long long n = std::min(page_size - from, size - done);
    visit(page, from, n, done);
    done += n;
  }
}

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  auto* file = new (std::nothrow) MemoryFile;
  if (file != nullptr)
    file->bytes = *static_cast<SparseBytes* const*>(H5Pget_driver_info(access));
  return file == nullptr ? nullptr : &file->head;
}

herr_t close_file(H5FD_t* file) {
  of(file).bytes->length = static_cast<long long>(of(file).allocated);
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags =
      H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) {
  return of(file).allocated;
}

herr_t allocate(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).allocated = end;
  return 0;
}

haddr_t end_of(const H5FD_t* file, H5FD_mem_t) {
  return static_cast<haddr_t>(of(file).bytes->end);
}

herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* buffer) {
  const auto& pages = of(file).bytes->pages;
  auto* to = static_cast<char*>(buffer);
  for_each_page(static_cast<long long>(address), static_cast<long long>(size),
                [&](long long page, long long from, long long n, long long done) {
                  const auto found = pages.find(page);
                  if (found == pages.end()) {
                    std::memset(to + done, 0, static_cast<std::size_t>(n));
                  } else {
                    std::memcpy(to + done, found->second.data() + from,
                                static_cast<std::size_t>(n));
                  }
                });
  return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size,
                   const void* buffer) {
  SparseBytes& bytes = *of(file).bytes;
  const auto* data = static_cast<const char*>(buffer);
  try {
    for_each_page(static_cast<long long>(address), static_cast<long long>(size),
                  [&](long long page, long long from, long long n, long long done) {
                    std::memcpy(bytes.pages[page].data() + from, data + done,
                                static_cast<std::size_t>(n));
                  });
  } catch (const std::bad_alloc&) {
    return -1;
  }
  bytes.end = std::max(bytes.end, static_cast<long long>(address + size));
  return 0;
}

/// HDF5's table of functions for such a file.
hid_t driver() {
  static const H5FD_class_t functions = [] {
    H5FD_class_t table{};
#if H5_VERSION_GE(1, 13, 0)
    table.version = H5FD_CLASS_VERSION;
    table.value = static_cast<H5FD_class_value_t>(512);  // the first that is free for anybody
#endif
    table.name = "lockstep";
    table.maxaddr = static_cast<haddr_t>(1) << 62;
    table.fc_degree = H5F_CLOSE_STRONG;
    table.fapl_size = sizeof(SparseBytes*);
    table.open = open_file;
    table.close = close_file;
    table.query = query;
    table.get_eoa = allocated;
    table.set_eoa = allocate;
    table.get_eof = end_of;
    table.read = read_bytes;
    table.write = write_bytes;
    const H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kinds), std::end(kinds), std::begin(table.fl_map));
    return table;
  }();
  static const hid_t id = H5FDregister(&functions);
  return id;
}

}  // namespace

Structure::Structure() : bytes_(std::make_unique<SparseBytes>()) {}

Structure::Structure(Structure&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      bytes_(std::move(other.bytes_)),
      reserved_(std::move(other.reserved_)) {}

Structure::~Structure() {
  if (id_ >= 0)
    H5Fclose(id_);
}

std::string Structure::create() {
  const Handle access = own_properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  SparseBytes* const bytes = bytes_.get();
  if (H5Pset_driver(access, driver(), &bytes) >= 0)
    id_ = H5Fcreate("structure", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  return id_ < 0 ? last_error() : "";
}

std::string Structure::copy_to(int descriptor) {
  if (H5Fclose(std::exchange(id_, -1)) < 0)
    return last_error();
  std::sort(reserved_.begin(), reserved_.end());
  int error = 0;
  for (const auto& [page, bytes] : bytes_->pages) {
    long long next = page * page_size;
    const long long end = std::min(next + page_size, bytes_->length);
    const auto write_until = [&, first = next, data = bytes.data()](long long stop) {
      if (error == 0 && next < stop)
        error = write_fully_at(descriptor, data + (next - first),
                               static_cast<std::size_t>(stop - next), next);
    };
    for (const auto& [offset, n_bytes] : reserved_) {
      write_until(std::min(offset, end));
      next = std::max(next, offset + n_bytes);
    }
    write_until(end);
  }
  if (error == 0 && ftruncate(descriptor, bytes_->length) != 0)
    error = errno;
  return error == 0 ? "" : std::strerror(error);
}

}  // namespace lockstep::hdf5
