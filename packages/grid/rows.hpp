#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <cstring>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// Values for one strip of a tile, its cells along x.
template <int dim>
using RowValues = Eigen::Array<double, tile_width<dim>, 1>;

/// The values of a strip of a field, which must be stored as a whole.
template <int dim>
Eigen::Map<RowValues<dim>> row_of(double* field, int first) {
  return Eigen::Map<RowValues<dim>>(field + first);
}
template <int dim>
Eigen::Map<const RowValues<dim>> row_of(const double* field, int first) {
  return Eigen::Map<const RowValues<dim>>(field + first);
}

/// Values of a strip that one instruction takes.
using RowPart [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES), gnu::may_alias]] = double;
constexpr int row_part_size = EIGEN_MAX_ALIGN_BYTES / sizeof(double);

/// Returns the values from value i on.
template <int n>
RowPart& part_of(Eigen::Array<double, n, 1>& row, int i) {
  return *reinterpret_cast<RowPart*>(row.data() + i);
}
template <int n>
const RowPart& part_of(const Eigen::Array<double, n, 1>& row, int i) {
  return *reinterpret_cast<const RowPart*>(row.data() + i);
}

/// The strip that begins one place later; `last` comes after the strip. A shuffle avoids the stall
/// of values set one by one.
template <int dim>
RowValues<dim> row_ahead(const RowValues<dim>& row, double last) {
  using Places [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES)]] = long long;
  Places next{};
  for (int i = 0; i < row_part_size; ++i)
    next[i] = i + 1;
  RowValues<dim> result;
  for (int i = 0; i < tile_width<dim>; i += row_part_size) {
    const bool is_last = i + row_part_size == tile_width<dim>;
    const RowPart after = is_last ? last + RowPart{} : part_of(row, i + row_part_size);
    part_of(result, i) = __builtin_shuffle(part_of(row, i), after, next);
  }
  return result;
}
/// The strip that begins one place earlier; `first` comes before the strip.
template <int dim>
RowValues<dim> row_behind(const RowValues<dim>& row, double first) {
  using Places [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES)]] = long long;
  Places previous{};
  for (int i = 0; i < row_part_size; ++i)
    previous[i] = row_part_size + i - 1;
  RowValues<dim> result;
  for (int i = 0; i < tile_width<dim>; i += row_part_size) {
    const RowPart before = i == 0 ? first + RowPart{} : part_of(row, i - row_part_size);
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
