#include "freesurface/redistance.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
constexpr int classes_per_cell = 8;

template <int dim, typename Function>
void for_each_fluid_cell(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                         const std::vector<char>& tiles, const Function& f) {
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
    for (int i = 0, cell = tile * tile_volume<dim>; tiles[tile] && i < tile_volume<dim>;
         ++i, ++cell)
      if (solids.is_fluid(cell))
        f(cell);
}

bool differ(double a, double b) {
  return (a < 0) != (b < 0);
}
}  // namespace

template <int dim>
Redistancer<dim>::Redistancer(const MacDomain<dim>& domain) : domain_(domain) {}

template <int dim>
bool Redistancer<dim>::is_near(const SolidCells<dim>& solids, const CellField& phi,
                               int cell) const {
  for (int axis = 0; axis < dim; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int other = solids.seen_neighbor(domain_.grid, cell, axis, side);
      if (other >= 0 && differ(phi[cell], phi[other]))
        return true;
    }
  return false;
}

template <int dim>
double Redistancer<dim>::scaled(const SolidCells<dim>& solids, const CellField& phi,
                                int cell) const {
  double squares = 0;
  for (int axis = 0; axis < dim; ++axis) {
    std::array<double, 2> step{};
    std::array<bool, 2> seen{}, across{};
    for (int side = 0; side < 2; ++side) {
      const int other = solids.seen_neighbor(domain_.grid, cell, axis, side);
      seen[side] = other >= 0;
      if (!seen[side])
        continue;
      step[side] = side == 0 ? phi[cell] - phi[other] : phi[other] - phi[cell];
      across[side] = differ(phi[cell], phi[other]);
    }
    double slope = seen[0] && seen[1] ? 0.5 * (step[0] + step[1]) : step[0] + step[1];
    if (step[0] * step[1] < 0)
      for (int side = 0; side < 2; ++side)
        if (across[side] && std::abs(step[side]) > std::abs(slope))
          slope = step[side];
    squares += slope * slope;
  }
  const double h = domain_.spacing();
  // A cell with a neighbour beyond the interface is no farther from it than from that one.
  return squares > 0 ? std::min(std::abs(phi[cell]) * h / std::sqrt(squares), h) : h;
}

template <int dim>
double Redistancer<dim>::arrival(const SolidCells<dim>& solids, const CellField& phi,
                                 int cell) const {
  const double h = domain_.spacing();
  std::array<double, dim> least;
  for (int axis = 0; axis < dim; ++axis) {
    least[axis] = cut_off_;
    for (int side = 0; side < 2; ++side) {
      const int other = solids.seen_neighbor(domain_.grid, cell, axis, side);
      if (other >= 0 && !differ(phi[cell], phi[other]))
        least[axis] = std::min(least[axis], distance_[other]);
    }
  }
  std::sort(least.begin(), least.end());
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

template <int dim>
void Redistancer<dim>::wait(int cell) {
  const std::size_t place =
      static_cast<std::size_t>(distance_[cell] * (classes_per_cell / domain_.spacing()));
  if (place < waiting_.size())
    waiting_[place].push_back(cell);
  first_waiting_ = std::min(first_waiting_, place);
}

template <int dim>
void Redistancer<dim>::set_near_cells(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                                      const CellField& phi, NearCells near_cells) {
  for_each_fluid_cell(domain_.grid, solids, tiles, [&](int cell) {
    if (std::abs(phi[cell]) >= cut_off_ || !is_near(solids, phi, cell))
      return;
    distance_[cell] =
        near_cells == NearCells::scale ? scaled(solids, phi, cell) : std::abs(phi[cell]);
    is_set_[cell] = 1;
    wait(cell);
  });
}

template <int dim>
void Redistancer<dim>::update_around(const SolidCells<dim>& solids, const CellField& phi,
                                     int cell) {
  for (int axis = 0; axis < dim; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int other = solids.seen_neighbor(domain_.grid, cell, axis, side);
      if (other < 0 || !domain_.grid.owned(other) || is_set_[other] ||
          distance_[other] <= distance_[cell] || differ(phi[cell], phi[other]))
        continue;
      const double found = arrival(solids, phi, other);
      if (found >= distance_[other])
        continue;
      distance_[other] = found;
      wait(other);
    }
}

template <int dim>
void Redistancer<dim>::march(const SolidCells<dim>& solids, const CellField& phi) {
  const double per_class = classes_per_cell / domain_.spacing();
  for (std::size_t place = first_waiting_; place < waiting_.size(); ++place) {
    // The list may grow while it is worked through.
    for (std::size_t i = 0; i < waiting_[place].size(); ++i) {
      const int cell = waiting_[place][i];
      if (static_cast<std::size_t>(distance_[cell] * per_class) == place)
        update_around(solids, phi, cell);
    }
    waiting_[place].clear();
  }
  first_waiting_ = waiting_.size();
}

template <int dim>
bool Redistancer<dim>::take_from_others(const SolidCells<dim>& solids, const CellField& phi) {
  const TiledGrid<dim>& grid = domain_.grid;
  if (grid.comm()->getSize() == 1)
    return false;
  const std::vector<double> before(distance_.begin() + grid.n_owned_cells(), distance_.end());
  domain_.halo.fill(distance_);
  GlobalIndex n_changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const int cell = grid.n_owned_cells() + static_cast<int>(i);
    if (distance_[cell] >= before[i] || !solids.is_fluid(cell))
      continue;
    ++n_changed;
    update_around(solids, phi, cell);
  }
  return sum_all(grid.comm(), n_changed) > 0;
}

template <int dim>
void Redistancer<dim>::apply(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                             double cut_off, CellField& phi, NearCells near_cells) {
  cut_off_ = cut_off;
  distance_.assign(phi.size(), cut_off);
  is_set_.assign(phi.size(), 0);
  waiting_.resize(static_cast<std::size_t>(cut_off * classes_per_cell / domain_.spacing()) + 1);
  first_waiting_ = waiting_.size();
  set_near_cells(solids, tiles, phi, near_cells);
  do
    march(solids, phi);
  while (take_from_others(solids, phi));
  for_each_fluid_cell(domain_.grid, solids, tiles, [&](int cell) {
    phi[cell] = phi[cell] < 0 ? -distance_[cell] : distance_[cell];
  });
  domain_.halo.fill(phi);
}

template class Redistancer<2>;
template class Redistancer<3>;

}  // namespace lockstep
