#pragma once
#include <hdf5.h>

#include <string>
#include <utility>

/// Owners of HDF5 identifiers, and HDF5's error text, for the .cpp files of this room.
namespace lockstep::hdf5 {

/// Owns one HDF5 identifier and closes it with the function of its kind.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }

  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// False if HDF5 reports that closing (and the writing it entails) failed.
  bool close() {
    if (!valid())
      return true;
    return closer_(std::exchange(id_, H5I_INVALID_HID)) >= 0;
  }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Closer closer_ = nullptr;
};

inline Handle own_dataset(hid_t id) {
  return {id, H5Dclose};
}
inline Handle own_space(hid_t id) {
  return {id, H5Sclose};
}
inline Handle own_properties(hid_t id) {
  return {id, H5Pclose};
}
inline Handle own_attribute(hid_t id) {
  return {id, H5Aclose};
}
inline Handle own_group(hid_t id) {
  return {id, H5Gclose};
}
inline Handle own_object(hid_t id) {
  return {id, H5Oclose};
}
inline Handle own_type(hid_t id) {
  return {id, H5Tclose};
}

/// The innermost description on HDF5's error stack, where the reason stands; clears the stack.
std::string last_error();
/// Keeps HDF5 from printing its error stack; to be called before anything else.
void silence_errors();

template <typename T>
hid_t native_type();
template <>
inline hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native_type<int>() {
  return H5T_NATIVE_INT;
}
template <>
inline hid_t native_type<long long>() {
  return H5T_NATIVE_LLONG;
}

}  // namespace lockstep::hdf5
