#include "freesurface/level_set.hpp"

#include <algorithm>
#include <cmath>

#include "freesurface/band_tiles.hpp"
#include "freesurface/continuation.hpp"
#include "mac/state/stored_fields.hpp"
#include "mac/transport/revalidation.hpp"
#include "mac/transport/transport.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {
/// While the liquid has moved over less than this, phi remains as good a distance as it was
/// [cells].
constexpr double negligible_motion = 0.05;
/// Cells into solids over which phi is continued.
constexpr int depth_in_solids = 4;
}  // namespace

ParameterList level_set_parameters() {
  ParameterList list;
  declare_between(list, "Band", 6, 4, 20,
                  "Cells on both sides of the surface in which its distance is known.");
  return list;
}

LevelSetParameters read_level_set_parameters(const ParameterList& list) {
  LevelSetParameters parameters;
  parameters.band = list.get<int>("Band");
  return parameters;
}

template <int dim>
LevelSet<dim>::LevelSet(const MacDomain<dim>& domain, const LevelSetParameters& parameters)
    : domain_(domain),
      parameters_(parameters),
      phi_(domain.grid.n_stored_cells(), parameters.band * domain.spacing()),
      solids_(find_solid_cells<dim>(domain, nullptr)),
      redistancer_(domain) {}

template <int dim>
int LevelSet<dim>::band(double largest_displacement) const {
  return std::max(parameters_.band, static_cast<int>(std::ceil(largest_displacement)) + 4);
}

template <int dim>
void LevelSet<dim>::find_solids(const Surface& surface) {
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  if (solids_.state.surface != present)
    solids_ = find_solid_cells(domain_, present);
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
  redistancer_.apply(solids_, all, cut_off(), phi_);
  moved_ = 0;
  finish();
}

template <int dim>
void LevelSet<dim>::carry(const InterfaceStep<dim>& step) {
  const TiledGrid<dim>& grid = domain_.grid;
  TransportSetting<dim> setting{grid,          solids_.state, step.surface, step.advection_velocity,
                                step.ray_halo, step.kept,     {},           step.dt};
  Transport<dim> transport(setting);
  const double displacement = transport.largest_displacement();
  moved_ += displacement;
  const std::vector<char> tiles = tiles_near_band(grid, solids_, phi_, cut_off(),
                                                  static_cast<int>(std::ceil(displacement)) + 1);
  CellField carried = phi_;
  transport.advect_scalar(AdvectionScheme::semi_lagrangian, phi_, {}, carried, &tiles);
  phi_.swap(carried);
  const bool had_solids = solids_.state.surface != nullptr;
  find_solids(step.surface.after);
  if (had_solids || solids_.state.surface)
    revalidate_scalar(grid, domain_.halo, solids_.state, step.surface, step.kept,
                      transport.invalid(), grid.spacing(), phi_);
  domain_.halo.fill(phi_);
  if (moved_ < negligible_motion)
    return;
  redistancer_.apply(solids_, tiles, cut_off(), phi_);
  moved_ = 0;
}

template <int dim>
void LevelSet<dim>::advance(const InterfaceStep<dim>& step) {
  find_solids(step.surface.before);
  carry(step);
  finish();
}

template <int dim>
void LevelSet<dim>::finish() {
  domain_.full_halo.fill(phi_);
  continue_into_solids(domain_, solids_, depth_in_solids, cut_off(), phi_);
}

template <int dim>
void LevelSet<dim>::save(CheckpointWriter& checkpoint) const {
  CellField phi = phi_;
  save_fields(domain_, {{"interface_distance", {&phi}}}, checkpoint);
  checkpoint.file().write_attribute("fluid", "interface_moved", moved_);
}

template <int dim>
void LevelSet<dim>::load(const CheckpointReader& checkpoint) {
  load_fields(domain_, {{"interface_distance", {&phi_}}}, checkpoint);
  domain_.full_halo.fill(phi_);
  moved_ = checkpoint.file().read_attribute<double>("fluid", "interface_moved");
}

template <int dim>
std::function<void()> LevelSet<dim>::undo() {
  return [this, phi = phi_, moved = moved_, ledger = ledger_] {
    phi_ = phi;
    moved_ = moved;
    ledger_ = ledger;
  };
}

template class LevelSet<2>;
template class LevelSet<3>;

}  // namespace lockstep
