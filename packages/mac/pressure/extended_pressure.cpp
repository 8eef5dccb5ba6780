#include "mac/pressure/extended_pressure.hpp"

#include <utility>

namespace lockstep {

template <int dim>
CellField extended_pressure(const MacDomain<dim>& domain, const std::vector<CellState>& now,
                            const std::vector<CellState>& before, CellField pressure,
                            const Point<dim>& gradient, const std::vector<float>& lightness) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<int> missing;
  grid.for_each_owned_cell([&](int cell) {
    if (now[cell] == CellState::fluid && before[cell] != CellState::fluid)
      missing.push_back(cell);
  });
  const auto n_over_ranks = [&](std::size_t n) {
    return sum_all(grid.comm(), static_cast<GlobalIndex>(n));
  };
  if (n_over_ranks(missing.size()) == 0)
    return pressure;

  const double h = grid.spacing();
  std::vector<char> known(before.size());
  for (std::size_t cell = 0; cell < before.size(); ++cell)
    known[cell] = before[cell] == CellState::fluid;
  while (n_over_ranks(missing.size()) > 0) {
    std::vector<std::pair<int, double>> front;
    std::vector<int> behind;
    for (const int cell : missing) {
      double sum = 0;
      int n = 0;
      const double step = lightness.empty() ? h : h / lightness[cell];
      for (int axis = 0; axis < dim; ++axis) {
        for (int side = 0; side < 2; ++side) {
          const int other = grid.neighbor(cell, axis, side);
          if (other < 0 || !known[other])
            continue;
          sum += pressure[other] + (side == 0 ? step : -step) * gradient[axis];
          ++n;
        }
      }
      if (n > 0)
        front.emplace_back(cell, sum / n);
      else
        behind.push_back(cell);
    }
    if (n_over_ranks(front.size()) == 0)
      break;  // regions that hold nothing but new fluid
    for (const auto& [cell, value] : front) {
      pressure[cell] = value;
      known[cell] = 1;
    }
    domain.halo.fill(pressure);
    domain.halo.fill(known);
    missing = std::move(behind);
  }
  return pressure;
}

template <int dim>
void bound_beside_air(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                      const std::function<double(int wet, int dry, int axis, int end)>& at_surface,
                      CellField& pressure) {
  constexpr double near = 10;
  const auto& cells = geometry.state.cells;
  std::vector<std::pair<int, double>> bounded;
  domain.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (cells[cell] != CellState::fluid)
      return;
    double nearest = near;
    double value = 0;
    for (int side = 0; side < 2 * dim; ++side) {
      const int other = neighbors[side];
      if (other < 0 || cells[other] != CellState::air)
        continue;
      const int axis = side / 2, face = side % 2 == 0 ? cell : other;
      if (geometry.state.faces[axis][face] != FaceState::free)
        continue;
      const double distance_factor = geometry.face_table(axis, face).distance_factor;
      if (distance_factor <= nearest)
        continue;
      nearest = distance_factor;
      const int opposite = neighbors[side ^ 1];
      const bool is_wet = opposite >= 0 && cells[opposite] == CellState::fluid;
      const double beyond = at_surface(cell, other, axis, side % 2);
      value = beyond + (is_wet ? (pressure[opposite] - beyond) / (1 + distance_factor) : 0);
    }
    if (nearest > near)
      bounded.emplace_back(cell, value);
  });
  for (const auto& [cell, value] : bounded)
    pressure[cell] = value;
  domain.halo.fill(pressure);
}

template CellField extended_pressure<2>(const MacDomain<2>&, const std::vector<CellState>&,
                                        const std::vector<CellState>&, CellField, const Point<2>&,
                                        const std::vector<float>&);
template CellField extended_pressure<3>(const MacDomain<3>&, const std::vector<CellState>&,
                                        const std::vector<CellState>&, CellField, const Point<3>&,
                                        const std::vector<float>&);
template void bound_beside_air<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                  const std::function<double(int, int, int, int)>&, CellField&);
template void bound_beside_air<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                  const std::function<double(int, int, int, int)>&, CellField&);

}  // namespace lockstep
