#include "liquid/common/redistance.hpp"

#include <algorithm>
#include <cmath>

#include "grid/flagged_tiles.hpp"
#include "grid/tile_field.hpp"
#include "staggered/domain/cell_at_side.hpp"

namespace lockstep {

namespace {
constexpr int classes_per_cell = 8;

bool differ(double a, double b) {
  return (a < 0) != (b < 0);
}

/// Along an axis, from the step across the interface and the other one: their mean, to second order
/// where phi is smooth; at a crest, where they cancel, the step across, if that is more. It passes
/// over from one to the other by and by: round-off of a step that is 0 decides nothing.
double slope_across(double across, double other) {
  const double mean = std::abs(0.5 * (across + other));
  const double share = std::clamp(-4 * other / across, 0.0, 1.0);
  return mean + share * std::max(0.0, std::abs(across) - mean);
}

/// Scaled distance |phi| / |grad phi| at a cell beside the interface.
template <int dim>
double scaled(const TiledGrid<dim>& grid, const SolidCells<dim>& solids, const CellField& phi,
              int cell) {
  double squares = 0;
  for (int axis = 0; axis < dim; ++axis) {
    std::array<double, 2> step{};
    std::array<bool, 2> seen{}, across{};
    for (int side = 0; side < 2; ++side) {
      const int other = solids.seen_neighbor(grid, cell, axis, side);
      seen[side] = other >= 0;
      if (!seen[side])
        continue;
      step[side] = side == 0 ? phi[cell] - phi[other] : phi[other] - phi[cell];
      across[side] = differ(phi[cell], phi[other]);
    }
    double slope = std::abs(seen[0] && seen[1] ? 0.5 * (step[0] + step[1]) : step[0] + step[1]);
    for (int side = 0; side < 2; ++side)
      if (across[side])
        slope = std::max(slope, slope_across(step[side], step[1 - side]));
    squares += slope * slope;
  }
  const double h = grid.spacing();
  // A cell with a neighbour beyond the interface is no farther from it than from that one.
  return squares > 0 ? std::min(std::abs(phi[cell]) * h / std::sqrt(squares), h) : h;
}

/// The owned tiles and, on several ranks, the ghosts beside them.
template <int dim>
std::vector<char> with_ghosts(const TiledGrid<dim>& grid, std::vector<char> tiles) {
  tiles.resize(grid.n_tiles(), 1);
  return tiles;
}

/// The distances of the cells of some tiles, found outward from those beside the interface. Cells
/// go by their places in a TileField.
template <int dim>
class March {
 public:
  March(const MacDomain<dim>& domain, const SolidCells<dim>& solids, const std::vector<char>& tiles,
        double cut_off, const CellField& phi)
      : domain_(domain),
        solids_(solids),
        tiles_(with_ghosts(domain.grid, tiles)),
        cut_off_(cut_off),
        phi_(phi),
        distance_(tiles_, cut_off),
        ways_(distance_.end()),
        stays_(distance_.end(), 1),
        waiting_(static_cast<std::size_t>(cut_off * classes_per_cell / domain.spacing()) + 1),
        first_waiting_(waiting_.size()) {}

  void set_near_cells(NearCells near_cells) {
    for_each_stored_cell_of(domain_.grid, tiles_, [&](int cell) {
      if (solids_.is_fluid(cell))
        set_ways(cell, near_cells);
    });
  }
  /// From all that waits, until nothing changes here.
  void go() {
    const double per_class = classes_per_cell / domain_.spacing();
    for (std::size_t k = first_waiting_; k < waiting_.size(); ++k) {
      // The list may grow while it is worked through.
      for (std::size_t i = 0; i < waiting_[k].size(); ++i) {
        const int place = waiting_[k][i];
        if (static_cast<std::size_t>(distance_.at_place(place) * per_class) == k)
          update_around(place);
      }
      waiting_[k].clear();
    }
    first_waiting_ = waiting_.size();
  }
  /// Takes over what other ranks have found; true if any rank has something to do.
  bool take_from_others() {
    const TiledGrid<dim>& grid = domain_.grid;
    if (grid.comm()->getSize() == 1)
      return false;
    const TileField<dim> before = distance_;
    domain_.halo.fill(distance_);
    GlobalIndex n_changed = 0;
    for (int cell = grid.n_owned_cells(); cell < grid.n_stored_cells(); ++cell) {
      if (distance_[cell] >= before[cell] || !solids_.is_fluid(cell))
        continue;
      ++n_changed;
      update_around(distance_.place(cell));
    }
    return sum_all(grid.comm(), n_changed) > 0;
  }
  double distance(int cell) const { return distance_[cell]; }

 private:
  /// Neighbours on the same side of the interface that are seen; 0 where there is none.
  using Ways = std::array<int, 2 * dim>;

  void set_ways(int cell, NearCells near_cells) {
    const TiledGrid<dim>& grid = domain_.grid;
    const int place = distance_.place(cell);
    bool is_near = false;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = solids_.seen_neighbor(grid, cell, i / 2, i % 2);
      const bool is_other_side = other >= 0 && differ(phi_[cell], phi_[other]);
      is_near = is_near || is_other_side || meets_solid(cell, i / 2, i % 2);
      ways_[place][i] =
          other >= 0 && !is_other_side && distance_.has(other) ? distance_.place(other) : 0;
    }
    stays_[place] = !grid.owned(cell);
    if (!grid.owned(cell) || std::abs(phi_[cell]) >= cut_off_ ||
        !(is_near || is_beside_air_that_enters(cell)))
      return;
    distance_.at_place(place) = is_near && near_cells == NearCells::scale
                                    ? scaled(grid, solids_, phi_, cell)
                                    : std::abs(phi_[cell]);
    stays_[place] = 1;
    wait(place);
  }

  /// True if a solid cell is ahead and the interface passes beside it, so that it goes on ahead of
  /// the cell to where it meets the solid, and no neighbour shows it. Where interface and solid
  /// meet at a small angle, that is to be seen some cells aside.
  bool meets_solid(int cell, int axis, int side, int n_aside = 3) const {
    const TiledGrid<dim>& grid = domain_.grid;
    const int ahead = grid.neighbor(cell, axis, side);
    if (ahead < 0 || solids_.state.cells[ahead] != CellState::solid ||
        std::abs(phi_[cell]) >= grid.spacing())
      return false;
    for (int i = 0; i < 2 * dim; ++i) {
      const int beside = i / 2 == axis ? -1 : solids_.seen_neighbor(grid, cell, i / 2, i % 2);
      if (beside < 0 || differ(phi_[cell], phi_[beside]))
        continue;
      const int beyond = solids_.seen_neighbor(grid, beside, axis, side);
      if (beyond >= 0 ? differ(phi_[beside], phi_[beyond])
                      : n_aside > 1 && meets_solid(beside, axis, side, n_aside - 1))
        return true;
    }
    return false;
  }

  /// The interface lies between the cell and an open side, so that no neighbour shows it.
  bool is_beside_air_that_enters(int cell) const {
    return phi_[cell] < 0 && phi_[cell] > -0.5 * domain_.spacing() &&
           at_side(domain_, cell,
                   [](const BoundarySide<dim>& side) { return side.type == SideType::open; });
  }

  /// The smallest distance that the neighbours allow.
  double arrival(int place) const {
    const double h = domain_.spacing();
    std::array<double, dim> least;
    for (int axis = 0; axis < dim; ++axis)
      least[axis] = std::min(distance_.at_place(ways_[place][2 * axis]),
                             distance_.at_place(ways_[place][2 * axis + 1]));
    const auto order = [&](int a, int b) {
      if (least[b] < least[a])
        std::swap(least[a], least[b]);
    };
    order(0, 1);
    if constexpr (dim == 3) {
      order(1, 2);
      order(0, 1);
    }
    // |grad| = 1 with the differences towards the n nearest, as long as these come first.
    double found = least[0] + h, sum = least[0], squares = least[0] * least[0];
    for (int n = 2; n <= dim && found > least[n - 1]; ++n) {
      sum += least[n - 1];
      squares += least[n - 1] * least[n - 1];
      const double discriminant = sum * sum - n * (squares - h * h);
      if (discriminant < 0)
        break;
      found = (sum + std::sqrt(discriminant)) / n;
    }
    return found;
  }

  void wait(int place) {
    const std::size_t k = static_cast<std::size_t>(distance_.at_place(place) *
                                                   (classes_per_cell / domain_.spacing()));
    if (k < waiting_.size())
      waiting_[k].push_back(place);
    first_waiting_ = std::min(first_waiting_, k);
  }

  void update_around(int place) {
    for (const int other : ways_[place]) {
      if (stays_[other] || distance_.at_place(other) <= distance_.at_place(place))
        continue;
      const double found = arrival(other);
      if (found >= distance_.at_place(other))
        continue;
      distance_.at_place(other) = found;
      wait(other);
    }
  }

  const MacDomain<dim>& domain_;
  const SolidCells<dim>& solids_;
  std::vector<char> tiles_;
  double cut_off_;
  const CellField& phi_;
  TileField<dim> distance_;  ///< |phi| as known so far
  std::vector<Ways> ways_;
  std::vector<char> stays_;  ///< near the interface, of another rank, or no cell that is marched to
  /// Places waiting by their distance; each class is an eighth of a cell wide.
  std::vector<std::vector<int>> waiting_;
  std::size_t first_waiting_;
};
}  // namespace

template <int dim>
void redistance(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                const std::vector<char>& tiles, double cut_off, CellField& phi,
                NearCells near_cells) {
  if (solids.has_solids(true))
    domain.full_halo.fill(phi);  // March::meets_solid looks some cells aside
  March<dim> march(domain, solids, tiles, cut_off, phi);
  march.set_near_cells(near_cells);
  do
    march.go();
  while (march.take_from_others());
  for_each_owned_cell_of(domain.grid, tiles, [&](int cell) {
    if (solids.is_fluid(cell))
      phi[cell] = phi[cell] < 0 ? -march.distance(cell) : march.distance(cell);
  });
  domain.halo.fill(phi);
}

template void redistance<2>(const MacDomain<2>&, const SolidCells<2>&, const std::vector<char>&,
                            double, CellField&, NearCells);
template void redistance<3>(const MacDomain<3>&, const SolidCells<3>&, const std::vector<char>&,
                            double, CellField&, NearCells);

}  // namespace lockstep
