#include "liquid/particles/particle_correction.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Correction of phi at a cell that a particle asks for.
struct Wish {
  int cell = 0;
  int side = 0;
  double phi = 0;
};

template <int dim>
class Wishes {
 public:
  Wishes(const MacDomain<dim>& domain, const SolidCells<dim>& solids, KeptSurface<dim>& kept,
         const CellField& phi)
      : grid_(domain.grid),
        solids_(solids),
        phi_(phi),
        lattice_(grid_),
        lookup_(grid_, lattice_, solids, kept, phi),
        messages_(grid_) {}

  void look_at(int tile, const std::vector<Particle<dim>>& particles) {
    const double h = grid_.spacing();
    bool has_entered = false;
    const auto is_near = [&](const Particle<dim>& particle) {
      const int cell = tile * tile_volume<dim> + particle.cell_in_tile();
      return particle.side() * phi_[cell] <= farthest_in_cell * h;
    };
    for_each_batch(particles, is_near, [&](const ParticleBatch<dim>& batch) {
      if (!has_entered)
        lookup_.enter(tile);
      has_entered = true;
      const StripValues<dim> plain = lookup_.values(batch.x);
      for (int i = 0; i < batch.n; ++i) {
        const Particle<dim>& particle = particles[batch.places[i]];
        const auto phi = lookup_.value(particle.position(), plain[i]);
        if (phi && particle.side() * *phi < -particle.size() * h)
          wish(particle);
      }
    });
  }
  /// Returns the wishes for cells of this rank.
  const std::vector<Wish>& collect() {
    if (grid_.comm()->getSize() > 1) {
      const std::vector<double> arrived = messages_.exchange();
      for (std::size_t i = 0; i < arrived.size(); i += 3)
        wishes_.push_back({grid_.cell_of_global_id(static_cast<GlobalIndex>(arrived[i])),
                           static_cast<int>(arrived[i + 1]), arrived[i + 2]});
    }
    return wishes_;
  }

 private:
  void wish(const Particle<dim>& particle) {
    const Point<dim> x = particle.position(), place = lookup_.place(x);
    const bool may_be_hidden = lookup_.may_be_hidden(x);
    for (const StencilCorner<dim>& corner : lattice_.corners(cell_centers, place)) {
      if (corner.id < 0 || corner.weight == 0 || !solids_.is_fluid(corner.id))
        continue;
      if (may_be_hidden && lookup_.hidden(x, x + (corner.position - place)))
        continue;
      const double distance = (corner.position - place).norm();
      const double phi = particle.side() * (particle.size() - distance) * grid_.spacing();
      if (grid_.owned(corner.id)) {
        wishes_.push_back({corner.id, particle.side(), phi});
        continue;
      }
      auto& message = messages_.to_owner(grid_, corner.id);
      message.insert(message.end(), {static_cast<double>(grid_.global_id(corner.id)),
                                     static_cast<double>(particle.side()), phi});
    }
  }

  const TiledGrid<dim>& grid_;
  const SolidCells<dim>& solids_;
  const CellField& phi_;
  SampleLattice<dim> lattice_;
  PhiLookup<dim> lookup_;
  NeighborMessages<dim> messages_;
  std::vector<Wish> wishes_;
};
}  // namespace

template <int dim>
void correct_by_particles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                          KeptSurface<dim>& kept, const ParticleTiles<dim>& tiles, CellField& phi) {
  Wishes<dim> found(domain, solids, kept, phi);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    found.look_at(static_cast<int>(tile), tiles[tile]);
  std::vector<Wish> wishes = found.collect();
  std::sort(wishes.begin(), wishes.end(),
            [](const Wish& a, const Wish& b) { return a.cell < b.cell; });
  for (std::size_t i = 0; i < wishes.size();) {
    const int cell = wishes[i].cell;
    double highest = phi[cell], lowest = phi[cell];
    for (; i < wishes.size() && wishes[i].cell == cell; ++i) {
      if (wishes[i].side > 0)
        highest = std::max(highest, wishes[i].phi);
      else
        lowest = std::min(lowest, wishes[i].phi);
    }
    phi[cell] = std::abs(highest) <= std::abs(lowest) ? highest : lowest;
  }
  domain.halo.fill(phi);
}

template <int dim>
void remove_trapped_air(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                        KeptSurface<dim>& kept, const CellField& phi, ParticleTiles<dim>& tiles) {
  if (!solids.state.surface)
    return;
  const SampleLattice<dim> lattice(domain.grid);
  PhiLookup<dim> lookup(domain.grid, lattice, solids, kept, phi);
  const auto is_trapped = [&](const Particle<dim>& particle) {
    const Point<dim> x = particle.position();
    if (particle.side() < 0 || !lookup.may_be_hidden(x))
      return false;
    const Point<dim> place = lookup.place(x);
    bool beside_solid = false;
    for (const StencilCorner<dim>& corner : lattice.corners(cell_centers, place)) {
      if (corner.id < 0 || !solids.is_fluid(corner.id) ||
          lookup.hidden(x, x + (corner.position - place)))
        beside_solid = true;
      else if (phi[corner.id] >= 0)
        return false;
    }
    return beside_solid;
  };
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    auto& particles = tiles[tile];
    if (!particles.empty() && lookup.approach(static_cast<int>(tile)))
      particles.erase(std::remove_if(particles.begin(), particles.end(), is_trapped),
                      particles.end());
  }
}

template <int dim>
void remove_particles(int side, const std::vector<char>& cells, ParticleTiles<dim>& tiles) {
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    auto& particles = tiles[tile];
    const auto goes = [&](const Particle<dim>& particle) {
      return particle.side() == side && cells[tile * tile_volume<dim> + particle.cell_in_tile()];
    };
    particles.erase(std::remove_if(particles.begin(), particles.end(), goes), particles.end());
  }
}

template void correct_by_particles<2>(const MacDomain<2>&, const SolidCells<2>&, KeptSurface<2>&,
                                      const ParticleTiles<2>&, CellField&);
template void correct_by_particles<3>(const MacDomain<3>&, const SolidCells<3>&, KeptSurface<3>&,
                                      const ParticleTiles<3>&, CellField&);
template void remove_trapped_air<2>(const MacDomain<2>&, const SolidCells<2>&, KeptSurface<2>&,
                                    const CellField&, ParticleTiles<2>&);
template void remove_trapped_air<3>(const MacDomain<3>&, const SolidCells<3>&, KeptSurface<3>&,
                                    const CellField&, ParticleTiles<3>&);
template void remove_particles<2>(int, const std::vector<char>&, ParticleTiles<2>&);
template void remove_particles<3>(int, const std::vector<char>&, ParticleTiles<3>&);

}  // namespace lockstep
