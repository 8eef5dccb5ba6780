#include "liquid/particles/particle_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lockstep {

namespace {
/// Least distance of a particle from a closed side; at another side a particle this near has left,
/// because rays end on sides but for round-off [cells].
constexpr double nearest_to_side = 1e-3;
/// Cells farther from the surface have no particle that a shift would make escape [cells].
constexpr double shifted_band = 2;
/// The part of a shift that particles follow: what they know of the shape is worth more than a
/// correction that is the same all over a body, but not for ever.
constexpr double followed = 0.2;

/// Puts a particle that stays in the tile that begins there to its new place in lattice units;
/// false if it leaves.
template <int dim>
bool keep(const TiledGrid<dim>& grid, const Index<dim>& begin, const Point<dim>& end,
          const Particle<dim>& particle, Particle<dim>& result) {
  Particle<dim> moved = particle;
  for (int a = 0; a < dim; ++a) {
    const double x = end[a] - begin[a];
    moved.x[a] = static_cast<float>(x);
    // The place as float decides, as it does after the next step; the last tile may be short.
    if (!(x >= 0 && moved.x[a] < std::min(tile_width<dim>, grid.n_cells()[a] - begin[a])))
      return false;
  }
  result = moved;
  return true;
}

/// Removes those at ascending places.
template <typename Item>
void remove_places(const std::vector<int>& places, std::vector<Item>& items) {
  if (places.empty())
    return;
  auto next = places.begin();
  std::size_t n_kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (next != places.end() && *next == static_cast<int>(i))
      ++next;
    else
      items[n_kept++] = items[i];
  items.resize(n_kept);
}

/// Moves the particles of one tile after the other.
template <int dim>
class Mover {
 public:
  Mover(const MacDomain<dim>& domain, TransportFrame<dim>& frame, ParticlePost<dim>& post)
      : domain_(domain), frame_(frame), post_(post) {}

  void move(int tile, std::vector<Particle<dim>>& particles) {
    begin_ = domain_.grid.tile_begin(tile);
    is_near_surface_ = frame_.plans[tile].near_surface;
    // Rows know no inflow sides, but with the flow nothing comes from there.
    const bool by_strips = frame_.block && frame_.block->enter(begin_);
    std::size_t n_kept = 0;
    for (std::size_t first = 0; first < particles.size(); first += tile_width<dim>) {
      const int n =
          static_cast<int>(std::min<std::size_t>(tile_width<dim>, particles.size() - first));
      StripRays<dim> rays;
      if (by_strips)
        rays = follow(particles.data() + first, n);
      for (int i = 0; i < n; ++i) {
        const Particle<dim> particle = particles[first + i];
        const bool near = is_near(particle);
        std::optional<Point<dim>> end;
        if (by_strips && (!near || passes_freely(particle, rays, i)))
          end = frame_.block->place(rays.end, i);
        else
          end = follow_single(place(particle), near);
        if (!end || !stays_in_domain(*end))
          continue;
        if (keep<dim>(domain_.grid, begin_, *end, particle, particles[n_kept]))
          ++n_kept;
        else
          post_.put(*end, particle.radius);
      }
    }
    particles.resize(n_kept);
  }
  GlobalIndex n_given_up() const { return n_given_up_; }

 private:
  Point<dim> place(const Particle<dim>& particle) const {
    Point<dim> x = particle.position();
    for (int a = 0; a < dim; ++a)
      x[a] += begin_[a];
    return x;
  }
  bool is_near(const Particle<dim>& particle) const {
    return is_near_surface_ && frame_.near_surface->is_near(place(particle));
  }
  /// True if no surface comes near the way that strips have found, though it may come near others.
  bool passes_freely(const Particle<dim>& particle, const StripRays<dim>& rays, int i) const {
    const Box<dim> way = Box<dim>(place(particle))
                             .extend(frame_.block->place(rays.middle, i))
                             .extend(frame_.block->place(rays.end, i));
    return frame_.near_surface->clear(way, true);
  }
  StripRays<dim> follow(const Particle<dim>* particles, int n) const {
    StripPoints<dim> start;
    for (int a = 0; a < dim; ++a)
      for (int i = 0; i < tile_width<dim>; ++i)
        start[a][i] = particles[std::min(i, n - 1)].x[a] + frame_.block->margin(a);
    return frame_.block->follow(start, 1);
  }
  std::optional<Point<dim>> follow_single(const Point<dim>& x, bool near) {
    if (near) {
      const auto end = frame_.near_surface->follow(x);
      n_given_up_ += !end;
      return end;
    }
    const Ray<dim> ray = frame_.tracer->trace(x, 1);
    return ray.complete ? std::optional<Point<dim>>(ray.end) : std::nullopt;
  }
  /// Keeps the place off closed sides; false if it has left through another.
  bool stays_in_domain(Point<dim>& x) const {
    for (int a = 0; a < dim; ++a) {
      if (domain_.boundary.periodic(a))
        continue;
      const double n = domain_.grid.n_cells()[a];
      if ((x[a] <= nearest_to_side && !domain_.boundary.side(a, 0).closed()) ||
          (x[a] >= n - nearest_to_side && !domain_.boundary.side(a, 1).closed()))
        return false;
      x[a] = std::clamp(x[a], nearest_to_side, n - nearest_to_side);
    }
    return true;
  }
  const MacDomain<dim>& domain_;
  TransportFrame<dim>& frame_;
  ParticlePost<dim>& post_;
  Index<dim> begin_{};
  bool is_near_surface_ = false;
  GlobalIndex n_given_up_ = 0;
};
}  // namespace

template <int dim>
GlobalIndex move_particles(const MacDomain<dim>& domain, TransportFrame<dim>& frame,
                           const RayHalo<dim>& ray_halo, ParticleTiles<dim>& tiles) {
  ParticlePost<dim> post(ray_halo.sample_grid());
  Mover<dim> mover(domain, frame, post);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (!tiles[tile].empty())
      mover.move(static_cast<int>(tile), tiles[tile]);
  post.deliver(tiles);
  return mover.n_given_up();
}

template <int dim>
void shift_particles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                     KeptSurface<dim>& kept, const VolumeShift& shift, const CellField& phi,
                     ParticleTiles<dim>& tiles) {
  if (shift.empty())
    return;
  const double h = domain.spacing();
  const SampleLattice<dim> lattice(domain.grid);
  PhiLookup<dim> lookup(domain.grid, lattice, solids, kept, phi);
  ParticlePost<dim> post(domain.grid);
  const auto is_inside = [&](const Point<dim>& place) {
    for (int a = 0; a < dim; ++a)
      if (!domain.boundary.periodic(a) &&
          !(place[a] > nearest_to_side && place[a] < domain.grid.n_cells()[a] - nearest_to_side))
        return false;
    return true;
  };
  std::vector<int> gone;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    std::vector<Particle<dim>>& particles = tiles[tile];
    const Index<dim>& begin = domain.grid.tile_begin(static_cast<int>(tile));
    const auto shift_at = [&](const Particle<dim>& particle) {
      const std::size_t cell = tile * tile_volume<dim> + particle.cell_in_tile();
      return std::abs(phi[cell]) > shifted_band * h ? 0 : shift[cell];
    };
    const auto is_shifted = [&](const Particle<dim>& particle) { return shift_at(particle) != 0; };
    bool has_entered = false;
    gone.clear();
    for_each_batch(particles, is_shifted, [&](const ParticleBatch<dim>& batch) {
      if (!has_entered)
        lookup.enter(static_cast<int>(tile));
      has_entered = true;
      const StripPoints<dim> slopes = lookup.gradients(batch.x);
      for (int i = 0; i < batch.n; ++i) {
        Particle<dim>& particle = particles[batch.places[i]];
        Point<dim> gradient;
        for (int a = 0; a < dim; ++a)
          gradient[a] = slopes[a][i];
        const double steepness = gradient.norm();
        if (steepness < 0.1 * h)
          continue;
        const Point<dim> x = particle.position();
        const Point<dim> end = x + followed * shift_at(particle) / h * gradient / steepness;
        const Point<dim> place = lookup.place(end);
        if ((lookup.may_be_hidden(x) && lookup.hidden(x, end)) || !is_inside(place) ||
            keep<dim>(domain.grid, begin, place, particle, particle))
          continue;
        post.put(place, particle.radius);
        gone.push_back(batch.places[i]);
      }
    });
    remove_places(gone, particles);
  }
  post.deliver(tiles);
}

template void shift_particles<2>(const MacDomain<2>&, const SolidCells<2>&, KeptSurface<2>&,
                                 const VolumeShift&, const CellField&, ParticleTiles<2>&);
template void shift_particles<3>(const MacDomain<3>&, const SolidCells<3>&, KeptSurface<3>&,
                                 const VolumeShift&, const CellField&, ParticleTiles<3>&);
template GlobalIndex move_particles<2>(const MacDomain<2>&, TransportFrame<2>&, const RayHalo<2>&,
                                       ParticleTiles<2>&);
template GlobalIndex move_particles<3>(const MacDomain<3>&, TransportFrame<3>&, const RayHalo<3>&,
                                       ParticleTiles<3>&);

}  // namespace lockstep
