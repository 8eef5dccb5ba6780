#include "liquid/fractions/fraction_balance.hpp"

#include <algorithm>
#include <cmath>

#include "grid/flagged_tiles.hpp"
#include "liquid/common/cavities.hpp"

namespace lockstep {

namespace {
/// Reach within which a component takes volume defects [cells].
constexpr int reach_of_labels = 3;
/// Volume defects below this wait for others [cells].
constexpr double negligible_unassigned = 1e-13;
/// Rest of a shift below which no other component takes it over [cells].
constexpr double negligible_left = 1e-6;

/// True if a fluid cell among those around one, corners included, is wet (or is not, like the air
/// beyond open sides).
template <int dim>
bool touches(const MacDomain<dim>& domain, const SolidCells<dim>& solids, const CellField& liquid,
             int cell, bool wet) {
  const TiledGrid<dim>& grid = domain.grid;
  if (!wet && at_open_side(domain, cell))
    return true;
  const Index<dim> place = grid.coordinates(cell);
  for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
    Index<dim> at = place;
    for (int a = 0, rest = k; a < dim; ++a, rest /= 3)
      at[a] += rest % 3 - 1;
    const int other = grid.cell(at);
    if (other >= 0 && other != cell && solids.is_fluid(other) && (liquid[other] > 0.5) == wet)
      return true;
  }
  return false;
}

/// True for a cell more than half full beside one that is not, or the reverse.
template <int dim>
bool is_beside_other(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                     const CellField& liquid, int cell) {
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
    if (other >= 0 && (liquid[cell] > 0.5) != (liquid[other] > 0.5))
      return true;
  }
  return false;
}

/// True for an empty cell beside one that is full but for a thousandth, or the reverse.
template <int dim>
bool is_beside_jump(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                    const CellField& liquid, int cell) {
  constexpr double nearly = 0.999;
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
    if (other >= 0 && std::abs(liquid[other] - liquid[cell]) > nearly)
      return true;
  }
  return false;
}

/// Liquid components and their volume defects [cells].
template <int dim>
class Books {
 public:
  Books(const MacDomain<dim>& domain, const SolidCells<dim>& solids, const CellField& phi,
        Fractions& fractions)
      : domain_(domain), solids_(solids), phi_(phi), fractions_(fractions) {
    std::vector<char> wet(phi.size());
    for (std::size_t cell = 0; cell < phi.size(); ++cell)
      wet[cell] = fractions.liquid[cell] > 0.5;
    CellGroups bodies = find_groups(domain, solids, wet);
    n_ = bodies.n;
    body_ = std::move(bodies.of_cell);
    spread_labels(domain, solids, phi, reach_of_labels, body_);
  }

  Repayment settle(double largest_shift) {
    add_up();
    if (unassigned_ > negligible_unassigned)
      share_out();
    Repayment result{n_, 0};
    std::vector<double> wanted(n_), paid(n_, 0.0);
    ratio_.assign(n_, 0.0);
    double left = 0;
    for (int body = 0; body < n_; ++body) {
      wanted[body] = defect_[body] + share_[body];
      const double room = rooms_[wanted[body] > 0][body];
      if (std::abs(wanted[body]) > negligible_unassigned && room > 0)
        ratio_[body] = std::clamp(wanted[body] / room, -largest_shift, largest_shift);
      paid[body] = ratio_[body] * room;
      left += std::abs(wanted[body] - paid[body]);
    }
    if (left > negligible_left)
      stand_in(largest_shift, wanted, paid);
    for (int body = 0; body < n_; ++body) {
      result.paid += std::abs(paid[body]);
      paid[body] = paid[body] == 0 ? 0 : paid[body] / wanted[body];
    }
    write_off(paid);
    pay();
    return result;
  }

 private:
  /// Capacity of a cell: the liquid it takes (or gives) per cell that the surface moves, roughly
  /// the area of the surface in it [1]. A nearly empty cell beside a fuller one, and the reverse,
  /// has the surface at its side, as has an empty one beside a nearly full one. Other empty cells
  /// above one with a surface take none, and full ones below it give none: a trace in them would
  /// be a second surface.
  double redistribution_weight(int cell, bool takes) const {
    constexpr double at_side = 0.25;  // capacity of either of the two cells at a surface's side
    const double liquid = fractions_.liquid[cell];
    if (is_mixed(liquid)) {
      const bool crosses = is_beside_other(domain_.grid, solids_, fractions_.liquid, cell);
      const double room = takes ? 1 - liquid : liquid;
      return std::max(4 * liquid * (1 - liquid), crosses ? std::min(at_side, 4 * room) : 0);
    }
    const bool can = takes ? liquid < 0.5 : liquid > 0.5;
    const bool near = std::abs(phi_[cell]) < reach_of_labels * domain_.spacing();
    const bool jumps = is_beside_jump(domain_.grid, solids_, fractions_.liquid, cell);
    return can && near && jumps ? at_side : 0;
  }
  void add_up() {
    for (auto* sums : {&defect_, &rooms_[0], &rooms_[1], &share_})
      sums->assign(n_, 0.0);
    domain_.grid.for_each_owned_cell([&](int cell) {
      const double defect = fractions_.defect[cell];
      const int body = body_[cell];
      if (body < 0) {
        unassigned_ += std::abs(defect);
        return;
      }
      defect_[body] += defect;
      if (!solids_.is_fluid(cell))
        return;
      for (const int takes : {0, 1})
        rooms_[takes][body] += redistribution_weight(cell, takes) * fractions_.open_part(cell);
    });
    sum_over_ranks(domain_.grid.comm(), defect_, rooms_, unassigned_);
  }
  void find_spaces() {
    const TiledGrid<dim>& grid = domain_.grid;
    if (!space_of_body_.empty())
      return;
    spaces_ = find_closed_spaces(domain_, solids_);
    // per component; `spaces`: the sum of the numbers of its cells' spaces
    std::vector<double> n_cells(n_, 0.0), spaces(n_, 0.0);
    grid.for_each_owned_cell([&](int cell) {
      const int space = spaces_.of_cell[cell], body = body_[cell];
      if (body < 0 || space < 0)
        return;
      n_cells[body] += 1;
      spaces[body] += space;
    });
    sum_over_ranks(grid.comm(), n_cells, spaces);
    for (int body = 0; body < n_; ++body)
      space_of_body_.push_back(
          static_cast<int>(std::lround(spaces[body] / std::max(n_cells[body], 1.0))));
  }
  /// Shares defects beside no component among the components in the same closed space.
  void share_out() {
    find_spaces();
    defect_in_space_.assign(spaces_.n, 0.0);
    domain_.grid.for_each_owned_cell([&](int cell) {
      if (const int space = spaces_.of_cell[cell]; space >= 0 && body_[cell] < 0)
        defect_in_space_[space] += fractions_.defect[cell];
    });
    sum_over_ranks(domain_.grid.comm(), defect_in_space_);
    const auto room = [&](int body) { return rooms_[defect_in(body) > 0][body]; };
    std::vector<double> rooms(spaces_.n, 0.0);
    for (int body = 0; body < n_; ++body)
      rooms[space_of_body_[body]] += room(body);
    for (int body = 0; body < n_; ++body)
      if (rooms[space_of_body_[body]] > 0)
        share_[body] = defect_in(body) * room(body) / rooms[space_of_body_[body]];
  }
  double defect_in(int body) const { return defect_in_space_[space_of_body_[body]]; }
  /// Bodies of a few cells cannot take all they should at once; others of the same closed space
  /// take it.
  void stand_in(double largest_shift, const std::vector<double>& wanted,
                std::vector<double>& paid) {
    find_spaces();
    std::vector<double> left(spaces_.n, 0.0), can(spaces_.n, 0.0);
    for (int body = 0; body < n_; ++body)
      left[space_of_body_[body]] += wanted[body] - paid[body];
    const auto sign = [&](int body) { return left[space_of_body_[body]] < 0 ? -1 : 1; };
    const auto more = [&](int body) {
      return ratio_[body] * sign(body) < 0 ? 0 : largest_shift - std::abs(ratio_[body]);
    };
    for (int body = 0; body < n_; ++body)
      can[space_of_body_[body]] += more(body) * rooms_[sign(body) > 0][body];
    for (int body = 0; body < n_; ++body) {
      const int space = space_of_body_[body];
      if (can[space] <= 0 || left[space] == 0)
        continue;
      const double part = std::min(1.0, can[space] / std::abs(left[space]));
      paid[body] += part * (wanted[body] - paid[body]);
      ratio_[body] += sign(body) * more(body) * part * std::abs(left[space]) / can[space];
    }
  }
  void write_off(const std::vector<double>& paid) {
    std::vector<double> paid_in_space(defect_in_space_.size(), 0.0);
    for (int body = 0; body < n_ && !paid_in_space.empty(); ++body)
      if (share_[body] != 0)
        paid_in_space[space_of_body_[body]] += share_[body] * paid[body] / defect_in(body);
    domain_.grid.for_each_owned_cell([&](int cell) {
      const int body = body_[cell];
      if (body >= 0)
        fractions_.defect[cell] *= 1 - paid[body];
      else if (!paid_in_space.empty() && spaces_.of_cell[cell] >= 0)
        fractions_.defect[cell] *= 1 - paid_in_space[spaces_.of_cell[cell]];
    });
  }
  void pay() {
    std::vector<std::pair<int, double>> changes;  // a cell's capacity depends on its neighbours
    domain_.grid.for_each_owned_cell([&](int cell) {
      const int body = body_[cell];
      if (body < 0 || ratio_[body] == 0 || !solids_.is_fluid(cell))
        return;
      if (const double most = redistribution_weight(cell, ratio_[body] > 0); most > 0)
        changes.emplace_back(cell, ratio_[body] * most);
    });
    for (const auto& [cell, change] : changes) {
      double& liquid = fractions_.liquid[cell];
      liquid += change;
      if (liquid < negligible_fraction || liquid > 1 - negligible_fraction)
        fractions_.set(cell, liquid < 0.5 ? 0 : 1);
    }
    domain_.halo.fill(fractions_.liquid);
  }

  const MacDomain<dim>& domain_;
  const SolidCells<dim>& solids_;
  const CellField& phi_;
  Fractions& fractions_;
  int n_ = 0;
  std::vector<int> body_;               ///< component beside each stored cell, or -1
  std::vector<double> defect_, share_;  ///< defect beside each component, and its share from afar
  std::vector<double> ratio_;           ///< shift of its surface [cells]
  std::array<std::vector<double>, 2> rooms_;  ///< for giving and for taking
  double unassigned_ = 0;                     ///< defects beside no component
  CellGroups spaces_;
  std::vector<double> defect_in_space_;
  std::vector<int> space_of_body_;
};
}  // namespace

template <int dim>
void remove_fragments(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                      const std::vector<char>& tiles, Fractions& fractions) {
  std::vector<int> fragments;
  for_each_owned_cell_of(domain.grid, tiles, [&](int cell) {
    if (const double liquid = fractions.liquid[cell];
        is_mixed(liquid) && solids.is_fluid(cell) &&
        !touches(domain, solids, fractions.liquid, cell, liquid <= 0.5))
      fragments.push_back(cell);
  });
  for (const int cell : fragments)
    fractions.set(cell, fractions.liquid[cell] > 0.5 ? 1 : 0);
  domain.halo.fill(fractions.liquid);
}

template <int dim>
Repayment pay_back(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, double largest_shift, Fractions& fractions) {
  return Books<dim>(domain, solids, phi, fractions).settle(largest_shift);
}

template <int dim>
double leave_tiles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const std::vector<int>& tiles, Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<char> goes(grid.n_owned_tiles(), 0);
  for (const int tile : tiles)
    goes[tile] = 1;
  const auto is_going = [&](int cell) { return goes[TiledGrid<dim>::tile_of(cell)] != 0; };
  const auto liquid_in = [&](int cell) {
    return fractions.liquid[cell] * fractions.open_part(cell);
  };
  GlobalIndex n_leaving = 0;
  grid.for_each_owned_cell([&](int cell) {
    n_leaving += is_going(cell) && (liquid_in(cell) != 0 || fractions.defect[cell] != 0);
  });
  if (sum_all(grid.comm(), n_leaving) == 0)
    return 0;
  const CellGroups& spaces = find_closed_spaces(domain, solids);
  // defect and liquid in each space; the last: in none
  std::vector<double> taken(spaces.n + 1, 0.0), liquid(spaces.n + 1, 0.0);
  const auto takes = [&](int cell) {
    return !is_going(cell) && spaces.of_cell[cell] >= 0 && fractions.liquid[cell] > 0.5;
  };
  grid.for_each_owned_cell([&](int cell) {
    const int space = spaces.of_cell[cell] < 0 ? spaces.n : spaces.of_cell[cell];
    if (is_going(cell))
      taken[space] += liquid_in(cell) + fractions.defect[cell];
    else if (takes(cell))
      liquid[space] += liquid_in(cell);
  });
  sum_over_ranks(grid.comm(), taken, liquid);
  grid.for_each_owned_cell([&](int cell) {
    if (!takes(cell))
      return;
    const int space = spaces.of_cell[cell];
    fractions.defect[cell] += taken[space] * liquid_in(cell) / liquid[space];
  });
  double lost = 0;
  for (int space = 0; space <= spaces.n; ++space)
    if (liquid[space] == 0)
      lost += taken[space];
  return lost;
}

template void remove_fragments<2>(const MacDomain<2>&, const SolidCells<2>&,
                                  const std::vector<char>&, Fractions&);
template void remove_fragments<3>(const MacDomain<3>&, const SolidCells<3>&,
                                  const std::vector<char>&, Fractions&);
template Repayment pay_back<2>(const MacDomain<2>&, const SolidCells<2>&, const CellField&, double,
                               Fractions&);
template Repayment pay_back<3>(const MacDomain<3>&, const SolidCells<3>&, const CellField&, double,
                               Fractions&);
template double leave_tiles<2>(const MacDomain<2>&, const SolidCells<2>&, const std::vector<int>&,
                               Fractions&);
template double leave_tiles<3>(const MacDomain<3>&, const SolidCells<3>&, const std::vector<int>&,
                               Fractions&);

}  // namespace lockstep
