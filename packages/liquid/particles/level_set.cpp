#include "liquid/particles/level_set.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "liquid/common/band_tiles.hpp"
#include "liquid/common/cavities.hpp"
#include "liquid/common/redistance.hpp"
#include "liquid/particles/drop_births.hpp"
#include "liquid/particles/particle_correction.hpp"
#include "liquid/particles/particle_motion.hpp"
#include "liquid/particles/particle_seeding.hpp"
#include "liquid/particles/particle_storage.hpp"
#include "output/checkpoint.hpp"
#include "staggered/state/stored_fields.hpp"
#include "transport/transport.hpp"
#include "transport/uncovered_samples.hpp"

namespace lockstep {

namespace {
/// While the liquid has moved over less than this, phi remains as good a distance as it was
/// [cells].
constexpr double negligible_motion = 0.05;
}  // namespace

template <int dim>
ParameterList level_set_parameters() {
  ParameterList list;
  declare_at_least(list, "Smallest Cavity", dim == 2 ? 8 : 27, 0,
                   "Largest air bubble, in cells, that is filled if liquid touches it: it would "
                   "drain the liquid around it. 0: none is.");
  declare_volume_correction(list);
  return list;
}

template <int dim>
ParameterList particle_level_set_parameters() {
  ParameterList list = level_set_parameters<dim>();
  declare_particles(list);
  return list;
}

LevelSetParameters read_level_set_parameters(const ParameterList& list) {
  LevelSetParameters parameters;
  parameters.smallest_cavity = list.get<int>("Smallest Cavity");
  parameters.volume = read_volume_correction(list);
  if (list.isParameter("Drops"))
    parameters.particles = read_particles(list);
  check_input(!parameters.particles || !parameters.particles->drops ||
                  parameters.volume.correction != VolumeCorrection::none,
              "{}: \"Drops\" take their volume from the liquid and give it back, which \"Volume "
              "Correction\" = none does not let them; take component or global, or no drops.",
              list.name());
  return parameters;
}

template <int dim>
LevelSet<dim>::LevelSet(const MacDomain<dim>& domain, const LevelSetParameters& parameters)
    : domain_(domain),
      parameters_(parameters),
      phi_(domain.grid.n_stored_cells(), parameters.band * domain.spacing()),
      solids_(find_solid_cells<dim>(domain, nullptr)),
      continuation_(depth_in_solids),
      volume_(domain, parameters.volume),
      particles_(domain.grid.n_owned_tiles()),
      in_band_(domain.grid.n_owned_cells(), 0) {
  if (parameters_.particles && parameters_.particles->drops)
    drops_ = std::make_unique<Drops<dim>>(domain);
}

template <int dim>
int LevelSet<dim>::band(double largest_displacement) const {
  return std::max(parameters_.band, static_cast<int>(std::ceil(largest_displacement)) + 4);
}

template <int dim>
std::optional<SolidCells<dim>> LevelSet<dim>::find_solids(const Surface& surface) {
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  if (solids_.state.surface == present)
    return {};
  std::optional<SolidCells<dim>> before = std::move(solids_);
  solids_ = find_solid_cells(domain_, present);
  return before;
}

template <int dim>
void LevelSet<dim>::initialise(const SignedDistance<dim>& distance, const Surface& surface) {
  const TiledGrid<dim>& grid = domain_.grid;
  find_solids(surface);
  // Cells beside a jump of what is no distance must count as the band's.
  const double most = (1 - 1e-6) * cut_off();
  grid.for_each_owned_cell(
      [&](int cell) { phi_[cell] = std::clamp(distance(grid.center(cell)), -most, most); });
  domain_.full_halo.fill(phi_);
  const std::vector<char> all(grid.n_owned_tiles(), 1);
  redistance(domain_, solids_, all, cut_off(), phi_);
  moved_ = 0;
  settle();
  volume_.begin(solids_, phi_);
  particles_.assign(grid.n_owned_tiles(), {});
  n_restored_ = 0;
  if (drops_)
    drops_->clear();
  KeptSurface<dim> kept;
  seed(kept, true);
}

template <int dim>
double LevelSet<dim>::advect(const InterfaceStep<dim>& step) {
  const TiledGrid<dim>& grid = domain_.grid;
  TransportSetting<dim> setting{grid,          solids_.state, step.surface, step.advection_velocity,
                                step.ray_halo, step.kept,     {},           step.dt};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = domain_.boundary.side(axis, end);
      setting.sides[axis][end].inflow = side.lets_in_air();
      setting.sides[axis][end].closed = side.closed();
    }
  Transport<dim> transport(setting);
  const double displacement = transport.largest_displacement();
  moved_ += displacement;
  const std::vector<char> tiles = tiles_near_band(domain_, solids_, phi_, cut_off(),
                                                  static_cast<int>(std::ceil(displacement)) + 1);
  CellField carried = phi_;
  transport.advect_distance(phi_, cut_off(), tiles, carried);
  phi_.swap(carried);
  if (parameters_.particles)
    n_lost_ += move_particles(domain_, transport.frame(), step.ray_halo, particles_);
  const bool had_solids = solids_.state.surface != nullptr;
  const auto replaced = find_solids(step.surface.after);
  if (had_solids || solids_.state.surface)
    populate_uncovered_scalar<dim>(
        {grid, domain_.halo, solids_.state, step.surface, step.kept, transport.invalid()},
        grid.spacing(), phi_);
  domain_.halo.fill(phi_);
  if (moved_ >= negligible_motion)
    restore(step, tiles);
  settle();
  volume_.inherit(replaced ? *replaced : solids_, solids_, phi_, transport.invalid().cells,
                  static_cast<int>(std::ceil(displacement)) + 1);
  if (drops_)
    release_drops(step, transport.frame());
  return displacement;
}

template <int dim>
void LevelSet<dim>::restore(const InterfaceStep<dim>& step, const std::vector<char>& tiles) {
  const auto correct = [&] {
    if (parameters_.particles)
      correct_by_particles(domain_, solids_, step.kept, particles_, phi_);
  };
  correct();
  redistance(domain_, solids_, tiles, cut_off(), phi_);
  correct();
  fill_small_cavities();
  moved_ = 0;
  ++n_restored_;
  if (!parameters_.particles)
    return;
  remove_trapped_air(domain_, solids_, step.kept, phi_, particles_);
  set_radii<dim>({domain_, solids_, step.kept, phi_}, particles_);
  seed(step.kept, n_restored_ % parameters_.particles->interval == 0);
}

template <int dim>
void LevelSet<dim>::fill_small_cavities() {
  const std::vector<int> filled =
      fill_cavities(domain_, solids_, parameters_.smallest_cavity, phi_);
  if (!parameters_.particles ||
      sum_all(domain_.grid.comm(), static_cast<GlobalIndex>(filled.size())) == 0)
    return;
  std::vector<char> cells(domain_.grid.n_stored_cells(), 0);
  for (const int cell : filled) {
    cells[cell] = 1;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = domain_.grid.neighbor(cell, i / 2, i % 2);
      if (other >= 0 && phi_[other] < 0)
        cells[other] = 1;
    }
  }
  domain_.halo.sum_to_owner(cells);  // particles left beside air at a rank's border would reopen it
  remove_particles(1, cells, particles_);
}

template <int dim>
void LevelSet<dim>::seed(KeptSurface<dim>& kept, bool all) {
  if (!parameters_.particles)
    return;
  domain_.full_halo.fill(phi_);
  seed_particles<dim>({domain_, solids_, kept, phi_}, *parameters_.particles,
                      all ? Seeding::all_cells : Seeding::new_cells, n_restored_, in_band_,
                      particles_);
}

template <int dim>
void LevelSet<dim>::add_sources(const InterfaceStep<dim>& step) {
  // The distance from all of them together, cell by cell.
  const auto distance_from = [&](const std::vector<SignedDistance<dim>>& shapes) {
    CellField distance(phi_.size(), cut_off());
    domain_.grid.for_each_owned_cell([&](int cell) {
      const Point<dim> x = domain_.grid.center(cell);
      for (const SignedDistance<dim>& shape : shapes)
        distance[cell] = std::min(distance[cell], shape(x));
      distance[cell] = std::max(distance[cell], -cut_off());
    });
    domain_.halo.fill(distance);
    return distance;
  };
  const auto take_out = [&](int side, const CellField& distance) {
    std::vector<char> inside(domain_.grid.n_owned_cells());
    for (std::size_t cell = 0; cell < inside.size(); ++cell)
      inside[cell] = distance[cell] < 0;
    remove_particles(side, inside, particles_);
  };
  if (!step.sinks.empty()) {
    const CellField sink = distance_from(step.sinks);
    for (std::size_t cell = 0; cell < phi_.size(); ++cell)
      phi_[cell] = std::max(phi_[cell], -sink[cell]);
    settle();
    volume_.remove(solids_, phi_);
    take_out(-1, sink);
  }
  if (!step.sources.empty()) {
    const CellField source = distance_from(step.sources), before = phi_;
    for (std::size_t cell = 0; cell < phi_.size(); ++cell)
      phi_[cell] = std::min(phi_[cell], source[cell]);
    settle();
    volume_.create(solids_, before, phi_);
    take_out(1, source);
  }
}

template <int dim>
void LevelSet<dim>::release_drops(const InterfaceStep<dim>& step,
                                  const TransportFrame<dim>& frame) {
  std::vector<int> cells;
  std::vector<Drop<dim>> born =
      take_lone_particles<dim>({domain_, solids_, step.kept, phi_}, frame, particles_, cells);
  const double volume = domain_.cell_volume() / parameters_.particles->per_cell;
  const std::vector<double> parts = volume_.take_drops(solids_, phi_, cells, volume);
  for (std::size_t i = 0; i < born.size(); ++i) {
    if (parts[i] == 0)
      continue;
    born[i].volume = parts[i] * volume;
    born[i].next = born[i].velocity + step.dt * step.gravity;
    drops_->add(born[i]);
  }
}

template <int dim>
void LevelSet<dim>::collect_drops(const InterfaceStep<dim>& step) {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto near = step.kept.of(solids_.state.surface, grid, 2);
  for (const SignedDistance<dim>& sink : step.sinks)
    drops_->remove([&](const Drop<dim>& drop) { return sink(drop.position) < 0; });
  std::vector<int> cells;
  std::vector<double> volumes;
  drops_->take([&](const Drop<dim>& drop) {
    const int cell = grid.cell_containing(drop.position);
    if (cell < 0 || !grid.owned(cell) || volume_.groups().of_cell[cell] < 0 ||
        (!near->empty() && near->first_hit(drop.position, grid.center(cell))))
      return false;
    cells.push_back(cell);
    volumes.push_back(drop.volume);
    return true;
  });
  volume_.give_drops(cells, volumes);
  drops_->count();
}

template <int dim>
void LevelSet<dim>::advance(const InterfaceStep<dim>& step) {
  find_solids(step.surface.before);
  if (loaded_) {
    volume_.restore(solids_, phi_, *loaded_);
    loaded_.reset();
  }
  volume_.flow_out(solids_, phi_, step);
  if (drops_)
    volume_.lose(drops_->fly(step.surface, step.gravity, step.dt));
  const double displacement = advect(step);
  add_sources(step);
  if (drops_)
    collect_drops(step);
  const VolumeShift shift = volume_.correct(
      solids_, displacement, cut_off(), [this] { settle(); }, phi_);
  if (parameters_.particles)
    shift_particles(domain_, solids_, step.kept, shift, phi_, particles_);
}

template <int dim>
void LevelSet<dim>::settle() {
  domain_.full_halo.fill(phi_);
  continuation_.into_solids(domain_, solids_, cut_off(), phi_);
}

template <int dim>
void LevelSet<dim>::save(CheckpointWriter& checkpoint) const {
  CellField phi = phi_;
  save_fields(domain_, {{"interface_distance", {&phi}}}, checkpoint);
  const VolumeTargets& targets = loaded_ ? *loaded_ : volume_.targets();
  std::vector<double> numbers = {moved_, static_cast<double>(n_restored_), targets.loose,
                                 targets.lost, targets.shift};
  numbers.insert(numbers.end(), targets.of_group.begin(), targets.of_group.end());
  checkpoint.file().write_replicated("fluid/liquid_ledger", numbers);
  if (parameters_.particles)
    save_particles(domain_, particles_, in_band_, checkpoint);
  if (drops_)
    drops_->save(checkpoint);
}

template <int dim>
void LevelSet<dim>::load(const CheckpointReader& checkpoint) {
  load_fields(domain_, {{"interface_distance", {&phi_}}}, checkpoint);
  domain_.full_halo.fill(phi_);
  const auto numbers = checkpoint.file().read_all<double>("fluid/liquid_ledger");
  checkpoint.check(numbers.size() >= 5, "its ledger of the liquid is incomplete");
  moved_ = numbers[0];
  n_restored_ = static_cast<long long>(numbers[1]);
  loaded_ = VolumeTargets{{numbers.begin() + 5, numbers.end()}, numbers[2], numbers[3], numbers[4]};
  if (parameters_.particles)
    load_particles(domain_, checkpoint, particles_, in_band_);
  if (drops_)
    drops_->load(checkpoint);
}

template <int dim>
std::function<void()> LevelSet<dim>::migrate(const TileMigration<dim>& migration) {
  in_band_.resize(phi_.size(), 0);  // ghosts come from their owners
  migration.move(phi_, cut_off());
  migration.move(in_band_);
  migration.move_lists(particles_);
  return [this] {
    in_band_.resize(domain_.grid.n_owned_cells());
    solids_ = find_solid_cells(domain_, solids_.state.surface);
    continuation_.forget_layers();
    if (!loaded_)
      volume_.restore(solids_, phi_, VolumeTargets(volume_.targets()));
    if (drops_)
      drops_->redistribute();
  };
}

template ParameterList level_set_parameters<2>();
template ParameterList level_set_parameters<3>();
template ParameterList particle_level_set_parameters<2>();
template ParameterList particle_level_set_parameters<3>();
template class LevelSet<2>;
template class LevelSet<3>;

}  // namespace lockstep
