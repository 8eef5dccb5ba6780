#pragma once
#include <memory>
#include <vector>

#include "grid/strips.hpp"
#include "interfaces/fluid.hpp"
#include "staggered/domain/mac_domain.hpp"
#include "staggered/state/face_table.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

/// The frozen geometry of one instant with the numbering of the pressures. The coupled volumes are
/// those of `coupled`, behind them volumes at prescribed sides (add_covered_sides), those that only
/// gas pushes on, and those of contact patches.
template <int dim>
struct MacGeometry : FluidGeometry<dim> {
  GridState<dim> state;
  /// Pressure unknown of each owned cell and its neighbours, or no_index.
  std::vector<GlobalIndex> unknown;
  /// Coefficients of owned faces and the upper ones of owned cells.
  FaceTable<dim> face_table;
  /// Cells so near to a surface that a link from their faces may meet it; empty without surface.
  std::vector<char> near;
  /// Owned tiles all of whose cells are fluid, with no surface near: their inner faces are free.
  std::vector<char> regular_tiles;
  /// Owned faces with open fraction < 1 and fluid on at least one side.
  std::vector<FaceId> coupled;
  /// rho_0 / rho of stored cells, by the density of their own fluid; empty: all have rho_0.
  std::vector<float> lightness;
  std::vector<FaceId> prescribed;  ///< owned faces of walls and inflows beside fluid
  std::vector<FaceId> band_edge;   ///< owned free faces to fluid at rest beyond the stored tiles
  std::vector<int> bubble;         ///< gas bubble of stored cells, or -1; empty: gas is not trapped

  /// The part of a face through which free fluid flows.
  double open_fraction(int axis, int cell) const {
    return state.faces[axis][cell] == FaceState::free ? face_table(axis, cell).open : 0;
  }
  /// The part of a face through which fluid flows with the face's own velocity, free or prescribed.
  double flux_fraction(int axis, int cell) const {
    const FaceState face = state.faces[axis][cell];
    return face == FaceState::free || face == FaceState::prescribed ? face_table(axis, cell).open
                                                                    : 0;
  }
  /// Mass of the free fluid that moves with a face [kg].
  double mass(int axis, int cell) const {
    return state.faces[axis][cell] == FaceState::free ? face_table(axis, cell).mass : 0;
  }
  /// True if the lower faces of a whole strip of cells, from that one on, are free and regular.
  bool has_regular_faces(int axis, int first) const {
    return face_table.is_regular_tile(axis, first) &&
           is_row_of<dim>(FaceState::free, state.faces[axis].data() + first);
  }
  /// True if all faces of a strip of cells are free and regular, and the cells fluid.
  bool has_regular_faces(const CellStrip<dim>& row) const;
  bool in_bubble(int cell) const { return !bubble.empty() && bubble[cell] >= 0; }
  /// True if the tile of an owned cell is regular.
  bool is_regular(int cell) const { return regular_tiles[TiledGrid<dim>::tile_of(cell)] != 0; }
  bool near_surface(int cell) const { return !near.empty() && near[cell] != 0; }
};

template <int dim>
bool MacGeometry<dim>::has_regular_faces(const CellStrip<dim>& row) const {
  if (row.n != tile_width<dim> || !is_row_of<dim>(CellState::fluid, state.cells.data() + row.begin))
    return false;
  const int after = row.neighbors[1];
  if (after < 0 || !face_table.is_regular_tile(0, after) ||
      state.faces[0][after] != FaceState::free || !has_regular_faces(0, row.begin))
    return false;
  for (int axis = 1; axis < dim; ++axis) {
    const int upper = row.neighbors[2 * axis + 1];
    if (upper < 0 || !has_regular_faces(axis, row.begin) || !has_regular_faces(axis, upper))
      return false;
  }
  return true;
}

/// The closed solid to which a cell without a pressure belongs, with its centre there: the one that
/// holds the centre, or else, where it lies between solids, the nearest; -1 if there is none within
/// a cell. Local.
template <int dim>
int solid_of_cell(const SurfaceSnapshot<dim>& surface, const Point<dim>& center, double spacing);

/// The control volume of a face that is not prescribed; its cells must be stored. `open_fraction`
/// and `seen_by_fluid` are left at 1 and true.
template <int dim>
ControlVolume<dim> control_volume(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                  int axis, int cell);

}  // namespace lockstep
