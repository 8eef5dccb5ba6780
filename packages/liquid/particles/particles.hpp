#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "grid/neighbor_messages.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Parameters of the particles that correct a level set.
struct ParticleParameters {
  /// Particles of each side in a cell of their band. 64 lose a quarter less of what is thin for
  /// four times the time (docs/water.md, measured once).
  static constexpr int per_cell = 16;
  /// Cells on both sides of the surface in which they are, as in Enright et al. 2002.
  static constexpr int band = 3;
  /// Steps between two reseedings: chosen, not varied by a page.
  static constexpr int interval = 20;
  bool drops = false;  ///< true: particles of the liquid that no cell shows fly as drops
};

/// Declares "Drops".
void declare_particles(ParameterList& list);
ParticleParameters read_particles(const ParameterList& list);

/// Largest distance of a place in a cell from its centre: where |phi| is larger, the cell has one
/// sign [cells].
inline constexpr double farthest_in_cell = 0.9;

/// A ball that belongs to one side of the surface.
template <int dim>
struct Particle {
  std::array<float, dim> x;  ///< cells from the lower corner of its tile
  float radius;              ///< [cells]; negative: of the liquid

  int side() const { return radius < 0 ? -1 : 1; }
  double size() const { return radius < 0 ? -radius : radius; }
  Point<dim> position() const {
    Point<dim> result;
    for (int a = 0; a < dim; ++a)
      result[a] = x[a];
    return result;
  }
  /// The cell that holds it, as offset in its tile.
  int cell_in_tile() const {
    int offset = 0;
    for (int a = 0; a < dim; ++a)
      offset += static_cast<int>(x[a]) << (log_tile_width<dim> * a);
    return offset;
  }
};

/// Particles in each owned tile. Nothing may depend on their order: it is not the same on any
/// number of ranks.
template <int dim>
using ParticleTiles = std::vector<std::vector<Particle<dim>>>;

/// Some of a tile's particles, as many as are processed at once.
template <int dim>
struct ParticleBatch {
  std::array<int, tile_width<dim>> places;  ///< in the tile's list, ascending
  int n = 0;
  std::array<Eigen::Array<double, tile_width<dim>, 1>, dim>
      x;  ///< coordinates of `n` particles, then of the last again
};

/// Calls f(batch) for all particles for which `counts` holds.
template <int dim, typename Condition, typename Function>
void for_each_batch(const std::vector<Particle<dim>>& particles, const Condition& counts,
                    const Function& f) {
  ParticleBatch<dim> batch;
  const auto flush = [&] {
    for (int i = 0; i < tile_width<dim>; ++i)
      for (int a = 0; a < dim; ++a)
        batch.x[a][i] = particles[batch.places[std::min(i, batch.n - 1)]].x[a];
    f(batch);
    batch.n = 0;
  };
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!counts(particles[i]))
      continue;
    batch.places[batch.n++] = static_cast<int>(i);
    if (batch.n == tile_width<dim>)
      flush();
  }
  if (batch.n > 0)
    flush();
}

/// Brings particles to the tiles they are in, on whatever rank.
template <int dim>
class ParticlePost {
 public:
  /// Particles reach tiles that `lookup` stores; ids of owned cells are those of the base grid.
  explicit ParticlePost(const TiledGrid<dim>& lookup) : grid_(lookup), messages_(lookup) {}

  /// Sends a particle to a place in lattice units, within the domain; periodic axes wrap. It is
  /// lost where no tile exists.
  void put(const Point<dim>& place, float radius);
  /// Collective.
  void deliver(ParticleTiles<dim>& tiles);

 private:
  const TiledGrid<dim>& grid_;
  NeighborMessages<dim> messages_;
  std::vector<std::pair<int, Particle<dim>>> here_;  ///< with their tiles
};

}  // namespace lockstep
