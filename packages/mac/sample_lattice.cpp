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
  const Stencil<dim> stencil = locate<true>(kind, x);
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
bool SampleLattice<dim>::stores(const Index<dim>& begin, const Index<dim>& end) const {
  constexpr int log_width = log_tile_width<dim>;
  Index<dim> first, last;
  int n = 1;
  for (int a = 0; a < dim; ++a) {
    if (begin[a] < 0 || end[a] > n_cells_[a])
      return false;
    first[a] = (begin[a] >> log_width) - table_lower_[a];
    last[a] = ((end[a] - 1) >> log_width) - table_lower_[a];
    if (first[a] < 0 || last[a] >= table_size_[a])
      return false;
    n *= last[a] - first[a] + 1;
  }
  for (int i = 0; i < n; ++i) {
    int place = 0;
    for (int a = 0, rest = i; a < dim; ++a) {
      const int width = last[a] - first[a] + 1;
      place += (first[a] + rest % width) * table_stride_[a];
      rest /= width;
    }
    if (table_[place] < 0)
      return false;
  }
  return true;
}

template class SampleLattice<2>;
template class SampleLattice<3>;

}  // namespace lockstep
