#include "mac/viscosity/stress_at_air.hpp"

#include <algorithm>
#include <utility>

namespace lockstep {

template <int dim>
StressAtAir<dim>::StressAtAir(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                              const ViscosityField<dim>& viscosity)
    : domain_(domain), geometry_(geometry), viscosity_(viscosity) {
  std::vector<char> plain(domain.grid.n_stored_cells(), 0);
  domain.grid.for_each_stored_cell([&](int cell) { plain[cell] = is_regular(cell); });
  is_far_from_solids_ = with_marked_surroundings(std::move(plain));
}

template <int dim>
std::vector<char> StressAtAir<dim>::with_marked_surroundings(std::vector<char> marked) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto is_marked = [&](int cell) {
    return cell < 0 || geometry_.state.cells[cell] == CellState::outside || marked[cell] != 0;
  };
  for (int axis = 0; axis < dim; ++axis) {
    std::vector<char> result(marked.size(), 0);
    grid.for_each_stored_cell([&](int cell) {
      result[cell] = marked[cell] != 0 && is_marked(grid.neighbor(cell, axis, 0)) &&
                     is_marked(grid.neighbor(cell, axis, 1));
    });
    marked.swap(result);
  }
  return marked;
}

template <int dim>
bool StressAtAir<dim>::is_definite() const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<char> uniform(grid.n_stored_cells(), 0);
  for (const double viscosity : viscosity_.of_phases()) {
    std::vector<char> full(grid.n_stored_cells(), 0);
    grid.for_each_stored_cell([&](int cell) {
      full[cell] =
          geometry_.state.cells[cell] == CellState::solid || viscosity_.of_cell(cell) == viscosity;
    });
    const std::vector<char> far_from_others = with_marked_surroundings(std::move(full));
    for (std::size_t cell = 0; cell < uniform.size(); ++cell)
      uniform[cell] |= far_from_others[cell];
  }
  GlobalIndex found = fluid_at_open_side() ? 1 : 0;
  grid.for_each_owned_cell([&](int cell) {
    if (is_fluid(cell) && uniform[cell] == 0 && is_far_from_solids_[cell] == 0)
      found = 1;
  });
  return max_all(grid.comm(), found) == 0;
}

/// True if fluid is at an open side on this rank.
template <int dim>
bool StressAtAir<dim>::fluid_at_open_side() const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<std::pair<int, int>> open_layers;  // axis, place along it
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      if (domain_.boundary.side(axis, end).type == SideType::open)
        open_layers.emplace_back(axis, end == 0 ? 0 : grid.n_cells()[axis] - 1);
  bool found = false;
  if (!open_layers.empty())
    grid.for_each_owned_cell([&](int cell) {
      found = found || (is_fluid(cell) &&
                        std::any_of(open_layers.begin(), open_layers.end(), [&](const auto& layer) {
                          return grid.coordinates(cell)[layer.first] == layer.second;
                        }));
    });
  return found;
}

/// Fluid continues beyond a side as before it.
template <int dim>
typename StressAtAir<dim>::Edge StressAtAir<dim>::edge(const FaceId& face, int across,
                                                       int end) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto beside = [&](int cell) {
    const int other = grid.neighbor(cell, across, end);
    return other < 0 || geometry_.state.cells[other] == CellState::outside ? cell : other;
  };
  const int lower = grid.neighbor(face.cell, face.axis, 0), upper = face.cell;
  if (lower < 0 || !is_regular(lower) || !is_regular(upper))
    return Edge::other;
  const int beside_lower = beside(lower), beside_upper = beside(upper);
  if (!is_regular(beside_lower) || !is_regular(beside_upper))
    return Edge::other;
  const bool is_whole = (is_fluid(lower) || is_fluid(upper)) &&
                        (is_fluid(upper) || is_fluid(beside_upper)) &&
                        (is_fluid(beside_upper) || is_fluid(beside_lower)) &&
                        (is_fluid(beside_lower) || is_fluid(lower));
  return is_whole ? Edge::whole : Edge::parted;
}

template <int dim>
bool StressAtAir<dim>::parts(const FaceId& face, int across, int end) const {
  return edge(face, across, end) == Edge::parted;
}

template <int dim>
bool StressAtAir<dim>::has_velocity(int axis, int face) const {
  const FaceState state = geometry_.state.faces[axis][face];
  if (state != FaceState::prescribed)
    return state == FaceState::free;
  const int end = cells_of_face(domain_.grid, geometry_.state.cells, axis, face).lower < 0 ? 0 : 1;
  return domain_.boundary.side(axis, end).type == SideType::inflow;
}

template class StressAtAir<2>;
template class StressAtAir<3>;

}  // namespace lockstep
