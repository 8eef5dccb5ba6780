#include "liquid/particles/particle_storage.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// More than can be in a cell.
constexpr GlobalIndex most_in_cell = 1 << 16;
const char* const count_name = "fluid/interface_particle_counts";
const char* const particle_name = "fluid/interface_particles";

template <int dim>
void list_cells(const TiledGrid<dim>& grid, std::vector<int>& cells,
                std::vector<GlobalIndex>& ids) {
  grid.for_each_owned_cell([&](int cell) {
    cells.push_back(cell);
    ids.push_back(grid.global_id(cell));
  });
}
}  // namespace

template <int dim>
void save_particles(const MacDomain<dim>& domain, const ParticleTiles<dim>& tiles,
                    const std::vector<char>& in_band, CheckpointWriter& checkpoint) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<GlobalIndex> count(grid.n_owned_cells(), 0), ids;
  std::vector<double> values;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    for (const Particle<dim>& particle : tiles[tile]) {
      const int cell = static_cast<int>(tile) * tile_volume<dim> + particle.cell_in_tile();
      ids.push_back(grid.global_id(cell) * most_in_cell + count[cell]++);
      values.insert(values.end(), particle.x.begin(), particle.x.end());
      values.push_back(particle.radius);
    }
  checkpoint.write_distributed(particle_name, ids, values, dim + 1);
  std::vector<int> cells;
  std::vector<GlobalIndex> cell_ids, states;
  list_cells(grid, cells, cell_ids);
  for (const int cell : cells)
    states.push_back(2 * count[cell] + (in_band[cell] ? 1 : 0));
  checkpoint.write_distributed(count_name, cell_ids, states);
}

template <int dim>
void load_particles(const MacDomain<dim>& domain, const CheckpointReader& checkpoint,
                    ParticleTiles<dim>& tiles, std::vector<char>& in_band) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<int> cells;
  std::vector<GlobalIndex> cell_ids, ids;
  list_cells(grid, cells, cell_ids);
  const auto states = checkpoint.read_distributed<long long>(count_name, cell_ids);
  checkpoint.check(std::all_of(states.begin(), states.end(),
                               [](long long n) { return n >= 0 && n < 2 * most_in_cell; }),
                   "its numbers of particles in cells cannot be");
  tiles.assign(grid.n_owned_tiles(), {});
  in_band.assign(grid.n_owned_cells(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    in_band[cells[i]] = states[i] % 2 == 1;
    for (GlobalIndex k = 0; k < states[i] / 2; ++k)
      ids.push_back(cell_ids[i] * most_in_cell + k);
  }
  const auto values = checkpoint.read_distributed<double>(particle_name, ids, dim + 1);
  auto value = values.begin();
  bool are_in_their_cells = true;
  for (const GlobalIndex id : ids) {
    Particle<dim> particle;
    for (float& x : particle.x) {
      are_in_their_cells = are_in_their_cells && *value >= 0 && *value < tile_width<dim>;
      x = static_cast<float>(*value++);
    }
    particle.radius = static_cast<float>(*value++);
    const int cell = grid.cell_of_global_id(id / most_in_cell);
    are_in_their_cells = are_in_their_cells && std::isfinite(particle.radius);
    tiles[TiledGrid<dim>::tile_of(cell)].push_back(particle);
  }
  checkpoint.check(are_in_their_cells, "a particle is not in the tile that it belongs to");
}

template void save_particles<2>(const MacDomain<2>&, const ParticleTiles<2>&,
                                const std::vector<char>&, CheckpointWriter&);
template void save_particles<3>(const MacDomain<3>&, const ParticleTiles<3>&,
                                const std::vector<char>&, CheckpointWriter&);
template void load_particles<2>(const MacDomain<2>&, const CheckpointReader&, ParticleTiles<2>&,
                                std::vector<char>&);
template void load_particles<3>(const MacDomain<3>&, const CheckpointReader&, ParticleTiles<3>&,
                                std::vector<char>&);

}  // namespace lockstep
