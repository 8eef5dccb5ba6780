#pragma once
#include <array>
#include <cstddef>

namespace lockstep {

/// Storage of the cells of one multigrid level on one rank: a box of the level's lattice around its
/// own cells, on distributed levels with the cells of others that it copies (see LatticeLayout) or
/// leaves zero in between, in two colours, colour 0 where i + j + k is even (local coordinates;
/// boxes begin at even ones, so the colours of all ranks agree). Colour c of row (j, k) holds cell
/// i = 2 m + s, s = (j + k + c) & 1, in slot m: the neighbours of a cell then stand in the *same*
/// slot m of the other colour's rows (along x in slots m - 1 + s and m + s), and whole rows are
/// updated by contiguous loops.
///
/// Around the box lies one layer of slots, where copies through periodic sides are on levels that
/// every rank holds whole; what is no cell stays zero. Set-up works
/// on *natural* arrays: the box and its ghost layer, x fastest.
struct LevelGrid {
  int dimension = 3;
  std::array<int, 3> begin{};     ///< lattice coordinates of the first cell
  std::array<int, 3> n{1, 1, 1};  ///< cells of the box
  bool is_distributed = false;    ///< else every rank holds the whole level
  int margin = 0;                 ///< slots before the first and after the last of a row
  std::ptrdiff_t row_stride = 0;  ///< in slots
  std::ptrdiff_t plane_stride = 0;
  std::ptrdiff_t n_slots = 0;  ///< slots of one colour
  std::ptrdiff_t first = 0;    ///< slot of (m, j, k) = 0

  std::array<std::ptrdiff_t, 3> natural_stride{1, 0, 0};
  std::ptrdiff_t natural_first = 0;  ///< natural index of cell (0, 0, 0)
  std::ptrdiff_t n_natural = 0;

  /// Chooses the strides for `begin` and `n`. `ghosts_in_x`: rows have ghost cells at their ends.
  void set_strides(bool ghosts_in_x);

  int last_axis() const { return dimension - 1; }
  /// Slabs are what sweeps go through one after another: planes in 3D, rows in 2D.
  int n_slabs() const { return n[last_axis()]; }
  int n_rows() const { return n[1] * n[2]; }
  bool empty() const { return n[0] == 0 || n[1] == 0 || n[2] == 0; }

  std::ptrdiff_t slot(int m, int j, int k) const {
    return first + m + row_stride * j + plane_stride * k;
  }
  static int colour(int i, int j, int k) { return (i + j + k) & 1; }
  /// Slot of cell (i, j, k) in its colour; those around the box have coordinates -1 and n.
  std::ptrdiff_t slot_of_cell(int i, int j, int k) const { return slot(i >> 1, j, k); }
  std::ptrdiff_t natural(int i, int j, int k) const {
    return natural_first + i + natural_stride[1] * j + natural_stride[2] * k;
  }
};

}  // namespace lockstep
