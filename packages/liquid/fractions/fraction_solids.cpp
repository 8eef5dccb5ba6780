#include "liquid/fractions/fraction_solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/solid_volume.hpp"

namespace lockstep {

namespace {
/// Cells that a surface may sweep over at once, one behind the other.
constexpr int deepest_sweep = 8;
/// Largest distance of liquid from a surface that takes it along [cells].
constexpr double farthest_taken = 16;

/// Calls f(other) for the fluid cells beside one that a closed solid holds.
template <int dim, typename Function>
void for_each_fluid_neighbor(const TiledGrid<dim>& grid, const SolidCells<dim>& solids, int cell,
                             const Function& f) {
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = grid.neighbor(cell, i / 2, i % 2);
    if (other >= 0 && solids.is_fluid(other))
      f(other);
  }
}
/// Liquid that a surface took along, and where to [m].
template <int dim>
struct Arrival {
  Point<dim> place;
  double liquid = 0, defect = 0;
};

/// Gathers the arrivals of all ranks, in their order, on every rank.
template <int dim>
std::vector<Arrival<dim>> gather_arrivals(const Communicator& comm,
                                          const std::vector<Arrival<dim>>& mine) {
  std::vector<double> flat;
  for (const Arrival<dim>& arrival : mine) {
    flat.insert(flat.end(), arrival.place.data(), arrival.place.data() + dim);
    flat.insert(flat.end(), {arrival.liquid, arrival.defect});
  }
  std::vector<Arrival<dim>> all;
  const std::vector<double> sent = gather_all(comm, flat);
  for (auto value = sent.begin(); value != sent.end(); value += dim + 2) {
    all.push_back({Point<dim>::Zero(), value[dim], value[dim + 1]});
    std::copy(value, value + dim, all.back().place.data());
  }
  return all;
}

struct SeenCell {
  int cell = -1;
  double distance = 0;  ///< distance of its centre [m]
  int number = 0;       ///< among those around: decides between equals on any number of ranks
};

/// The owned fluid cell with the nearest centre that is seen from x, of that which holds x and
/// those around; cell -1 if there is none.
template <int dim>
SeenCell cell_seen_from(const Point<dim>& x, const TiledGrid<dim>& grid,
                        const SolidCells<dim>& solids, const NearbySurface<dim>& surface) {
  const Point<dim> inside = grid.wrap(x);
  Index<dim> middle;
  for (int a = 0; a < dim; ++a) {
    const double position = (inside[a] - grid.lower()[a]) / grid.spacing();
    // Rounding may leave a wrapped place a hair below the period, or at its end.
    const double margin = grid.description().periodic[a] ? 0.5 : 0;
    if (!(position >= -margin && position < grid.n_cells()[a] + margin))
      return {};
    middle[a] = static_cast<int>(std::floor(position));
  }
  SeenCell best;
  for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
    Index<dim> at = middle;
    for (int a = 0, rest = k; a < dim; ++a, rest /= 3)
      at[a] += rest % 3 - 1;
    const int cell = grid.cell(at);
    if (cell < 0 || !grid.owned(cell) || !grid.in_domain(cell) || !solids.is_fluid(cell))
      continue;
    const Point<dim> center = grid.lattice().center(at) + (x - inside);
    const double distance = (center - x).norm();
    if (best.cell < 0 || distance < best.distance)
      if (surface.empty() || !surface.first_hit(x, center))
        best = {cell, distance, k};
  }
  return best;
}

/// For each place, the same on all ranks, the nearest of the cells seen from there on all ranks, if
/// it is owned; -1 if not. `nobody_sees`: of each place.
template <int dim>
std::vector<int> cells_to_arrive_in(const std::vector<Arrival<dim>>& arrivals,
                                    const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                                    const NearbySurface<dim>& surface,
                                    std::vector<char>& nobody_sees) {
  std::vector<int> cells(arrivals.size(), -1);
  std::vector<double> seen;  // arrival, distance, number, rank
  const int rank = grid.comm()->getRank();
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const SeenCell best = cell_seen_from<dim>(arrivals[i].place, grid, solids, surface);
    cells[i] = best.cell;
    if (best.cell >= 0)
      seen.insert(seen.end(), {static_cast<double>(i), best.distance,
                               static_cast<double>(best.number), static_cast<double>(rank)});
  }
  const std::vector<double> all = gather_all(grid.comm(), seen);
  constexpr double nobody = -1;
  std::vector<std::array<double, 3>> nearest(arrivals.size(), {0, 0, nobody});
  for (auto value = all.begin(); value != all.end(); value += 4) {
    std::array<double, 3>& best = nearest[static_cast<std::size_t>(value[0])];
    const std::array<double, 3> other{value[1], value[2], value[3]};
    if (best[2] == nobody || other < best)
      best = other;
  }
  nobody_sees.assign(arrivals.size(), 0);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    nobody_sees[i] = nearest[i][2] == nobody;
    if (nearest[i][2] != rank)
      cells[i] = -1;
  }
  return cells;
}
}  // namespace

template <int dim>
CellField open_parts(const MacDomain<dim>& domain, const SolidCells<dim>& solids) {
  CellField open;
  if (!solids.state.surface)
    return open;
  open.assign(domain.grid.n_stored_cells(), 1.0);
  const Point<dim> half = Point<dim>::Constant(0.5 * domain.spacing());
  domain.grid.for_each_owned_cell([&](int cell) {
    if (solids.near[cell]) {
      const Point<dim> center = domain.grid.center(cell);
      const double solid =
          solid_volume_in_box<dim>(*solids.state.surface, Box<dim>(center - half, center + half));
      open[cell] = std::clamp(1 - solid / domain.cell_volume(), 0.0, 1.0);
    } else if (!solids.is_fluid(cell)) {
      open[cell] = 0;
    }
  });
  domain.full_halo.fill(open);
  return open;
}

template <int dim>
void bring_out_of_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  CellField share(fractions.defect.size(), 0.0);
  grid.for_each_owned_cell([&](int cell) {
    if (solids.is_fluid(cell) || fractions.defect[cell] == 0)
      return;
    int n = 0;
    for_each_fluid_neighbor(grid, solids, cell, [&](int) { ++n; });
    if (n == 0)
      return;
    share[cell] = fractions.defect[cell] / n;
    fractions.defect[cell] = 0;
  });
  domain.halo.fill(share);
  grid.for_each_stored_cell([&](int cell) {
    if (share[cell] != 0)
      for_each_fluid_neighbor(grid, solids, cell, [&](int other) {
        if (grid.owned(other))
          fractions.defect[other] += share[cell];
      });
  });
}

template <int dim>
std::vector<TakenLiquid> give_up_cells(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                       std::vector<char>& leaves, Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  domain.halo.fill(leaves);
  // distance in cells to the nearest cell that stays
  std::vector<int> layer(leaves.size(), 0), donors;
  grid.for_each_stored_cell([&](int cell) {
    if (!leaves[cell])
      return;
    layer[cell] = deepest_sweep + 1;
    donors.push_back(cell);
  });
  const auto for_each_nearer = [&](int cell, const auto& f) {
    for (int i = 0; i < 2 * dim; ++i)
      if (const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
          other >= 0 && layer[other] == layer[cell] - 1)
        f(other);
  };
  for (int depth = 1; depth <= deepest_sweep; ++depth) {
    for (const int cell : donors)
      for (int i = 0; grid.owned(cell) && i < 2 * dim && layer[cell] > depth; ++i)
        if (const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
            other >= 0 && layer[other] == depth - 1)
          layer[cell] = depth;
    domain.halo.fill(layer);
  }
  std::vector<TakenLiquid> stranded;
  CellField share(leaves.size(), 0.0);
  for (int depth = deepest_sweep + 1; depth > 0; --depth) {
    for (const int cell : donors) {
      if (!grid.owned(cell) || layer[cell] != depth)
        continue;
      const double liquid = fractions.liquid[cell] * fractions.open_part(cell);
      const double defect = fractions.defect[cell], amount = liquid + defect;
      fractions.defect[cell] = fractions.liquid[cell] = 0;
      int n = 0;
      if (depth <= deepest_sweep)
        for_each_nearer(cell, [&](int) { ++n; });
      share[cell] = n > 0 ? amount / n : 0;
      if (n == 0 && (liquid != 0 || defect != 0))
        stranded.push_back({cell, liquid, defect});
    }
    domain.halo.fill(share);
    for (const int cell : donors)
      if (layer[cell] == depth && depth <= deepest_sweep)
        for_each_nearer(cell, [&](int other) {
          if (grid.owned(other))
            fractions.defect[other] += share[cell];
        });
  }
  return stranded;
}

template <int dim>
double take_along(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                  const InterfaceStep<dim>& step, const std::vector<TakenLiquid>& taken,
                  Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  const MovingSurface<dim>& surface = step.surface;
  const auto after = step.kept.of(solids.state.surface, grid, 2);
  std::vector<Arrival<dim>> mine;
  double lost = 0;
  for (const TakenLiquid& part : taken) {
    const Point<dim> x = grid.center(part.cell);
    const auto nearest =
        surface.before ? surface.before->closest(x, farthest_taken * grid.spacing()) : std::nullopt;
    if (nearest)
      mine.push_back({x + step.dt * surface.velocity(*nearest), part.liquid, part.defect});
    else
      lost += part.liquid + part.defect;
  }
  lost = sum_all(grid.comm(), lost);
  const std::vector<Arrival<dim>> all = gather_arrivals<dim>(grid.comm(), mine);
  std::vector<char> nobody_sees;
  const std::vector<int> cells = cells_to_arrive_in<dim>(all, grid, solids, *after, nobody_sees);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (nobody_sees[i])
      lost += all[i].liquid + all[i].defect;
    if (cells[i] < 0)
      continue;
    double& liquid = fractions.liquid[cells[i]];
    const double open = fractions.open_part(cells[i]);
    const double taken_in = std::max(0.0, std::min(all[i].liquid, (1 - liquid) * open));
    liquid += taken_in > 0 ? taken_in / open : 0;
    fractions.defect[cells[i]] += all[i].defect + (all[i].liquid - taken_in);
  }
  domain.halo.fill(fractions.liquid);
  return lost;
}

template <int dim>
double share_among_liquid(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                          double volume, Fractions& fractions) {
  if (volume == 0)
    return 0;
  const auto liquid_in = [&](int cell) {
    const double liquid = solids.is_fluid(cell) ? fractions.liquid[cell] : 0;
    return liquid > 0.5 ? liquid * fractions.open_part(cell) : 0;
  };
  double all = 0;
  domain.grid.for_each_owned_cell([&](int cell) { all += liquid_in(cell); });
  all = sum_all(domain.grid.comm(), all);
  if (all == 0)
    return volume;
  domain.grid.for_each_owned_cell(
      [&](int cell) { fractions.defect[cell] += volume * liquid_in(cell) / all; });
  return 0;
}

template CellField open_parts<2>(const MacDomain<2>&, const SolidCells<2>&);
template CellField open_parts<3>(const MacDomain<3>&, const SolidCells<3>&);
template void bring_out_of_solids<2>(const MacDomain<2>&, const SolidCells<2>&, Fractions&);
template void bring_out_of_solids<3>(const MacDomain<3>&, const SolidCells<3>&, Fractions&);
template std::vector<TakenLiquid> give_up_cells<2>(const MacDomain<2>&, const SolidCells<2>&,
                                                   std::vector<char>&, Fractions&);
template std::vector<TakenLiquid> give_up_cells<3>(const MacDomain<3>&, const SolidCells<3>&,
                                                   std::vector<char>&, Fractions&);
template double take_along<2>(const MacDomain<2>&, const SolidCells<2>&, const InterfaceStep<2>&,
                              const std::vector<TakenLiquid>&, Fractions&);
template double take_along<3>(const MacDomain<3>&, const SolidCells<3>&, const InterfaceStep<3>&,
                              const std::vector<TakenLiquid>&, Fractions&);
template double share_among_liquid<2>(const MacDomain<2>&, const SolidCells<2>&, double,
                                      Fractions&);
template double share_among_liquid<3>(const MacDomain<3>&, const SolidCells<3>&, double,
                                      Fractions&);

}  // namespace lockstep
