#include "leaks/liquid_cells.hpp"

#include "liquid/common/phi_lookup.hpp"

namespace lockstep::test {

namespace {
template <int dim, typename IsWet>
LiquidCells wet_cells(const SolidCells<dim>& solids, const IsWet& is_wet) {
  const std::size_t n = solids.state.cells.size();
  LiquidCells cells{std::vector<char>(n, 0), std::vector<char>(n, 0)};
  for (int cell = 0; cell < static_cast<int>(n); ++cell)
    cells.seen[cell] = solids.is_fluid(cell) && is_wet(cell);
  return cells;
}
}  // namespace

template <int dim>
LiquidCells cells_with_liquid(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                              KeptSurface<dim>& kept, const LevelSet<dim>& interface) {
  const TiledGrid<dim>& grid = domain.grid;
  const CellField& phi = interface.distance();
  LiquidCells cells = wet_cells(solids, [&](int cell) { return phi[cell] < 0; });
  const SampleLattice<dim> lattice(grid);
  PhiLookup<dim> lookup(grid, lattice, solids, kept, phi);
  const ParticleTiles<dim>& tiles = interface.particles();
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    if (!tiles[tile].empty())
      lookup.approach(static_cast<int>(tile));
    for (const Particle<dim>& particle : tiles[tile]) {
      if (particle.side() > 0)
        continue;
      const Point<dim> x = particle.position(), place = lookup.place(x);
      bool is_seen = false;
      for (const StencilCorner<dim>& corner : lattice.corners(cell_centers, place)) {
        if (corner.id < 0 || !solids.is_fluid(corner.id) ||
            (lookup.may_be_hidden(x) && lookup.hidden(x, x + (corner.position - place))))
          continue;
        cells.seen[corner.id] = 1;
        is_seen = true;
      }
      if (!is_seen)
        cells.hidden[tile * tile_volume<dim> + particle.cell_in_tile()] = 1;
    }
  }
  domain.halo.sum_to_owner(cells.seen);
  for (char& cell : cells.seen)
    cell = cell != 0;
  domain.halo.fill(cells.seen);
  return cells;
}

template <int dim>
LiquidCells cells_with_liquid(const MacDomain<dim>&, const SolidCells<dim>& solids,
                              KeptSurface<dim>&, const VolumeOfFluid<dim>& interface) {
  return wet_cells(solids, [&](int cell) {
    return interface.distance()[cell] < 0 || interface.fractions().liquid[cell] > 0;
  });
}

template LiquidCells cells_with_liquid(const MacDomain<2>&, const SolidCells<2>&, KeptSurface<2>&,
                                       const LevelSet<2>&);
template LiquidCells cells_with_liquid(const MacDomain<3>&, const SolidCells<3>&, KeptSurface<3>&,
                                       const LevelSet<3>&);
template LiquidCells cells_with_liquid(const MacDomain<2>&, const SolidCells<2>&, KeptSurface<2>&,
                                       const VolumeOfFluid<2>&);
template LiquidCells cells_with_liquid(const MacDomain<3>&, const SolidCells<3>&, KeptSurface<3>&,
                                       const VolumeOfFluid<3>&);

}  // namespace lockstep::test
