#include "liquid/fractions/volume_of_fluid.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "liquid/common/band_tiles.hpp"
#include "liquid/common/wet_fraction.hpp"
#include "liquid/fractions/fraction_balance.hpp"
#include "liquid/fractions/fraction_heights.hpp"
#include "liquid/fractions/fraction_solids.hpp"
#include "output/checkpoint.hpp"
#include "staggered/state/stored_fields.hpp"
#include "transport/uncovered_samples.hpp"

namespace lockstep {

namespace {
/// Boxes along each axis into which a cell is cut where a shape is measured.
constexpr int n_cuts = 4;
/// Courant number above which a run has become unstable; its sweeps are about twice as many [1].
constexpr double largest_courant_number = 100;
}  // namespace

ParameterList volume_of_fluid_parameters() {
  ParameterList list;
  declare_choice(list, "Volume Correction", "component", {"component", "none"},
                 "What becomes of liquid and air too thin for a pressure: cells less than half "
                 "full that touch no fuller one, and the reverse. component: it goes to the "
                 "surface of the nearest body; none: it goes on with the flow, where that is "
                 "given.");
  return list;
}

VolumeOfFluidParameters read_volume_of_fluid_parameters(const ParameterList& list) {
  VolumeOfFluidParameters parameters;
  parameters.removes_fragments = list.get<std::string>("Volume Correction") == "component";
  return parameters;
}

template <int dim>
VolumeOfFluid<dim>::VolumeOfFluid(const MacDomain<dim>& domain,
                                  const VolumeOfFluidParameters& parameters)
    : domain_(domain),
      parameters_(parameters),
      phi_(domain.grid.n_stored_cells(), parameters.band * domain.spacing()),
      solids_(find_solid_cells<dim>(domain, nullptr)),
      continuation_(depth_in_solids),
      transport_(domain),
      planes_(domain) {
  fractions_.liquid.assign(phi_.size(), 0);
  fractions_.defect.assign(phi_.size(), 0);
}

template <int dim>
int VolumeOfFluid<dim>::band(double largest_displacement) const {
  return std::max(parameters_.band, static_cast<int>(std::ceil(largest_displacement)) + 4);
}

template <int dim>
std::optional<double> VolumeOfFluid<dim>::curvature(int wet, int axis, int side, double place,
                                                    const CellField& lead) const {
  return FractionHeights<dim>(domain_, solids_, fractions_.liquid, phi_, lead)
      .curvature(wet, axis, side, place);
}

template <int dim>
void VolumeOfFluid<dim>::find_solids(const Surface& surface) {
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  if (solids_.state.surface == present)
    return;
  solids_ = find_solid_cells(domain_, present);
  fractions_.open = open_parts(domain_, solids_);
}

template <int dim>
double VolumeOfFluid<dim>::part_inside(const SignedDistance<dim>& shape, int cell) const {
  const double h = domain_.spacing();
  const Point<dim> center = domain_.grid.center(cell);
  if (const double distance = shape(center); std::abs(distance) > 2 * h)
    return distance < 0 ? 1 : 0;
  constexpr int n_boxes = dim == 2 ? n_cuts * n_cuts : n_cuts * n_cuts * n_cuts;
  double sum = 0;
  for (int box = 0; box < n_boxes; ++box) {
    std::array<double, 1 << dim> corners;
    for (int k = 0; k < 1 << dim; ++k) {
      Point<dim> x = center;
      for (int a = 0, rest = box; a < dim; ++a, rest /= n_cuts) {
        // Corners of the cell count as its own, wherever the shape is another next to it.
        const double place = static_cast<double>(rest % n_cuts + (k >> a & 1)) / n_cuts - 0.5;
        x[a] += place * h * (1 - 1e-9);
      }
      corners[k] = shape(x);
    }
    sum += wet_fraction<dim>(corners);
  }
  return sum / n_boxes;
}

template <int dim>
void VolumeOfFluid<dim>::initialise(const SignedDistance<dim>& distance, const Surface& surface) {
  find_solids(surface);
  domain_.grid.for_each_owned_cell([&](int cell) {
    fractions_.liquid[cell] = solids_.is_fluid(cell) ? part_inside(distance, cell) : 0;
  });
  domain_.halo.fill(fractions_.liquid);
  const std::vector<char> all(domain_.grid.n_owned_tiles(), 1);
  make_distance(all);
  fractions_.defect.assign(phi_.size(), 0);
  n_bodies_ = pay_back(domain_, solids_, phi_, 0, fractions_).n_bodies;
  volume_ = target_ = sum_of_liquid();
  n_sweeps_ = 0;
}

template <int dim>
std::vector<char> VolumeOfFluid<dim>::tiles_within(int reach, bool arrived) const {
  CellField marks = phi_;
  for (std::size_t cell = 0; cell < marks.size(); ++cell)
    if (is_mixed(fractions_.liquid[cell]) ||
        (arrived && (fractions_.liquid[cell] > 0.5) != (phi_[cell] < 0)))
      marks[cell] = 0;
  domain_.full_halo.fill(marks);
  return tiles_near_band(domain_, solids_, marks, cut_off(), reach);
}

template <int dim>
std::vector<char> VolumeOfFluid<dim>::advect(const InterfaceStep<dim>& step) {
  FaceField<dim> velocity = step.advection_velocity;  // upper faces may be another rank's
  domain_.halo.fill(velocity);
  courant_ =
      transport_.courant_number(solids_, tiles_within(1), phi_, cut_off(), velocity, step.dt);
  check_solve(courant_ <= largest_courant_number,
              "Volume of fluid: the velocity carries the liquid's surface over {:g} cells in one "
              "step of {} s, more than {}; the run has become unstable: shorten the time step.",
              courant_, step.dt, largest_courant_number);
  const int n = std::max(1, static_cast<int>(std::ceil(2 * courant_)));
  std::vector<char> tiles = tiles_within(n + 1);
  // Far below the surface, too, cells that solids cut must count the volume that passes by.
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (!solids_.near.empty() && solids_.near[cell] && fractions_.liquid[cell] > 0)
      tiles[TiledGrid<dim>::tile_of(cell)] = 1;
  });
  std::vector<char> is_solved(phi_.size());
  for (std::size_t cell = 0; cell < phi_.size(); ++cell)
    is_solved[cell] = phi_[cell] < 0;
  const FractionFlow<dim> flow{tiles, is_solved, velocity, step.dt / n, step.open};
  double left = 0;
  for (int i = 0; i < n; ++i)
    left += transport_.advance(solids_, flow, static_cast<int>(n_sweeps_++ % dim), fractions_);
  target_ -= sum_all(domain_.grid.comm(), left);
  return tiles;
}

template <int dim>
InvalidSamples<dim> VolumeOfFluid<dim>::find_swept(const InterfaceStep<dim>& step,
                                                   const std::vector<char>& tiles) const {
  TransportSetting<dim> setting{domain_.grid,  solids_.state, step.surface, step.advection_velocity,
                                step.ray_halo, step.kept,     {},           step.dt};
  Transport<dim> transport(setting);
  CellField carried = phi_;
  transport.advect_scalar(AdvectionScheme::semi_lagrangian, phi_, {}, carried, &tiles, cut_off());
  InvalidSamples<dim> invalid = transport.invalid();
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (!solids_.is_fluid(cell))
      invalid.cells[cell] = 1;
  });
  return invalid;
}

template <int dim>
bool VolumeOfFluid<dim>::move_solids(const InterfaceStep<dim>& step,
                                     const std::vector<char>& tiles) {
  const bool had_solids = solids_.state.surface != nullptr;
  if (!had_solids && (!step.surface.after || step.surface.after->empty()))
    return false;
  const InvalidSamples<dim> invalid = find_swept(step, tiles);
  const SolidCells<dim> before = solids_;
  const CellField open_before = fractions_.open;
  find_solids(step.surface.after);
  std::vector<char> leaves(phi_.size(), 0);
  domain_.grid.for_each_owned_cell([&](int cell) {
    leaves[cell] = before.is_fluid(cell) && (invalid.cells[cell] || !solids_.is_fluid(cell));
  });
  CellField open = open_before;
  open.swap(fractions_.open);
  const auto taken = give_up_cells(domain_, before, leaves, fractions_);
  open.swap(fractions_.open);
  CellField& liquid = fractions_.liquid;
  domain_.grid.for_each_owned_cell([&](int cell) {
    const double part_before = open_before.empty() ? 1 : open_before[cell];
    fractions_.defect[cell] += liquid[cell] * (part_before - fractions_.open_part(cell));
  });
  const CellField kept = liquid;
  populate_uncovered_scalar<dim>(
      {domain_.grid, domain_.halo, solids_.state, step.surface, step.kept, invalid}, 0, liquid);
  domain_.grid.for_each_owned_cell([&](int cell) {
    fractions_.defect[cell] += (kept[cell] - liquid[cell]) * fractions_.open_part(cell);
  });
  const bool takes_along = sum_all(domain_.grid.comm(), static_cast<GlobalIndex>(taken.size())) > 0;
  if (takes_along) {
    double gone = take_along(domain_, solids_, step, taken, fractions_);
    if (!solids_.has_shells())
      gone = share_among_liquid(domain_, solids_, gone, fractions_);
    target_ -= gone;
    lost_ += gone;
  }
  bring_out_of_solids(domain_, solids_, fractions_);
  return takes_along;
}

template <int dim>
void VolumeOfFluid<dim>::add_sources(const InterfaceStep<dim>& step) {
  double change = 0;
  const auto set = [&](const std::vector<SignedDistance<dim>>& shapes, bool fills) {
    domain_.grid.for_each_owned_cell([&](int cell) {
      double& liquid = fractions_.liquid[cell];
      if (!solids_.is_fluid(cell))
        return;
      const double before = liquid;
      for (const SignedDistance<dim>& shape : shapes) {
        const double part = part_inside(shape, cell);
        liquid = fills ? std::max(liquid, part) : std::min(liquid, 1 - part);
      }
      change += (liquid - before) * fractions_.open_part(cell);
    });
  };
  if (!step.sinks.empty())
    set(step.sinks, false);
  if (!step.sources.empty())
    set(step.sources, true);
  target_ += sum_all(domain_.grid.comm(), change);
  domain_.halo.fill(fractions_.liquid);
}

template <int dim>
void VolumeOfFluid<dim>::make_distance(const std::vector<char>& tiles) {
  const double h = domain_.spacing();
  planes_.find(solids_, tiles, fractions_.liquid);
  planes_.set_distance(solids_, tiles, fractions_.liquid, cut_off(), phi_);
  redistance(domain_, solids_, tiles, cut_off(), phi_, NearCells::keep);
  domain_.full_halo.fill(phi_);
  if (!solids_.state.surface) {
    domain_.full_halo.fill(fractions_.liquid);
    return;
  }
  continuation_.into_solids(domain_, solids_, cut_off(), phi_);
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (!solids_.is_fluid(cell))
      fractions_.set(cell, std::clamp(0.5 - phi_[cell] / h, 0.0, 1.0));
  });
  domain_.full_halo.fill(fractions_.liquid);
  bring_out_of_solids(domain_, solids_, fractions_);
}

template <int dim>
double VolumeOfFluid<dim>::sum_of_liquid() const {
  double sum = 0;
  domain_.grid.for_each_owned_cell(
      [&](int cell) { sum += fractions_.liquid[cell] * fractions_.open_part(cell); });
  return sum_all(domain_.grid.comm(), sum);
}

template <int dim>
void VolumeOfFluid<dim>::advance(const InterfaceStep<dim>& step) {
  find_solids(step.surface.before);
  std::vector<char> tiles = advect(step);
  if (move_solids(step, tiles)) {
    const std::vector<char> reached = tiles_within(parameters_.band + 1, true);
    for (std::size_t tile = 0; tile < tiles.size(); ++tile)
      tiles[tile] = tiles[tile] || reached[tile];
  }
  if (!step.sources.empty() || !step.sinks.empty()) {
    add_sources(step);
    tiles.assign(tiles.size(), 1);
  }
  if (parameters_.removes_fragments)
    remove_fragments(domain_, solids_, tiles, fractions_);
  // A surface that takes a cell's centre hands its liquid on as a defect, and the fractions
  // continued into the solid fill it again with the opposite one: paid apart, the two would raise
  // and lower a whole component by what has not moved.
  if (solids_.has_solids(true))
    make_distance(tiles);
  const Repayment repayment = pay_back(
      domain_, solids_, phi_, parameters_.largest_shift * std::max(1.0, courant_), fractions_);
  n_bodies_ = repayment.n_bodies;
  paid_ += repayment.paid;
  make_distance(tiles);
  volume_ = sum_of_liquid();
}

template <int dim>
LiquidLedger VolumeOfFluid<dim>::ledger() const {
  const double cell = domain_.cell_volume();
  return {volume_ * cell, target_ * cell, paid_ * cell, lost_ * cell, n_bodies_};
}

template <int dim>
WatchedLiquid VolumeOfFluid<dim>::liquid_in(const std::vector<char>& cells) const {
  double liquid = 0, defect = 0;  // [cells]
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (!cells[cell])
      return;
    liquid += fractions_.liquid[cell] * fractions_.open_part(cell);
    defect += fractions_.defect[cell];
  });
  sum_over_ranks(domain_.grid.comm(), liquid, defect);
  const double cell = domain_.cell_volume();
  return {liquid * cell, (liquid + defect) * cell};
}

template <int dim>
void VolumeOfFluid<dim>::save(CheckpointWriter& checkpoint) const {
  CellField phi = phi_, liquid = fractions_.liquid, defect = fractions_.defect;
  save_fields(
      domain_,
      {{"interface_distance", {&phi}}, {"liquid_part", {&liquid}}, {"liquid_defect", {&defect}}},
      checkpoint);
  checkpoint.file().write_replicated(
      "fluid/liquid_ledger",
      std::vector<double>{static_cast<double>(n_sweeps_), static_cast<double>(n_bodies_), volume_,
                          target_, paid_, lost_});
}

template <int dim>
void VolumeOfFluid<dim>::load(const CheckpointReader& checkpoint) {
  load_fields(domain_,
              {{"interface_distance", {&phi_}},
               {"liquid_part", {&fractions_.liquid}},
               {"liquid_defect", {&fractions_.defect}}},
              checkpoint);
  domain_.full_halo.fill({&phi_, &fractions_.liquid});
  const auto numbers = checkpoint.file().read_all<double>("fluid/liquid_ledger");
  checkpoint.check(numbers.size() == 6 && numbers[0] >= 0 && numbers[1] >= 0 && numbers[1] < 1e9,
                   "its ledger of the liquid is incomplete");
  n_sweeps_ = static_cast<long long>(numbers[0]);
  n_bodies_ = static_cast<int>(numbers[1]);
  volume_ = numbers[2];
  target_ = numbers[3];
  paid_ = numbers[4];
  lost_ = numbers[5];
}

template <int dim>
std::function<void()> VolumeOfFluid<dim>::migrate(const TileMigration<dim>& migration) {
  const double lost = leave_tiles(domain_, solids_, migration.gone(), fractions_);
  target_ -= lost;
  lost_ += lost;
  migration.move(phi_, cut_off());
  migration.move(fractions_.liquid);
  migration.move(fractions_.defect);
  return [this] {
    solids_ = find_solid_cells(domain_, solids_.state.surface);
    continuation_.forget_layers();
    fractions_.open = open_parts(domain_, solids_);
  };
}

template class VolumeOfFluid<2>;
template class VolumeOfFluid<3>;

}  // namespace lockstep
