#include "liquid/particles/particles.hpp"

#include <cmath>

namespace lockstep {

namespace {
/// A particle in a cell, by its place within the cell: as float never beyond its upper corner.
template <int dim>
Particle<dim> placed(const TiledGrid<dim>& grid, int cell, const Point<dim>& in_cell,
                     float radius) {
  const Index<dim> coordinates = grid.coordinates(cell);
  const Index<dim>& begin = grid.tile_begin(TiledGrid<dim>::tile_of(cell));
  Particle<dim> particle;
  for (int a = 0; a < dim; ++a) {
    const int below = coordinates[a] - begin[a];
    const float x = static_cast<float>(below + in_cell[a]);
    particle.x[a] = x < below + 1 ? x : std::nextafter(static_cast<float>(below + 1), 0.0F);
  }
  particle.radius = radius;
  return particle;
}
}  // namespace

void declare_particles(ParameterList& list) {
  declare_choice(list, "Drops", "none", {"none", "ballistic"},
                 "Of particles of the liquid that no wet cell is around. none: they go with the "
                 "velocity that is carried on into the air, and their volume is that of other "
                 "liquid. ballistic: they leave with h^dim / 16 and the velocity there, fly and "
                 "hit solids, and give volume and momentum back in the "
                 "first wet cell.");
}

ParticleParameters read_particles(const ParameterList& list) {
  ParticleParameters parameters;
  parameters.drops = list.get<std::string>("Drops") == "ballistic";
  return parameters;
}

template <int dim>
void ParticlePost<dim>::put(const Point<dim>& place, float radius) {
  Index<dim> coordinates;
  Point<dim> in_cell;
  for (int a = 0; a < dim; ++a) {
    const double below = std::floor(place[a]);
    coordinates[a] = static_cast<int>(below);
    in_cell[a] = place[a] - below;
  }
  const int cell = grid_.cell(coordinates);
  if (cell < 0)
    return;
  const Particle<dim> particle = placed(grid_, cell, in_cell, radius);
  if (grid_.owned(cell)) {
    here_.emplace_back(TiledGrid<dim>::tile_of(cell), particle);
    return;
  }
  auto& message = messages_.to_owner(grid_, cell);
  message.push_back(static_cast<double>(grid_.global_id(cell)));
  message.insert(message.end(), particle.x.begin(), particle.x.end());
  message.push_back(radius);
}

template <int dim>
void ParticlePost<dim>::deliver(ParticleTiles<dim>& tiles) {
  for (const auto& [tile, particle] : here_)
    tiles[tile].push_back(particle);
  here_.clear();
  if (grid_.comm()->getSize() == 1)
    return;
  const std::vector<double> arrived = messages_.exchange();
  for (std::size_t i = 0; i < arrived.size(); i += dim + 2) {
    const int cell = grid_.cell_of_global_id(static_cast<GlobalIndex>(arrived[i]));
    Particle<dim> particle;
    for (int a = 0; a < dim; ++a)
      particle.x[a] = static_cast<float>(arrived[i + 1 + a]);
    particle.radius = static_cast<float>(arrived[i + 1 + dim]);
    tiles[TiledGrid<dim>::tile_of(cell)].push_back(particle);
  }
}

template class ParticlePost<2>;
template class ParticlePost<3>;

}  // namespace lockstep
