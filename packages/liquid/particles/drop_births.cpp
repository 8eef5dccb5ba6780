#include "liquid/particles/drop_births.hpp"

#include <algorithm>
#include <numeric>

namespace lockstep {

namespace {
/// Particles of a tile may stand in any order; drops, whose momenta are summed, do not.
template <int dim>
std::vector<Drop<dim>> in_order_of_places(const std::vector<Drop<dim>>& drops,
                                          std::vector<int>& cells) {
  std::vector<int> order(drops.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto &x = drops[a].position, &y = drops[b].position;
    return cells[a] != cells[b]
               ? cells[a] < cells[b]
               : std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
  });
  std::vector<Drop<dim>> sorted;
  std::vector<int> sorted_cells;
  for (const int i : order) {
    sorted.push_back(drops[i]);
    sorted_cells.push_back(cells[i]);
  }
  cells.swap(sorted_cells);
  return sorted;
}
}  // namespace

template <int dim>
std::vector<Drop<dim>> take_lone_particles(const PhiAmongSolids<dim>& known,
                                           const TransportFrame<dim>& frame,
                                           ParticleTiles<dim>& tiles, std::vector<int>& cells) {
  const TiledGrid<dim>& grid = known.domain.grid;
  const SolidCells<dim>& solids = known.solids;
  const CellField& phi = known.phi;
  const SampleLattice<dim> lattice(grid);
  PhiLookup<dim> lookup(grid, lattice, solids, known.kept, phi);
  std::vector<Drop<dim>> drops;
  cells.clear();
  const auto is_lone = [&](const Particle<dim>& particle) {
    const Point<dim> x = particle.position(), place = lookup.place(x);
    const bool may_be_hidden = lookup.may_be_hidden(x);
    for (const StencilCorner<dim>& corner : lattice.corners(cell_centers, place))
      if (corner.id >= 0 && phi[corner.id] < 0 && solids.is_fluid(corner.id) &&
          !(may_be_hidden && lookup.hidden(x, x + (corner.position - place))))
        return false;
    return true;
  };
  const auto velocity_at = [&](const Point<dim>& place) {
    const auto stencils = frame.lattice->locate_faces(place);
    Point<dim> u = Point<dim>::Zero();
    for (int a = 0; a < dim; ++a)
      if (stencils[a].complete())
        u[a] = interpolate<dim>(stencils[a], frame.tracer->velocity()[a]);
    return u;
  };
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    std::vector<Particle<dim>>& particles = tiles[tile];
    bool has_approached = false;
    const auto leaves = [&](const Particle<dim>& particle) {
      const int cell = static_cast<int>(tile) * tile_volume<dim> + particle.cell_in_tile();
      if (particle.side() > 0 || (phi[cell] < 0 && solids.is_fluid(cell)))
        return false;
      if (!has_approached)
        lookup.approach(static_cast<int>(tile));
      has_approached = true;
      if (!is_lone(particle))
        return false;
      Drop<dim> drop;
      const Point<dim> place = lookup.place(particle.position());
      drop.position = grid.lower() + grid.spacing() * place;
      drop.velocity = velocity_at(place);
      drops.push_back(drop);
      cells.push_back(cell);
      return true;
    };
    // In their order, each once.
    const auto last = std::remove_if(particles.begin(), particles.end(), leaves);
    particles.erase(last, particles.end());
  }
  return in_order_of_places(drops, cells);
}

template std::vector<Drop<2>> take_lone_particles<2>(const PhiAmongSolids<2>&,
                                                     const TransportFrame<2>&, ParticleTiles<2>&,
                                                     std::vector<int>&);
template std::vector<Drop<3>> take_lone_particles<3>(const PhiAmongSolids<3>&,
                                                     const TransportFrame<3>&, ParticleTiles<3>&,
                                                     std::vector<int>&);

}  // namespace lockstep
