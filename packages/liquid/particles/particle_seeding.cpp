#include "liquid/particles/particle_seeding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lockstep {

namespace {
constexpr double least_radius = 0.1, most_radius = 0.5;  // [cells]
/// Attempts to bring a particle to its distance.
constexpr int n_attempts = 4;

/// Random numbers of one particle, the same on any rank (splitmix64).
class Dice {
 public:
  Dice(GlobalIndex cell, long long step, int k)
      : state_(mixed(mixed(static_cast<std::uint64_t>(cell)) ^
                     mixed(static_cast<std::uint64_t>(step) * 64 + static_cast<std::uint64_t>(k) +
                           0x632be59bd9b4e019ULL))) {}
  /// In [0, 1).
  double next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
  }

 private:
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// Counts, thins out and seeds the particles of one tile after the other.
template <int dim>
class Seeder {
 public:
  Seeder(const PhiAmongSolids<dim>& known, const ParticleParameters& parameters, Seeding seeding,
         long long step, std::vector<char>& in_band)
      : domain_(known.domain),
        solids_(known.solids),
        phi_(known.phi),
        parameters_(parameters),
        all_(seeding == Seeding::all_cells),
        step_(step),
        in_band_(in_band),
        lattice_(domain_.grid),
        lookup_(domain_.grid, lattice_, solids_, known.kept, phi_, parameters.band + 2),
        post_(domain_.grid) {}

  void seed(int tile, std::vector<Particle<dim>>& particles) {
    const int first = tile * tile_volume<dim>;
    entered_ = -1;
    if (all_)
      thin_out(tile, particles);
    std::array<std::array<int, tile_volume<dim>>, 2> n{};
    for (const Particle<dim>& particle : particles)
      ++n[particle.side() > 0][particle.cell_in_tile()];
    for (int i = 0; i < tile_volume<dim>; ++i) {
      const int cell = first + i;
      const bool is_in_band =
          std::abs(phi_[cell]) < parameters_.band * domain_.spacing() && solids_.is_fluid(cell);
      const bool is_new = is_in_band && !in_band_[cell];
      in_band_[cell] = is_in_band;
      const int n_there = n[phi_[cell] >= 0][i];
      if (is_in_band && (all_ || (is_new && n_there == 0)))
        for (int k = n_there; k < parameters_.per_cell; ++k)
          add(tile, cell, k);
    }
  }
  void deliver(ParticleTiles<dim>& tiles) { post_.deliver(tiles); }

 private:
  void enter(int tile) {
    if (entered_ != tile)
      lookup_.enter(tile);
    entered_ = tile;
  }

  /// Takes away what is beyond the band, and of more than enough in a cell those that are farthest
  /// from the surface, unless they are on the wrong side of it.
  void thin_out(int tile, std::vector<Particle<dim>>& particles) {
    if (particles.empty())
      return;
    enter(tile);
    struct Ranked {
      int key;  ///< cell and side
      double distance;
      Particle<dim> particle;
    };
    std::vector<Ranked> ranked;
    const double h = domain_.spacing();
    std::size_t n_kept = 0;
    for (const Particle<dim>& particle : particles) {
      const auto phi = lookup_.value(particle.position());
      const double distance = phi ? particle.side() * *phi / h : parameters_.band;
      if (distance < -particle.size())
        particles[n_kept++] = particle;
      else if (distance < parameters_.band)
        ranked.push_back({2 * particle.cell_in_tile() + (particle.side() > 0), distance, particle});
    }
    particles.resize(n_kept);
    std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
      if (a.key != b.key)
        return a.key < b.key;
      return a.distance != b.distance ? a.distance < b.distance : a.particle.x < b.particle.x;
    });
    int last_key = -1, n = 0;
    for (const Ranked& one : ranked) {
      n = one.key == last_key ? n + 1 : 1;
      last_key = one.key;
      if (n <= parameters_.per_cell)
        particles.push_back(one.particle);
    }
  }

  void add(int tile, int cell, int k) {
    enter(tile);
    const TiledGrid<dim>& grid = domain_.grid;
    Dice dice(grid.global_id(cell), step_, k);
    const Index<dim> coordinates = grid.coordinates(cell);
    const double h = domain_.spacing();
    const int side = phi_[cell] < 0 ? -1 : 1;
    Point<dim> center, x;
    for (int a = 0; a < dim; ++a) {
      center[a] = coordinates[a] - grid.tile_begin(tile)[a] + 0.5;
      x[a] = center[a] - 0.5 + dice.next();
    }
    const double wanted = side * (least_radius + dice.next() * (parameters_.band - least_radius));
    const auto value_at = [&](const Point<dim>& place) {
      const auto phi = lookup_.value(place);
      return phi ? *phi / h : 0;
    };
    double phi = value_at(x);
    for (int i = 0; i < n_attempts && std::abs(phi - wanted) > 0.05; ++i) {
      const Point<dim> gradient = lookup_.gradient(x) / h;
      const double steepness = gradient.norm();
      if (steepness < 0.1)
        return;
      x += (wanted - phi) / steepness * gradient / steepness;
      for (int a = 0; a < dim; ++a) {
        const double n = grid.n_cells()[a] - grid.tile_begin(tile)[a];
        const double reach = parameters_.band + 1;
        if (!(x[a] > -reach && x[a] < tile_width<dim> + reach))
          return;
        if (!domain_.boundary.periodic(a) && !(x[a] > -grid.tile_begin(tile)[a] && x[a] < n))
          return;
      }
      phi = value_at(x);
    }
    const Point<dim> place = lookup_.place(x);
    if (side * phi < least_radius || side * phi > parameters_.band || lookup_.hidden(center, x) ||
        !knows_phi(place))
      return;
    const double radius = std::clamp(side * phi, least_radius, most_radius);
    post_.put(place, static_cast<float>(side * radius));
  }
  /// True if phi is known at a place, which it is not between an open side and the first centres:
  /// there may be air that is on its way in.
  bool knows_phi(const Point<dim>& place) const {
    for (int a = 0; a < dim; ++a)
      for (int end = 0; end < 2; ++end)
        if (domain_.boundary.side(a, end).lets_in_air() &&
            (end == 0 ? place[a] : domain_.grid.n_cells()[a] - place[a]) < 0.5)
          return false;
    return true;
  }

  const MacDomain<dim>& domain_;
  const SolidCells<dim>& solids_;
  const CellField& phi_;
  const ParticleParameters& parameters_;
  bool all_;
  long long step_;
  std::vector<char>& in_band_;
  SampleLattice<dim> lattice_;
  PhiLookup<dim> lookup_;
  ParticlePost<dim> post_;
  int entered_ = -1;
};
}  // namespace

template <int dim>
void set_radii(const PhiAmongSolids<dim>& known, ParticleTiles<dim>& tiles) {
  const TiledGrid<dim>& grid = known.domain.grid;
  const double h = grid.spacing();
  const SampleLattice<dim> lattice(grid);
  PhiLookup<dim> lookup(grid, lattice, known.solids, known.kept, known.phi);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    std::vector<Particle<dim>>& particles = tiles[tile];
    const auto may_be_small = [&](const Particle<dim>& particle) {
      const double at_center = known.phi[tile * tile_volume<dim> + particle.cell_in_tile()];
      return particle.side() * at_center <= (farthest_in_cell + most_radius) * h;
    };
    for (Particle<dim>& particle : particles)
      if (!may_be_small(particle))
        particle.radius = static_cast<float>(particle.side() * most_radius);
    bool has_entered = false;
    for_each_batch(particles, may_be_small, [&](const ParticleBatch<dim>& batch) {
      if (!has_entered)
        lookup.enter(static_cast<int>(tile));
      has_entered = true;
      const StripValues<dim> plain = lookup.values(batch.x);
      for (int i = 0; i < batch.n; ++i) {
        Particle<dim>& particle = particles[batch.places[i]];
        const int side = particle.side();
        const auto found = lookup.value(particle.position(), plain[i]);
        if (found && side * *found >= -particle.size() * h)
          particle.radius =
              static_cast<float>(side * std::clamp(side * *found / h, least_radius, most_radius));
      }
    });
  }
}

template <int dim>
void seed_particles(const PhiAmongSolids<dim>& known, const ParticleParameters& parameters,
                    Seeding seeding, long long step, std::vector<char>& in_band,
                    ParticleTiles<dim>& tiles) {
  Seeder<dim> seeder(known, parameters, seeding, step, in_band);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    seeder.seed(static_cast<int>(tile), tiles[tile]);
  seeder.deliver(tiles);
}

template void set_radii<2>(const PhiAmongSolids<2>&, ParticleTiles<2>&);
template void set_radii<3>(const PhiAmongSolids<3>&, ParticleTiles<3>&);
template void seed_particles<2>(const PhiAmongSolids<2>&, const ParticleParameters&, Seeding,
                                long long, std::vector<char>&, ParticleTiles<2>&);
template void seed_particles<3>(const PhiAmongSolids<3>&, const ParticleParameters&, Seeding,
                                long long, std::vector<char>&, ParticleTiles<3>&);

}  // namespace lockstep
