#include "liquid/common/band_tiles.hpp"

#include <algorithm>
#include <cmath>

#include "staggered/domain/cell_at_side.hpp"

namespace lockstep {

namespace {
/// The cells of a tile in the band: the box of their lattice coordinates.
template <int dim>
struct CellBox {
  Index<dim> low, high;
  bool empty() const { return low[0] > high[0]; }
};

/// True if a surface comes near the cell and one of its neighbours is of the other kind.
template <int dim>
bool may_be_kept_apart(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                       const CellField& phi, int cell) {
  if (solids.near.empty() || !solids.near[cell])
    return false;
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = grid.neighbor(cell, i / 2, i % 2);
    if (other >= 0 && grid.in_domain(other) && (phi[cell] < 0) != (phi[other] < 0))
      return true;
  }
  return false;
}

/// Liquid may leave through the side, and air or liquid come in.
template <int dim>
bool lets_through(const BoundarySide<dim>& side) {
  return side.type == SideType::open || side.type == SideType::inflow;
}

template <int dim>
bool is_liquid_at_open_side(const MacDomain<dim>& domain, const CellField& phi, int cell) {
  return phi[cell] < 0 && at_side(domain, cell, lets_through<dim>);
}

template <int dim>
bool touches_open_side(const MacDomain<dim>& domain, int tile) {
  const TiledGrid<dim>& grid = domain.grid;
  for (int a = 0; a < dim; ++a) {
    const int begin = grid.tile_begin(tile)[a], end = begin + grid.tile_domain_extent(tile)[a];
    if ((begin == 0 && lets_through(domain.boundary.side(a, 0))) ||
        (end == grid.n_cells()[a] && lets_through(domain.boundary.side(a, 1))))
      return true;
  }
  return false;
}

template <int dim>
CellBox<dim> box_of_band(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         const CellField& phi, double cut_off, int tile) {
  const TiledGrid<dim>& grid = domain.grid;
  const bool at_open_side = touches_open_side(domain, tile);
  constexpr int width = tile_width<dim>;
  CellBox<dim> box;
  box.low.fill(width);
  box.high.fill(-1);
  const Index<dim>& extent = grid.tile_domain_extent(tile);
  for (int first = 0; first < tile_volume<dim>; first += width) {
    Index<dim> row{};
    bool exists = true;
    for (int a = 1, rest = first / width; a < dim; ++a, rest /= width) {
      row[a] = rest % width;
      exists = exists && row[a] < extent[a];
    }
    if (!exists)
      continue;
    for (int x = 0; x < extent[0]; ++x) {
      const int cell = tile * tile_volume<dim> + first + x;
      if (std::abs(phi[cell]) >= cut_off && !may_be_kept_apart(grid, solids, phi, cell) &&
          !(at_open_side && is_liquid_at_open_side(domain, phi, cell)))
        continue;
      row[0] = x;
      for (int a = 0; a < dim; ++a) {
        box.low[a] = std::min(box.low[a], row[a]);
        box.high[a] = std::max(box.high[a], row[a]);
      }
    }
  }
  for (int a = 0; a < dim; ++a) {
    box.low[a] += grid.tile_begin(tile)[a];
    box.high[a] += grid.tile_begin(tile)[a];
  }
  return box;
}

/// Distance from a lattice coordinate to the first one of the next tile; the last tile of an axis
/// may be short, and after it a periodic axis begins anew.
template <int dim>
int to_next_tile(const TiledGrid<dim>& grid, int axis, int place) {
  const int n = grid.n_cells()[axis];
  const int wrapped = ((place % n) + n) % n;
  return std::min(tile_width<dim> - wrapped % tile_width<dim>, n - wrapped);
}

/// Flags the owned tiles that a box of lattice coordinates touches; periodic axes wrap.
template <int dim>
void flag_tiles(const TiledGrid<dim>& grid, const CellBox<dim>& box, std::vector<char>& flags) {
  Index<dim> place = box.low;
  while (true) {
    const int cell = grid.cell(place);
    if (cell >= 0 && grid.owned(cell))
      flags[TiledGrid<dim>::tile_of(cell)] = 1;
    int a = 0;
    for (; a < dim; ++a) {
      place[a] += to_next_tile(grid, a, place[a]);
      if (place[a] <= box.high[a])
        break;
      place[a] = box.low[a];
    }
    if (a == dim)
      return;
  }
}
}  // namespace

template <int dim>
std::vector<char> tiles_near_band(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                  const CellField& phi, double cut_off, int reach) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<char> flags(grid.n_owned_tiles(), 0);
  for (int tile = 0; tile < grid.n_tiles(); ++tile) {
    CellBox<dim> box = box_of_band(domain, solids, phi, cut_off, tile);
    if (box.empty())
      continue;
    for (int a = 0; a < dim; ++a) {
      box.low[a] -= reach;
      box.high[a] += reach;
      if (!grid.description().periodic[a]) {
        box.low[a] = std::max(box.low[a], 0);
        box.high[a] = std::min(box.high[a], grid.n_cells()[a] - 1);
      }
    }
    flag_tiles(grid, box, flags);
  }
  return flags;
}

template std::vector<char> tiles_near_band<2>(const MacDomain<2>&, const SolidCells<2>&,
                                              const CellField&, double, int);
template std::vector<char> tiles_near_band<3>(const MacDomain<3>&, const SolidCells<3>&,
                                              const CellField&, double, int);

}  // namespace lockstep
