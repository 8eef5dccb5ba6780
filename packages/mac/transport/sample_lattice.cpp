#include "mac/transport/sample_lattice.hpp"

#include <algorithm>

#include "mac/transport/cubic_weights.hpp"

namespace lockstep {

namespace {

/// Sets a part of a block with rows of `width` values to zero.
void fill_part(const Index<3>& size, int width, double* to) {
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      std::fill_n(to + (z * width + y) * width, size[0], 0.0);
}

/// Copies a part of a tile with rows of `tile_row` values to a block with rows of `width`.
template <int tile_row>
void copy_part(const Index<3>& size, const double* from, int width, double* to) {
  for (int z = 0; z < size[2]; ++z) {
    const double* source = from + z * tile_row * tile_row;
    double* target = to + z * width * width;
    if (size[0] == tile_row) {
      using Row = Eigen::Array<double, tile_row, 1>;
      for (int y = 0; y < size[1]; ++y)
        Eigen::Map<Row>(target + y * width) = Eigen::Map<const Row>(source + y * tile_row);
    } else {  // short rows are copied fastest across
      for (int x = 0; x < size[0]; ++x)
        for (int y = 0; y < size[1]; ++y)
          target[y * width + x] = source[y * tile_row + x];
    }
  }
}

}  // namespace

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
WideStencil<dim> SampleLattice<dim>::locate_wide(SampleKind kind, Point<dim> x) const {
  const Point<dim> offset = sample_offset<dim>(kind);
  WideStencil<dim> stencil;
  std::array<std::array<int, 4>, dim> tile, place;
  std::array<std::array<bool, 4>, dim> at_wall;
  for (int a = 0; a < dim; ++a) {
    const bool bounded = !periodic_[a], on_faces = a == kind;
    const int last = last_sample(a, kind);
    const double t = bounded ? std::clamp<double>(x[a] - offset[a], 0, last) : x[a] - offset[a];
    const int below = static_cast<int>(std::floor(t));
    const double f = t - below;
    stencil.weight[a] =
        cubic_weights(f, cubic_share(f, !bounded || below >= 1, !bounded || below + 2 <= last));
    for (int k = 0; k < 4; ++k) {
      const int i = resolve(a, on_faces, below - 1 + k);
      at_wall[a][k] = on_faces && virtual_wall_[a] && i == n_cells_[a];
      tile[a][k] = table_share(a, i);
      place[a][k] = (i & (tile_width<dim> - 1)) << (log_tile_width<dim> * a);
    }
  }
  for (int k = 0; k < 1 << (2 * dim); ++k) {
    int in_table = 0, in_tile = 0;
    bool wall = false;
    for (int a = 0; a < dim; ++a) {
      const int digit = (k >> (2 * a)) & 3;
      in_table += tile[a][digit];
      in_tile += place[a][digit];
      wall |= at_wall[a][digit];
    }
    stencil.id[k] =
        wall ? Stencil<dim>::wall_sample : table_[in_table] * tile_volume<dim> + in_tile;
  }
  return stencil;
}

template <int dim>
std::vector<typename SampleLattice<dim>::Run> SampleLattice<dim>::find_runs(int axis, bool on_faces,
                                                                            int begin,
                                                                            int width) const {
  std::vector<Run> runs;
  for (int k = 0; k < width; ++k) {
    const int i = resolve(axis, on_faces, begin + k);
    Run place{k, 1, table_share(axis, i),
              (i & (tile_width<dim> - 1)) << (log_tile_width<dim> * axis),
              on_faces && virtual_wall_[axis] && i == n_cells_[axis]};
    Run* last = runs.empty() ? nullptr : &runs.back();
    if (last && place.tile == last->tile && place.at_wall == last->at_wall &&
        place.offset == last->offset + (last->length << (log_tile_width<dim> * axis)))
      ++last->length;
    else
      runs.push_back(place);
  }
  return runs;
}

template <int dim>
bool SampleLattice<dim>::copy_block(SampleKind kind, const Index<dim>& begin, int width,
                                    const double* field, double* block) const {
  std::array<std::vector<Run>, 3> runs;
  runs[2] = {Run{0, 1, 0, 0, false}};
  for (int a = 0; a < dim; ++a)
    runs[a] = find_runs(a, a == kind, begin[a], width);
  for (const Run& z : runs[2])
    for (const Run& y : runs[1])
      for (const Run& x : runs[0]) {
        double* to = block + (z.begin * width + y.begin) * width + x.begin;
        const int tile = table_[z.tile + y.tile + x.tile];
        if (z.at_wall || y.at_wall || x.at_wall)
          fill_part({x.length, y.length, z.length}, width, to);
        else if (tile < 0)
          return false;
        else
          copy_part<tile_width<dim>>(
              {x.length, y.length, z.length},
              field + tile * tile_volume<dim> + z.offset + y.offset + x.offset, width, to);
      }
  return true;
}

template class SampleLattice<2>;
template class SampleLattice<3>;

}  // namespace lockstep
