#include "mac/viscosity/stress_at_void.hpp"

#include <algorithm>
#include <utility>

namespace lockstep {

namespace {
/// Stored cells all of whose neighbours, those at edges and corners too, are marked, as they are.
template <int dim>
std::vector<char> with_marked_surroundings(const TiledGrid<dim>& grid, std::vector<char> marked) {
  for (int axis = 0; axis < dim; ++axis) {
    std::vector<char> result(marked.size(), 0);
    grid.for_each_stored_cell([&](int cell) {
      const int lower = grid.neighbor(cell, axis, 0), upper = grid.neighbor(cell, axis, 1);
      result[cell] =
          marked[cell] != 0 && lower >= 0 && marked[lower] != 0 && upper >= 0 && marked[upper] != 0;
    });
    marked.swap(result);
  }
  return marked;
}
}  // namespace

template <int dim>
StressAtVoid<dim>::StressAtVoid(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry)
    : domain_(domain), geometry_(geometry), is_plain_(domain.grid.n_stored_cells(), 0) {
  const auto& cells = geometry.state.cells;
  domain.grid.for_each_stored_cell([&](int cell) {
    is_plain_[cell] = (cells[cell] == CellState::fluid || cells[cell] == CellState::empty) &&
                      !geometry.near_surface(cell);
  });
  if (dim == 2)
    return;
  // Each of its faces is free then, and each of its edges known.
  has_divergence_ = with_marked_surroundings(domain.grid, is_plain_);
  for (std::size_t cell = 0; cell < has_divergence_.size(); ++cell)
    has_divergence_[cell] = has_divergence_[cell] != 0 && cells[cell] == CellState::fluid;
}

template <int dim>
typename StressAtVoid<dim>::Edge StressAtVoid<dim>::edge(const FaceId& face, int across,
                                                         int end) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const int lower = grid.neighbor(face.cell, face.axis, 0), upper = face.cell;
  if (lower < 0 || is_plain_[lower] == 0 || is_plain_[upper] == 0)
    return Edge::other;
  const int beside_lower = grid.neighbor(lower, across, end);
  const int beside_upper = grid.neighbor(upper, across, end);
  if (beside_lower < 0 || beside_upper < 0 || is_plain_[beside_lower] == 0 ||
      is_plain_[beside_upper] == 0)
    return Edge::other;
  const bool is_whole = (is_fluid(lower) || is_fluid(upper)) &&
                        (is_fluid(upper) || is_fluid(beside_upper)) &&
                        (is_fluid(beside_upper) || is_fluid(beside_lower)) &&
                        (is_fluid(beside_lower) || is_fluid(lower));
  return is_whole ? Edge::whole : Edge::parted;
}

template <int dim>
bool StressAtVoid<dim>::parts(const FaceId& face, int across, int end) const {
  return edge(face, across, end) == Edge::parted;
}

template <int dim>
bool void_is_clear(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<std::pair<int, int>> open_layers;  // axis, place along it
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      if (domain.boundary.side(axis, end).type == SideType::open)
        open_layers.emplace_back(axis, end == 0 ? 0 : grid.n_cells()[axis] - 1);
  const auto at_open_side = [&](int cell) {
    return std::any_of(open_layers.begin(), open_layers.end(), [&](const auto& layer) {
      return grid.coordinates(cell)[layer.first] == layer.second;
    });
  };
  GlobalIndex found = 0;
  grid.for_each_owned_cell([&](int cell) {
    const CellState state = geometry.state.cells[cell];
    if ((state == CellState::empty && geometry.near_surface(cell)) ||
        (state == CellState::fluid && at_open_side(cell)))
      found = 1;
  });
  return max_all(grid.comm(), found) == 0;
}

template bool void_is_clear<2>(const MacDomain<2>&, const MacGeometry<2>&);
template bool void_is_clear<3>(const MacDomain<3>&, const MacGeometry<3>&);
template class StressAtVoid<2>;
template class StressAtVoid<3>;

}  // namespace lockstep
