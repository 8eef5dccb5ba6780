#include "liquid/gas/gas_bubbles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "staggered/domain/cell_at_side.hpp"

namespace lockstep {

namespace {
/// Part of a bubble's volume defect that a step gives back [1]: less than all, so that the
/// round-off of a surface that moves does not become pressure.
constexpr double part_made_good = 0.1;
/// Gas is not compressed or spread beyond this factor of its volume at the start.
constexpr double most_compressed = 100;

/// Where no point says what the atmosphere is, it is what touches this side of the domain.
template <int dim>
bool at_top(const MacDomain<dim>& domain, const Point<dim>& gravity, int cell) {
  int axis = 0;
  if (gravity.cwiseAbs().maxCoeff(&axis) == 0)
    return false;
  const int last = gravity[axis] < 0 ? domain.grid.n_cells()[axis] - 1 : 0;
  return domain.grid.coordinates(cell)[axis] == last;
}

/// In whose box x is, within the domain or beyond it.
template <int dim>
Index<dim> lattice_cell(const TiledGrid<dim>& grid, const Point<dim>& x) {
  Index<dim> cell;
  for (int a = 0; a < dim; ++a)
    cell[a] = static_cast<int>(std::floor((x[a] - grid.lower()[a]) / grid.spacing()));
  return cell;
}
}  // namespace

template <int dim>
GasBubbles<dim>::GasBubbles(const MacDomain<dim>& domain, GasParameters<dim> parameters,
                            const Point<dim>& gravity)
    : domain_(domain), parameters_(std::move(parameters)), gravity_(gravity), measure_(domain) {
  for (CellField* field : {&number_, &amount_, &last_pressure_})
    field->assign(domain.grid.n_stored_cells(), 0.0);
  for (const Point<dim>& point : parameters_.atmosphere) {
    const int cell = domain.grid.cell_containing(point);
    const bool here = cell >= 0 && domain.grid.owned(cell);
    check_input(sum_all(domain.grid.comm(), static_cast<GlobalIndex>(here)) > 0,
                "The point {} of \"Atmosphere\" in \"Free Surface\" lies outside of the domain.",
                fmt::join(point.data(), point.data() + dim, ", "));
  }
}

template <int dim>
std::vector<char> GasBubbles<dim>::open_groups(const CellGroups& groups,
                                               const CellField& phi) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto is_open_side = [](const auto& side) { return side.type == SideType::open; };
  std::vector<char> is_open(groups.n, 0);
  grid.for_each_owned_cell([&](int cell) {
    if (groups.of_cell[cell] < 0)
      return;
    if (at_side(domain_, cell, is_open_side) ||
        (parameters_.atmosphere.empty() && at_top(domain_, gravity_, cell)))
      is_open[groups.of_cell[cell]] = 1;
  });
  for (const Point<dim>& point : parameters_.atmosphere) {
    const int cell = grid.cell_containing(point);
    if (cell >= 0 && grid.owned(cell) && phi[cell] >= 0 && groups.of_cell[cell] >= 0)
      is_open[groups.of_cell[cell]] = 1;
  }
  max_over_ranks(grid.comm(), is_open);
  return is_open;
}

template <int dim>
std::vector<int> GasBubbles<dim>::choose(const std::vector<char>& is_open,
                                         const std::vector<double>& volumes) const {
  std::vector<int> chosen;
  for (int group = 0; group < static_cast<int>(is_open.size()); ++group)
    if (!is_open[group] && volumes[group] > 0)
      chosen.push_back(group);
  if (chosen.size() > most) {
    std::stable_sort(chosen.begin(), chosen.end(),
                     [&](int a, int b) { return volumes[a] > volumes[b]; });
    chosen.resize(most);
    std::sort(chosen.begin(), chosen.end());
  }
  return chosen;
}

template <int dim>
void GasBubbles<dim>::find(const SolidCells<dim>& voids, const CellField& phi) {
  const TiledGrid<dim>& grid = domain_.grid;
  is_air_.assign(grid.n_stored_cells(), 0);
  CellField height = phi;
  for (std::size_t cell = 0; cell < phi.size(); ++cell) {
    is_air_[cell] = phi[cell] >= 0;
    height[cell] = phi[cell] > 0 ? -phi[cell] : phi[cell] < 0 ? -phi[cell] : -1e-300;
  }
  const CellGroups groups = find_groups(domain_, voids, is_air_);
  const std::vector<char> is_open = open_groups(groups, phi);
  std::vector<int> bubble_of_group(groups.n, -1);
  bubbles_.clear();
  if (std::find(is_open.begin(), is_open.end(), 0) != is_open.end()) {
    measure_.prepare(voids, height);
    const std::vector<double> volumes = measure_.measure(height, groups).volume;
    for (const int group : choose(is_open, volumes)) {
      bubble_of_group[group] = static_cast<int>(bubbles_.size());
      bubbles_.push_back({});
      bubbles_.back().volume = volumes[group];
    }
  }
  of_cell_.assign(grid.n_stored_cells(), -1);
  for (int cell = 0; cell < grid.n_stored_cells(); ++cell) {
    const int group = groups.of_cell[cell];
    is_air_[cell] = group >= 0;
    if (group >= 0)
      of_cell_[cell] = bubble_of_group[group];
  }
}

template <int dim>
void GasBubbles<dim>::pass_over(const MovingSurface<dim>& surface) {
  if (!surface.before || !surface.after || surface.before == surface.after)
    return;
  const TiledGrid<dim>& grid = domain_.grid;
  const SurfaceSnapshot<dim>&before = *surface.before, &after = *surface.after;
  for (int simplex = 0; simplex < before.n_simplices(); ++simplex) {
    Box<dim> box;
    for (const SurfaceSnapshot<dim>* snapshot : {&before, &after})
      for (const Point<dim>& corner : snapshot->corners(simplex))
        box.extend(corner);
    const Index<dim> first = lattice_cell(grid, box.min()), last = lattice_cell(grid, box.max());
    Index<dim> at = first;
    for (bool more = true; more;) {
      const int cell = grid.cell(at);
      if (cell >= 0 && grid.owned(cell) && number_[cell] != 0 &&
          swept_over<dim>(before, after, grid.lattice().center(at), {simplex}))
        number_[cell] = 0;
      more = false;
      for (int a = 0; a < dim && !more; ++a) {
        more = ++at[a] <= last[a];
        if (!more)
          at[a] = first[a];
      }
    }
  }
}

template <int dim>
void GasBubbles<dim>::settle(const CellField& phi) {
  for (GasBubble& bubble : bubbles_)
    bubble.volume = std::max(bubble.volume, 1e-3 * domain_.cell_volume());
  inherit(phi);
  scaled_pressure_.assign(bubbles_.size(), 0);
}

template <int dim>
void GasBubbles<dim>::inherit(const CellField& phi) {
  const TiledGrid<dim>& grid = domain_.grid;
  const int n = static_cast<int>(bubbles_.size());
  double most_number = 0, n_known = 0;
  grid.for_each_owned_cell([&](int cell) {
    most_number = std::max(most_number, number_[cell]);
    n_known += number_[cell] != 0;
  });
  const int n_before = static_cast<int>(max_all(grid.comm(), most_number));
  const bool is_start = sum_all(grid.comm(), n_known) == 0;

  // number of cells that went from each bubble (or the atmosphere, the last) to each (likewise)
  std::vector<double> went((n_before + 1) * (n + 1), 0.0), before(2 * n_before + 1, -1e300);
  grid.for_each_owned_cell([&](int cell) {
    const int from = number_[cell] < 0 ? n_before : static_cast<int>(number_[cell]) - 1;
    if (from >= 0 && from < n_before) {
      before[2 * from] = amount_[cell];
      before[2 * from + 1] = last_pressure_[cell];
    }
    if (from < 0 || !is_air_[cell])
      return;
    const int to = of_cell_[cell] < 0 ? n : of_cell_[cell];
    went[from * (n + 1) + to] += std::clamp(0.5 + phi[cell] / domain_.spacing(), 0.0, 1.0);
  });
  sum_over_ranks(grid.comm(), went);
  max_over_ranks(grid.comm(), before);

  amounts_.assign(n, 0);
  std::vector<double> last(n, 0);
  for (int to = 0; to < n; ++to) {
    double from_bubbles = 0;
    for (int from = 0; from < n_before; ++from)
      from_bubbles += went[from * (n + 1) + to];
    for (int from = 0; from < n_before; ++from) {
      const auto row = went.begin() + from * (n + 1);
      const double all = std::accumulate(row, row + n + 1, 0.0);
      if (row[to] == 0)
        continue;
      amounts_[to] += before[2 * from] * (row[to] / all);
      last[to] += before[2 * from + 1] * (row[to] / from_bubbles);
    }
    const double gained = went[n_before * (n + 1) + to] * domain_.cell_volume();
    if (from_bubbles == 0)
      amounts_[to] = bubbles_[to].volume;
    else
      amounts_[to] += gained;
    if (is_start && parameters_.kind == TrappedAir::ideal_gas)
      amounts_[to] *= std::pow(1 + parameters_.pressure_at_start / parameters_.atmospheric_pressure,
                               1 / parameters_.exponent);
    if (is_start)
      last[to] = parameters_.pressure_at_start;
    bubbles_[to] = bubble_of(bubbles_[to].volume, amounts_[to], last[to]);
  }
  for (int cell = 0; cell < grid.n_stored_cells(); ++cell) {
    const int bubble = of_cell_[cell];
    number_[cell] = bubble >= 0 ? bubble + 1 : is_air_[cell] ? -1 : 0;
    amount_[cell] = bubble >= 0 ? amounts_[bubble] : 0;
    last_pressure_[cell] = bubble >= 0 ? last[bubble] : 0;
  }
}

template <int dim>
GasBubble GasBubbles<dim>::bubble_of(double volume, double amount, double last_pressure) const {
  GasBubble bubble;
  bubble.volume = volume;
  if (parameters_.kind == TrappedAir::constant_volume) {
    bubble.keeps_volume = true;
    bubble.missing = part_made_good * (amount - volume);
    bubble.pressure = last_pressure;
    return bubble;
  }
  const double compressed = std::clamp(amount / volume, 1 / most_compressed, most_compressed);
  const double absolute =
      parameters_.atmospheric_pressure * std::pow(compressed, parameters_.exponent);
  bubble.pressure = absolute - parameters_.atmospheric_pressure;
  bubble.stiffness = parameters_.exponent * absolute / volume;
  return bubble;
}

template <int dim>
void GasBubbles<dim>::fill(const std::vector<double>& of_bubbles, CellField& scaled_pressure) {
  scaled_pressure_ = of_bubbles;
  scaled_pressure_.resize(bubbles_.size(), 0);
  if (bubbles_.empty())
    return;
  for (std::size_t cell = 0; cell < of_cell_.size(); ++cell)
    if (of_cell_[cell] >= 0)
      scaled_pressure[cell] = scaled_pressure_[of_cell_[cell]];
}

template <int dim>
void GasBubbles<dim>::accept(double dt) {
  accepted_pressure_.clear();
  for (std::size_t k = 0; k < bubbles_.size(); ++k) {
    accepted_pressure_.push_back(scaled_pressure_[k] / dt);
    if (bubbles_[k].keeps_volume)  // as a run finds it that goes on from here
      bubbles_[k].pressure = accepted_pressure_[k];
  }
  for (std::size_t cell = 0; cell < of_cell_.size(); ++cell)
    if (of_cell_[cell] >= 0)
      last_pressure_[cell] = scaled_pressure_[of_cell_[cell]] / dt;
}

template <int dim>
GasReport GasBubbles<dim>::report() const {
  GasReport report;
  report.n_bubbles = static_cast<int>(bubbles_.size());
  double largest = 0;
  for (const GasBubble& bubble : bubbles_)
    report.volume += bubble.volume;
  for (std::size_t k = 0; k < bubbles_.size(); ++k)
    if (bubbles_[k].volume > largest) {
      largest = bubbles_[k].volume;
      report.pressure = accepted_pressure_.size() > k ? accepted_pressure_[k] : 0;
    }
  return report;
}

template <int dim>
std::vector<StoredField> GasBubbles<dim>::fields() {
  return {
      {"gas_bubble", {&number_}}, {"gas_amount", {&amount_}}, {"gas_pressure", {&last_pressure_}}};
}

template class GasBubbles<2>;
template class GasBubbles<3>;

}  // namespace lockstep
