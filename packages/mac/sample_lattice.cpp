#include "mac/sample_lattice.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
SampleLattice<dim>::SampleLattice(const TiledGrid<dim>& grid)
    : n_cells_(grid.n_cells()), periodic_(grid.description().periodic) {
  constexpr int log_width = log_tile_width<dim>;
  Index<dim> lower{}, upper{};
  for (int tile = 0; tile < grid.n_tiles(); ++tile)
    for (int a = 0; a < dim; ++a) {
      const int t = grid.tile_begin(tile)[a] >> log_width;
      lower[a] = tile == 0 ? t : std::min(lower[a], t);
      upper[a] = tile == 0 ? t : std::max(upper[a], t);
    }
  int size = 1;
  for (int a = 0; a < dim; ++a) {
    virtual_wall_[a] = !periodic_[a] && !grid.description().store_upper_face[a];
    table_lower_[a] = lower[a] - 1;
    table_size_[a] = upper[a] - lower[a] + 3;
    table_stride_[a] = size;
    size *= table_size_[a];
  }
  table_.assign(size, -1);
  for (int tile = 0; tile < grid.n_tiles(); ++tile) {
    int place = 0;
    for (int a = 0; a < dim; ++a)
      place += ((grid.tile_begin(tile)[a] >> log_width) - table_lower_[a]) * table_stride_[a];
    table_[place] = tile;
  }
}

template <int dim>
std::array<StencilCorner<dim>, (1 << dim)> SampleLattice<dim>::corners(SampleKind kind,
                                                                       const Point<dim>& x) const {
  const Stencil<dim> stencil = locate(kind, x);
  const Point<dim> offset = sample_offset<dim>(kind);
  std::array<StencilCorner<dim>, (1 << dim)> result;
  for (int k = 0; k < 1 << dim; ++k) {
    StencilCorner<dim>& corner = result[k];
    corner.id = stencil.id[k];
    corner.weight = 1;
    for (int a = 0; a < dim; ++a) {
      const int upper = (k >> a) & 1;
      int i = static_cast<int>(std::floor(x[a] - offset[a])) + upper;
      if (!periodic_[a])
        i = resolve(a, a == kind, i);
      corner.position[a] = i + offset[a];
      corner.weight *= upper ? stencil.weight[a] : 1 - stencil.weight[a];
    }
  }
  return result;
}

template <int dim>
bool SampleLattice<dim>::find_block(SampleKind kind, const Index<dim>& begin, int width,
                                    std::vector<int>& ids) const {
  constexpr int log_width = log_tile_width<dim>;
  // Shares of each coordinate in the tile table and in the offset within the tile.
  std::array<std::vector<int>, dim> tile, offset;
  std::array<std::vector<char>, dim> at_wall;
  int n_rows = 1;
  for (int a = 0; a < dim; ++a) {
    for (int k = 0; k < width; ++k) {
      const int i = resolve(a, a == kind, begin[a] + k);
      tile[a].push_back(table_share(a, i));
      offset[a].push_back((i & (tile_width<dim> - 1)) << (log_width * a));
      at_wall[a].push_back(a == kind && virtual_wall_[a] && i == n_cells_[a]);
    }
    if (a > 0)
      n_rows *= width;
  }
  int* id = ids.data();
  bool complete = true;
  for (int row = 0; row < n_rows; ++row) {
    int row_tile = 0, row_offset = 0;
    bool row_at_wall = false;
    for (int a = 1, rest = row; a < dim; ++a, rest /= width) {
      row_tile += tile[a][rest % width];
      row_offset += offset[a][rest % width];
      row_at_wall = row_at_wall || at_wall[a][rest % width];
    }
    for (int i = 0; i < width; ++i) {
      const int stored = table_[row_tile + tile[0][i]];
      const bool wall = row_at_wall || at_wall[0][i];
      complete = complete && (stored >= 0 || wall);
      *id++ =
          wall ? Stencil<dim>::wall_sample : stored * tile_volume<dim> + row_offset + offset[0][i];
    }
  }
  return complete;
}

template class SampleLattice<2>;
template class SampleLattice<3>;

}  // namespace lockstep
