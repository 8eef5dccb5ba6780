#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <cstring>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// Values for one row of a tile, along x.
template <int dim>
using RowValues = Eigen::Array<double, tile_width<dim>, 1>;

/// The values of a row, of which there is storage for the whole.
template <int dim>
Eigen::Map<RowValues<dim>> row_of(double* field, int first) {
  return Eigen::Map<RowValues<dim>>(field + first);
}
template <int dim>
Eigen::Map<const RowValues<dim>> row_of(const double* field, int first) {
  return Eigen::Map<const RowValues<dim>>(field + first);
}

/// Whether a whole row of states, from there on, is this one.
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
