#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <cstring>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// Values for one strip of a tile, its cells along x.
template <int dim>
using StripValues = Eigen::Array<double, tile_width<dim>, 1>;

/// The values of a strip of a field, which must be stored as a whole.
template <int dim>
Eigen::Map<StripValues<dim>> row_of(double* field, int first) {
  return Eigen::Map<StripValues<dim>>(field + first);
}
template <int dim>
Eigen::Map<const StripValues<dim>> row_of(const double* field, int first) {
  return Eigen::Map<const StripValues<dim>>(field + first);
}

/// Values of a strip that one instruction takes.
using StripPart [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES), gnu::may_alias]] = double;
constexpr int strip_part_size = EIGEN_MAX_ALIGN_BYTES / sizeof(double);

/// Returns the values from value i on.
template <int n>
StripPart& part_of(Eigen::Array<double, n, 1>& row, int i) {
  return *reinterpret_cast<StripPart*>(row.data() + i);
}
template <int n>
const StripPart& part_of(const Eigen::Array<double, n, 1>& row, int i) {
  return *reinterpret_cast<const StripPart*>(row.data() + i);
}

/// The strip that begins one place later; `last` comes after the strip. A shuffle avoids the stall
/// of values set one by one.
template <int dim>
StripValues<dim> row_ahead(const StripValues<dim>& row, double last) {
  using Places [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES)]] = long long;
  Places next{};
  for (int i = 0; i < strip_part_size; ++i)
    next[i] = i + 1;
  StripValues<dim> result;
  for (int i = 0; i < tile_width<dim>; i += strip_part_size) {
    const bool is_last = i + strip_part_size == tile_width<dim>;
    const StripPart after = is_last ? last + StripPart{} : part_of(row, i + strip_part_size);
    part_of(result, i) = __builtin_shuffle(part_of(row, i), after, next);
  }
  return result;
}
/// The strip that begins one place earlier; `first` comes before the strip.
template <int dim>
StripValues<dim> row_behind(const StripValues<dim>& row, double first) {
  using Places [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES)]] = long long;
  Places previous{};
  for (int i = 0; i < strip_part_size; ++i)
    previous[i] = strip_part_size + i - 1;
  StripValues<dim> result;
  for (int i = 0; i < tile_width<dim>; i += strip_part_size) {
    const StripPart before = i == 0 ? first + StripPart{} : part_of(row, i - strip_part_size);
    part_of(result, i) = __builtin_shuffle(before, part_of(row, i), previous);
  }
  return result;
}

/// True if a whole strip of states, from there on, is this one.
template <int dim, typename State>
bool is_row_of(State state, const State* states) {
  static_assert(sizeof(State) == 1 && tile_width<dim> % 8 == 0);
  const std::uint64_t wanted = 0x0101010101010101U * static_cast<unsigned char>(state);
  for (int i = 0; i < tile_width<dim>; i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, states + i, sizeof eight);
    if (eight != wanted)
      return false;
  }
  return true;
}

}  // namespace lockstep
