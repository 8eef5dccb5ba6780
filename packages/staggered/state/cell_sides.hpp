#pragma once
#include <cstdint>

#include "staggered/state/surface_marks.hpp"

namespace lockstep {

/// The side of the surface on which each cut cell has its fluid. A cell has one pressure; a thin
/// wall through it leaves fluid on two sides, of which one must be closed off or the wall leaks.
///
/// A side is a set of corners joined by edges of the cell that no surface crosses. The side of a
/// cell is the one that its centre sees; if its centre is inside a solid, that with most corners,
/// and none of two that have as many. Two cells are joined where their sides share a corner of the
/// face, or their centres see each other. Every path from cell to cell is then a path along lines
/// that meet no surface: walls are tight at any angle and thickness, and gaps in which no such line
/// runs are closed.
template <int dim>
class CellSides {
 public:
  /// `cells` are solid where their centres are. Collective.
  CellSides(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
            const SurfaceMarks<dim>& marks, const std::vector<CellState>& cells);

  /// True if the fluid of the cells beside an owned face is on one side there. Local.
  bool joined(int axis, int cell) const;

 private:
  static constexpr int n_corners = 1 << dim;
  using Components = std::array<int, n_corners>;
  using Line = typename LatticeCrossings<dim>::Line;

  void mark_line(int axis, const Line& line);
  template <typename Bit>
  void mark_around(const Index<dim>& corner, const Bit& bit_of);
  Point<dim> corner(int cell, int corner) const;
  bool sees(int cell, int corner) const;
  bool is_uncut(int cell, const Index<dim>& place, int axis, int corner) const;
  Components components(int cell) const;
  void join_around(int cell, Components& of_corner) const;
  int side_of(int cell) const;
  bool center_is_on_side(int cell) const;

  const MacDomain<dim>& domain_;
  const SurfaceSnapshot<dim>& surface_;
  const SurfaceMarks<dim>& marks_;
  const std::vector<CellState>& cells_;
  Lattice<dim> lattice_;  ///< its "centres" are the corners of the cells, moved by next to nothing
  /// By cell: corners inside a closed solid (bit 2^dim numbers, bit k of which is the end along
  /// axis k), and edges that a surface crosses (by axis and lower corner).
  std::vector<std::uint32_t> cuts_;
  std::vector<char> side_;  ///< by cell: the corners of its side
};

}  // namespace lockstep
