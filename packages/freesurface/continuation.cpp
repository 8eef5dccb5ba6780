#include "freesurface/continuation.hpp"

#include <algorithm>

namespace lockstep {

namespace {
/// Beyond a shell that comes first lies other fluid than what is around the solid.
template <int dim>
class Neighbors {
 public:
  Neighbors(const MacDomain<dim>& domain, const SolidCells<dim>& solids)
      : grid_(domain.grid), solids_(solids) {
    for (const SolidDescription& solid : solids.state.surface->solids())
      has_shells_ = has_shells_ || !solid.closed;
  }
  /// The neighbour of a solid cell, or -1 if it is fluid that a shell hides.
  int operator()(int cell, int axis, int side) const {
    const int other = grid_.neighbor(cell, axis, side);
    if (!has_shells_ || other < 0 || !solids_.is_fluid(other))
      return other;
    const SurfaceSnapshot<dim>& surface = *solids_.state.surface;
    const Point<dim> x = grid_.center(cell);
    const auto hit =
        surface.first_hit(x + (side == 0 ? -1 : 1) * grid_.spacing() * Point<dim>::Unit(axis), x);
    return hit && !surface.solids()[surface.solid_of(hit->simplex)].closed ? -1 : other;
  }

 private:
  const TiledGrid<dim>& grid_;
  const SolidCells<dim>& solids_;
  bool has_shells_ = false;
};

/// Owned solid cells that have a fluid neighbour.
template <int dim>
std::vector<int> first_front(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                             const Neighbors<dim>& neighbor) {
  std::vector<int> front;
  domain.grid.for_each_owned_cell([&](int cell) {
    if (solids.state.cells[cell] != CellState::solid)
      return;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = neighbor(cell, i / 2, i % 2);
      if (other >= 0 && solids.is_fluid(other)) {
        front.push_back(cell);
        return;
      }
    }
  });
  return front;
}

/// What a set neighbour leads to, along the axis from it to the cell.
template <int dim>
double led_to(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
              const std::vector<char>& is_set, const CellField& phi, int other, int axis,
              int side) {
  const int beyond = domain.grid.neighbor(other, axis, side);
  if (beyond < 0 || !is_set[beyond])
    return phi[other];
  if (solids.is_fluid(other) && solids.seen_neighbor(domain.grid, other, axis, side) < 0)
    return phi[other];
  const double h = domain.spacing();
  return phi[other] + std::clamp(phi[other] - phi[beyond], -h, h);
}
}  // namespace

template <int dim>
void continue_into_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids, int depth,
                          double cut_off, CellField& phi) {
  const TiledGrid<dim>& grid = domain.grid;
  if (!solids.state.surface)
    return;
  std::vector<char> is_set(grid.n_stored_cells());
  for (std::size_t cell = 0; cell < is_set.size(); ++cell)
    is_set[cell] = solids.is_fluid(static_cast<int>(cell));
  const Neighbors<dim> neighbor(domain, solids);
  std::vector<int> front = first_front(domain, solids, neighbor);
  std::vector<double> values;
  for (int layer = 0; layer < depth; ++layer) {
    values.clear();
    for (const int cell : front) {
      double sum = 0;
      int n = 0;
      for (int i = 0; i < 2 * dim; ++i) {
        const int other = neighbor(cell, i / 2, i % 2);
        if (other < 0 || !is_set[other])
          continue;
        sum += led_to(domain, solids, is_set, phi, other, i / 2, i % 2);
        ++n;
      }
      values.push_back(std::clamp(sum / n, -cut_off, cut_off));
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
      phi[front[i]] = values[i];
      is_set[front[i]] = 1;
    }
    domain.full_halo.fill(phi);
    domain.full_halo.fill(is_set);
    std::vector<int> next;
    grid.for_each_owned_cell([&](int cell) {
      if (is_set[cell] || solids.state.cells[cell] != CellState::solid)
        return;
      for (int i = 0; i < 2 * dim; ++i) {
        const int other = neighbor(cell, i / 2, i % 2);
        if (other >= 0 && is_set[other]) {
          next.push_back(cell);
          return;
        }
      }
    });
    front.swap(next);
  }
}

template void continue_into_solids<2>(const MacDomain<2>&, const SolidCells<2>&, int, double,
                                      CellField&);
template void continue_into_solids<3>(const MacDomain<3>&, const SolidCells<3>&, int, double,
                                      CellField&);

}  // namespace lockstep
