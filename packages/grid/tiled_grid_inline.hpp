#pragma once
// The inner loops of TiledGrid, inline; included by tiled_grid.hpp only.
#include <cmath>

#include "grid/tiled_grid.hpp"

namespace lockstep {

template <int dim>
inline Index<dim> TiledGrid<dim>::coordinates(int cell) const {
  Index<dim> c = tiles_[tile_of(cell)].begin;
  for (int a = 0; a < dim; ++a)
    c[a] += local(cell, a);
  return c;
}

template <int dim>
inline int TiledGrid<dim>::find_tile(const Index<dim>& tile) const {
  int entry = 0;
  for (int a = dim - 1; a >= 0; --a) {
    const int t = tile[a] - directory_lower_[a];
    if (t < 0 || t >= directory_size_[a])
      return -1;
    entry = entry * directory_size_[a] + t;
  }
  return directory_[entry];
}

template <int dim>
inline int TiledGrid<dim>::cell(const Index<dim>& coordinates) const {
  Index<dim> tile{};
  int offset = 0;
  for (int a = 0; a < dim; ++a) {
    const int n = lattice_.n_cells()[a];
    int c = coordinates[a];
    if (c < 0 || c >= n) {
      if (!description().periodic[a])
        return -1;
      c %= n;
      if (c < 0)
        c += n;
    }
    tile[a] = c >> log_width;
    offset += (c & (tile_width<dim> - 1)) << (log_width * a);
  }
  const int t = find_tile(tile);
  return t < 0 ? -1 : (t << log_tile_volume<dim>)+offset;
}

template <int dim>
inline int TiledGrid<dim>::neighbor(int cell, int axis, int side) const {
  LOCKSTEP_ASSERT(in_lattice(cell));
  return neighbor_in_lattice(tiles_[tile_of(cell)], cell, axis, side);
}

template <int dim>
inline int TiledGrid<dim>::neighbor_in_lattice(const Tile& tile, int cell, int axis,
                                               int side) const {
  const int position = local(cell, axis);
  if (side == 0) {
    if (position > 0)
      return cell - stride(axis);
  } else {
    if (position + 1 < tile.extent[axis])
      return cell + stride(axis);
  }
  const int other = tile.neighbors[2 * axis + side];
  if (other < 0)
    return -1;
  const int entry = side == 0 ? tiles_[other].extent[axis] - 1 : 0;
  const int offset = cell & (tile_volume<dim> - 1);
  return (other << log_tile_volume<dim>)+offset + (entry - position) * stride(axis);
}

template <int dim>
inline bool TiledGrid<dim>::in_domain(int cell) const {
  const Tile& tile = tiles_[tile_of(cell)];
  for (int a = 0; a < dim; ++a)
    if (local(cell, a) >= tile.domain_extent[a])
      return false;
  return true;
}

template <int dim>
inline bool TiledGrid<dim>::in_domain(const Index<dim>& coordinates) const {
  for (int a = 0; a < dim; ++a)
    if (coordinates[a] < 0 || coordinates[a] >= n_cells()[a])
      return false;
  return true;
}

template <int dim>
inline bool TiledGrid<dim>::in_lattice(int cell) const {
  const Tile& tile = tiles_[tile_of(cell)];
  for (int a = 0; a < dim; ++a)
    if (local(cell, a) >= tile.extent[a])
      return false;
  return true;
}

template <int dim>
inline GlobalIndex TiledGrid<dim>::global_id(int cell) const {
  LOCKSTEP_ASSERT(in_lattice(cell));
  const Index<dim> c = coordinates(cell);
  GlobalIndex id = 0;
  for (int a = dim - 1; a >= 0; --a)
    id = id * lattice_.n_cells()[a] + c[a];
  return id;
}

template <int dim>
inline Point<dim> TiledGrid<dim>::face_center(int axis, int cell) const {
  const Index<dim> c = coordinates(cell);
  Point<dim> x = lattice().center(c);
  x[axis] = lower()[axis] + c[axis] * spacing();
  return x;
}

template <int dim>
inline Point<dim> TiledGrid<dim>::wrap(const Point<dim>& x) const {
  Point<dim> wrapped = x;
  for (int a = 0; a < dim; ++a) {
    if (!description().periodic[a])
      continue;
    const double length = n_cells()[a] * spacing();
    wrapped[a] -= length * std::floor((x[a] - lower()[a]) / length);
  }
  return wrapped;
}

template <int dim>
inline int TiledGrid<dim>::cell_containing(const Point<dim>& x) const {
  const Point<dim> wrapped = wrap(x);
  Index<dim> c{};
  for (int a = 0; a < dim; ++a) {
    const double position = (wrapped[a] - lower()[a]) / spacing();
    // Rounding may leave a wrapped point a hair below or at the end of the period: one cell of
    // margin.
    if (!(position > -1 && position < lattice_.n_cells()[a] + 1))
      return -1;
    c[a] = static_cast<int>(std::floor(position));
  }
  return cell(c);
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_offset(const Index<dim>& extent, const Function& f) {
  if constexpr (dim == 2) {
    for (int y = 0; y < extent[1]; ++y)
      for (int x = 0; x < extent[0]; ++x)
        f(y * stride(1) + x);
  } else {
    for (int z = 0; z < extent[2]; ++z)
      for (int y = 0; y < extent[1]; ++y)
        for (int x = 0; x < extent[0]; ++x)
          f(z * stride(2) + y * stride(1) + x);
  }
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_cell_of_tiles(int begin, int end, const Function& f) const {
  for (int t = begin; t < end; ++t) {
    const int first = t << log_tile_volume<dim>;
    for_each_offset(tiles_[t].domain_extent, [&](int offset) { f(first + offset); });
  }
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_owned_face(int axis, const Function& f) const {
  for_each_owned_face_row(axis, [&](int first, int n, int) {
    for (int face = first; face < first + n; ++face)
      f(face);
  });
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_owned_face_row(int axis, const Function& f) const {
  for (int t = 0; t < n_owned_tiles_; ++t) {
    const Tile& tile = tiles_[t];
    Index<dim> extent = tile.domain_extent;
    extent[axis] = tile.extent[axis];
    const int n = extent[0];
    if (n == 0)
      continue;
    extent[0] = 1;
    const int first = t << log_tile_volume<dim>;
    for_each_offset(extent, [&](int offset) {
      f(first + offset, n, neighbor_in_lattice(tile, first + offset, axis, 0));
    });
  }
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_owned_strip(const Function& f) const {
  for (int t = 0; t < n_owned_tiles_; ++t) {
    Index<dim> rows = tiles_[t].domain_extent;
    const int n = rows[0];
    if (n == 0)
      continue;
    rows[0] = 1;
    const int first = t << log_tile_volume<dim>;
    for_each_offset(rows, [&](int offset) {
      CellStrip<dim> row;
      row.begin = first + offset;
      row.n = n;
      row.neighbors[0] = neighbor_in_lattice(tiles_[t], row.begin, 0, 0);
      row.neighbors[1] = neighbor_in_lattice(tiles_[t], row.begin + n - 1, 0, 1);
      for (int i = 2; i < 2 * dim; ++i)
        row.neighbors[i] = neighbor_in_lattice(tiles_[t], row.begin, i / 2, i % 2);
      f(row);
    });
  }
}

template <int dim>
template <typename Function>
inline void CellStrip<dim>::for_each_cell(const Function& f) const {
  std::array<int, 2 * dim> step{};
  for (int i = 2; i < 2 * dim; ++i)
    step[i] = neighbors[i] >= 0 ? 1 : 0;
  for (int x = 0; x < n; ++x) {
    std::array<int, 2 * dim> of_cell{};
    of_cell[0] = x > 0 ? begin + x - 1 : neighbors[0];
    of_cell[1] = x < n - 1 ? begin + x + 1 : neighbors[1];
    for (int i = 2; i < 2 * dim; ++i)
      of_cell[i] = neighbors[i] + step[i] * x;
    f(begin + x, of_cell);
  }
}

template <int dim>
template <typename Function>
inline void TiledGrid<dim>::for_each_owned_cell_with_neighbors(const Function& f) const {
  for_each_owned_strip([&](const CellStrip<dim>& row) { row.for_each_cell(f); });
}

}  // namespace lockstep
