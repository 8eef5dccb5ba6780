#include "grid/tile_lattice.hpp"

#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
void check_grid_description(const GridDescription<dim>& description) {
  check_input(std::isfinite(description.spacing) && description.spacing > 0,
              "The grid spacing is {} m; it must be positive.", description.spacing);
  for (int a = 0; a < dim; ++a) {
    const char name = "xyz"[a];
    check_input(description.n_cells[a] >= 1 && description.n_cells[a] <= (1 << 20),
                "The grid has {} cells along {}; give 1 to {}.", description.n_cells[a], name,
                1 << 20);
    check_input(std::isfinite(description.lower[a]),
                "The lower corner of the grid is {} along {}; it must be finite.",
                description.lower[a], name);
    check_input(!(description.periodic[a] && description.store_upper_face[a]),
                "The {} axis is periodic and also has an open or inflow side; choose one.", name);
  }
}

template <int dim>
TileLattice<dim>::TileLattice(const GridDescription<dim>& description) : description_(description) {
  check_grid_description(description);
  for (int a = 0; a < dim; ++a) {
    n_cells_[a] = description.n_cells[a] + (description.store_upper_face[a] ? 1 : 0);
    n_tiles_[a] = (n_cells_[a] + tile_width<dim> - 1) / tile_width<dim>;
  }
}

template <int dim>
Index<dim> TileLattice<dim>::n_domain_tiles() const {
  Index<dim> n{};
  for (int a = 0; a < dim; ++a)
    n[a] = (description_.n_cells[a] + tile_width<dim> - 1) / tile_width<dim>;
  return n;
}

template <int dim>
GlobalIndex TileLattice<dim>::tile_number(const Index<dim>& tile) const {
  GlobalIndex number = 0;
  for (int a = dim - 1; a >= 0; --a)
    number = number * n_tiles_[a] + tile[a];
  return number;
}

template <int dim>
Index<dim> TileLattice<dim>::tile_coordinates(GlobalIndex tile_number) const {
  Index<dim> tile{};
  for (int a = 0; a < dim; ++a) {
    tile[a] = static_cast<int>(tile_number % n_tiles_[a]);
    tile_number /= n_tiles_[a];
  }
  return tile;
}

template <int dim>
GlobalIndex TileLattice<dim>::neighbor_tile(const Index<dim>& tile, int axis, int side) const {
  Index<dim> neighbor = tile;
  neighbor[axis] += side == 0 ? -1 : 1;
  if (description_.periodic[axis])
    neighbor[axis] = (neighbor[axis] + n_tiles_[axis]) % n_tiles_[axis];
  if (neighbor[axis] < 0 || neighbor[axis] >= n_tiles_[axis])
    return no_index;
  return tile_number(neighbor);
}

template <int dim>
Index<dim> TileLattice<dim>::clipped_extent(const Index<dim>& tile,
                                            const Index<dim>& n_cells) const {
  Index<dim> size{};
  for (int a = 0; a < dim; ++a)
    size[a] = std::clamp(n_cells[a] - tile[a] * tile_width<dim>, 0, tile_width<dim>);
  return size;
}

template <int dim>
std::vector<TileSegment> TileLattice<dim>::segments(int axis, int begin, int end) const {
  const int n = n_cells_[axis];
  std::vector<std::array<int, 2>> ranges;
  if (!description_.periodic[axis]) {
    ranges.push_back({std::max(begin, 0), std::min(end, n)});
  } else if (end - begin >= n) {
    ranges.push_back({0, n});
  } else {
    const int first = ((begin % n) + n) % n;
    const int last = first + end - begin;
    ranges.push_back({first, std::min(last, n)});
    if (last > n)
      ranges.push_back({0, last - n});
  }
  std::vector<TileSegment> found;
  for (const auto& [first, last] : ranges) {
    for (int c = first; c < last;) {
      const int tile = c / tile_width<dim>, tile_begin = tile * tile_width<dim>;
      const int next = std::min(last, tile_begin + tile_width<dim>);
      found.push_back({tile, c - tile_begin, next - tile_begin});
      c = next;
    }
  }
  return found;
}

template <int dim>
std::vector<GlobalIndex> TileLattice<dim>::tiles_within(std::vector<GlobalIndex> tile_numbers,
                                                        int width) const {
  // A box is a product of intervals: widen along one axis after the other.
  for (int a = 0; a < dim; ++a) {
    std::vector<GlobalIndex> wider;
    for (const GlobalIndex number : tile_numbers) {
      Index<dim> tile = tile_coordinates(number);
      const int begin = tile[a] * tile_width<dim>, end = begin + extent(tile)[a];
      for (const TileSegment& segment : segments(a, begin - width, end + width)) {
        tile[a] = segment.tile;
        wider.push_back(tile_number(tile));
      }
    }
    std::sort(wider.begin(), wider.end());
    wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
    tile_numbers = std::move(wider);
  }
  return tile_numbers;
}

template <int dim>
GlobalIndex morton_code(const Index<dim>& tile) {
  GlobalIndex code = 0;
  for (int bit = 19; bit >= 0; --bit)
    for (int a = dim - 1; a >= 0; --a)
      code = (code << 1) | ((tile[a] >> bit) & 1);
  return code;
}

template void check_grid_description(const GridDescription<2>&);
template void check_grid_description(const GridDescription<3>&);
template class TileLattice<2>;
template class TileLattice<3>;
template GlobalIndex morton_code<2>(const Index<2>&);
template GlobalIndex morton_code<3>(const Index<3>&);

}  // namespace lockstep
