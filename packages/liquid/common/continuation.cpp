#include "liquid/common/continuation.hpp"

#include <algorithm>
#include <limits>

#include "staggered/state/cell_sides.hpp"

namespace lockstep {

namespace {
/// Neighbours of solid cells. Fluid beyond a shell is other fluid than that around the solid.
template <int dim>
class Neighbors {
 public:
  Neighbors(const MacDomain<dim>& domain, const SolidCells<dim>& solids)
      : grid_(domain.grid), solids_(solids), has_shells_(solids.has_shells()) {}
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
  bool has_shells_;
};

constexpr char no_layer = 127;

/// Keeps, for cells in a solid thinner than they with fluid on both ends of an axis, the neighbours
/// whose fluid reaches into the cell if there are any: between water and air the mean of both sides
/// would tell a pressure in the cut cell that it is in the air. Collective.
template <int dim>
void keep_those_that_reach_in(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                              std::vector<LayerCell>& cells) {
  std::vector<LayerCell*> thin;
  for (LayerCell& at : cells)
    for (int axis = 0; axis < dim; ++axis)
      if ((at.from >> 2 * axis & 3) == 3) {
        thin.push_back(&at);
        break;
      }
  if (max_all(domain.grid.comm(), thin.empty() ? 0. : 1.) == 0)
    return;
  const SurfaceMarks<dim> marks{solids.occluded, solids.near};
  const CellSides<dim> sides(domain, *solids.state.surface, marks, solids.state.cells);
  for (LayerCell* at : thin) {
    unsigned char reach_in = 0;
    for (int i = 0; i < 2 * dim; ++i) {
      const int face = i % 2 == 0 ? at->cell : domain.grid.neighbor(at->cell, i / 2, 1);
      if ((at->from >> i & 1) != 0 && sides.joined(i / 2, face))
        reach_in |= 1 << i;
    }
    if (reach_in != 0)
      at->from = reach_in;
  }
}
}  // namespace

template <int dim>
void Continuation<dim>::find_layers(const MacDomain<dim>& domain, const SolidCells<dim>& solids) {
  const TiledGrid<dim>& grid = domain.grid;
  surface_ = solids.state.surface;
  layers_.assign(n_layers_, {});
  layer_of_.resize(grid.n_stored_cells());
  for (std::size_t cell = 0; cell < layer_of_.size(); ++cell)
    layer_of_[cell] = solids.is_fluid(static_cast<int>(cell)) ? 0 : no_layer;
  std::vector<int> left;
  grid.for_each_owned_cell([&](int cell) {
    if (solids.state.cells[cell] == CellState::solid)
      left.push_back(cell);
  });
  const Neighbors<dim> neighbor(domain, solids);
  for (int layer = 1; layer <= n_layers_; ++layer) {
    std::vector<int> beyond;
    for (const int cell : left) {
      unsigned char from = 0;
      for (int i = 0; i < 2 * dim; ++i) {
        const int other = neighbor(cell, i / 2, i % 2);
        if (other >= 0 && layer_of_[other] < layer)
          from |= 1 << i;
      }
      if (from)
        layers_[layer - 1].push_back({cell, from});
      else
        beyond.push_back(cell);
    }
    if (layer == 1)
      keep_those_that_reach_in(domain, solids, layers_[0]);
    for (const LayerCell& found : layers_[layer - 1])
      layer_of_[found.cell] = static_cast<char>(layer);
    domain.full_halo.fill(layer_of_);
    left.swap(beyond);
  }
}

/// Extrapolates phi linearly from a neighbour, along the axis from it to the cell [m].
template <int dim>
double Continuation<dim>::led_to(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                                 const CellField& phi, int other, int direction, int layer) const {
  const int axis = direction / 2, side = direction % 2;
  const int beyond = grid.neighbor(other, axis, side);
  if (beyond < 0 || layer_of_[beyond] >= layer)
    return phi[other];
  if (solids.is_fluid(other) && solids.seen_neighbor(grid, other, axis, side) < 0)
    return phi[other];
  const double h = grid.spacing();
  return phi[other] + std::clamp(phi[other] - phi[beyond], -h, h);
}

template <int dim>
void Continuation<dim>::into_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                    double cut_off, CellField& phi) {
  if (!solids.state.surface)
    return;
  if (surface_ != solids.state.surface)
    find_layers(domain, solids);
  const TiledGrid<dim>& grid = domain.grid;
  const double h = grid.spacing();
  std::vector<double> values;
  for (int layer = 1; layer <= n_layers_; ++layer) {
    const std::vector<LayerCell>& cells = layers_[layer - 1];
    values.clear();
    for (const LayerCell& at : cells) {
      double least = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 2 * dim; ++i)
        if (at.from >> i & 1)
          least = std::min(least, std::abs(phi[grid.neighbor(at.cell, i / 2, i % 2)]));
      double sum = 0, weights = 0;
      for (int i = 0; i < 2 * dim; ++i)
        if (at.from >> i & 1) {
          const int other = grid.neighbor(at.cell, i / 2, i % 2);
          const double weight = std::max(0.0, 1 - (std::abs(phi[other]) - least) / (0.5 * h));
          sum += weight * led_to(grid, solids, phi, other, i, layer);
          weights += weight;
        }
      values.push_back(std::clamp(sum / weights, -cut_off, cut_off));
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
      phi[cells[i].cell] = values[i];
    domain.full_halo.fill(phi);
  }
}

template class Continuation<2>;
template class Continuation<3>;

}  // namespace lockstep
