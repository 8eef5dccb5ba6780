#include "transport/sample_lattice.hpp"

#include <algorithm>

#include "transport/cubic_weights.hpp"

namespace lockstep {

namespace {

/// Copies rows of a tile with rows of `tile_strip` values; `n` values of each, or those of `size`.
template <int tile_strip, int n>
void copy_rows(const Index<3>& size, const double* from, const Index<3>& stride, double* to) {
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y) {
      double* target = to + z * stride[2] + y * stride[1];
      const double* source = from + (z * tile_strip + y) * tile_strip;
      if constexpr (n > 0) {
        using Row = Eigen::Array<double, n, 1>;
        Row::Map(target) = Row::Map(source);
      } else {
        for (int x = 0; x < size[0]; ++x)
          target[x] = source[x];
      }
    }
}

/// Copies a part of a tile to a block; zeros from nowhere.
template <int tile_strip>
void copy_part(const Index<3>& size, const double* from, const Index<3>& stride, double* to) {
  if (from == nullptr) {
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        std::fill_n(to + z * stride[2] + y * stride[1], size[0], 0.0);
  } else if (size[0] == tile_strip) {
    copy_rows<tile_strip, tile_strip>(size, from, stride, to);
  } else if (size[0] == 4) {
    copy_rows<tile_strip, 4>(size, from, stride, to);
  } else {
    copy_rows<tile_strip, 0>(size, from, stride, to);
  }
}

}  // namespace

template <int dim>
SampleLattice<dim>::SampleLattice(const TiledGrid<dim>& grid, bool beyond)
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
  table_.assign(size, beyond && !grid.is_complete() ? grid.n_tiles() : -1);
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
bool SampleLattice<dim>::copy_block(const std::array<const std::vector<Run>*, dim>& runs,
                                    const std::array<int, dim>& stride, const double* field,
                                    double* block) const {
  static const std::vector<Run> one_plane{Run{0, 1, 0, 0, false}};
  const std::vector<Run>& planes = dim == 3 ? *runs[dim - 1] : one_plane;
  const Index<3> strides{1, stride[1], dim == 3 ? stride[dim - 1] : 0};
  for (const Run& z : planes)
    for (const Run& y : *runs[1])
      for (const Run& x : *runs[0]) {
        const Index<3> size{x.length, y.length, z.length};
        double* to = block + z.begin * strides[2] + y.begin * strides[1] + x.begin;
        const bool at_wall = z.at_wall || y.at_wall || x.at_wall;
        const int tile = table_[z.tile + y.tile + x.tile];
        if (tile < 0 && !at_wall)
          return false;
        const double* from =
            at_wall ? nullptr : field + tile * tile_volume<dim> + z.offset + y.offset + x.offset;
        copy_part<tile_width<dim>>(size, from, strides, to);
      }
  return true;
}

template class SampleLattice<2>;
template class SampleLattice<3>;

}  // namespace lockstep
