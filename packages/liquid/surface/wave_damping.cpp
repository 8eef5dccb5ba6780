#include "liquid/surface/wave_damping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/flagged_tiles.hpp"

namespace lockstep {

namespace {
/// Within which the motion of the surface, its first and its second smoothed difference are wanted
/// [cells].
constexpr double reach_of_motion = 4, reach_of_first = 3, reach_of_second = 1.75;
/// [cells]; what moves fast is not to be damped, and must not be shaken.
constexpr double largest_shift = 0.05;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Values of cells near the surface, or `unknown`.
template <int dim>
struct NearSurface {
  const MacDomain<dim>& domain;
  TileField<dim> values;

  NearSurface(const MacDomain<dim>& domain_in, const std::vector<char>& tiles)
      : domain(domain_in), values(tiles, unknown) {}
  /// Value of a neighbour, or of the cell itself where the neighbour has none, as if mirrored in a
  /// wall.
  double beside(int cell, int axis, int end) const {
    const int other = domain.grid.neighbor(cell, axis, end);
    const double value = other >= 0 ? values[other] : unknown;
    return value != unknown ? value : values[cell];
  }
  bool at_corner(int cell, int a, int end_a, int b, int end_b, double& value) const {
    const int beside = domain.grid.neighbor(cell, a, end_a);
    const int corner = beside < 0 ? -1 : domain.grid.neighbor(beside, b, end_b);
    value = corner < 0 ? unknown : values[corner];
    return value != unknown;
  }
};

/// Stored tiles with a cell that near to the surface.
template <int dim>
std::vector<char> tiles_within(const TiledGrid<dim>& grid, const CellField& distance,
                               double reach) {
  std::vector<char> tiles(grid.n_tiles());
  for (int tile = 0; tile < grid.n_tiles(); ++tile) {
    using Values = Eigen::Map<const Eigen::Array<double, tile_volume<dim>, 1>>;
    tiles[tile] = (Values(distance.data() + tile * tile_volume<dim>).abs() < reach).any();
  }
  return tiles;
}

/// Normal of phi, one-sided where a neighbour is missing.
template <int dim>
Point<dim> normal(const TiledGrid<dim>& grid, const CellField& distance, int cell) {
  Point<dim> gradient;
  for (int axis = 0; axis < dim; ++axis) {
    const int lower = grid.neighbor(cell, axis, 0), upper = grid.neighbor(cell, axis, 1);
    const int n_seen = (lower >= 0) + (upper >= 0);
    gradient[axis] =
        n_seen == 0
            ? 0
            : (distance[upper < 0 ? cell : upper] - distance[lower < 0 ? cell : lower]) / n_seen;
  }
  const double length = gradient.norm();
  return length > 0 ? Point<dim>(gradient / length) : gradient;
}

/// -h^2/4 of the Laplacian along the surface: sin^2(kh/2) of a wave along an axis.
template <int dim>
double roughness(const NearSurface<dim>& field, const Point<dim>& n, int cell) {
  const double own = field.values[cell];
  double sum = 0;
  for (int a = 0; a < dim; ++a) {
    sum += (1 - n[a] * n[a]) * (field.beside(cell, a, 0) - 2 * own + field.beside(cell, a, 1));
    for (int b = a + 1; b < dim; ++b) {
      if (n[a] * n[b] == 0)
        continue;
      std::array<double, 4> corner{};
      if (field.at_corner(cell, a, 0, b, 0, corner[0]) &&
          field.at_corner(cell, a, 1, b, 1, corner[1]) &&
          field.at_corner(cell, a, 0, b, 1, corner[2]) &&
          field.at_corner(cell, a, 1, b, 0, corner[3]))
        sum -= 2 * n[a] * n[b] * 0.25 * (corner[0] + corner[1] - corner[2] - corner[3]);
    }
  }
  return -0.25 * sum;
}

/// Speed of the fluid along the normal of phi; unknown where a face has no velocity.
template <int dim>
NearSurface<dim> normal_speed(const MacDomain<dim>& domain, const std::vector<char>& tiles,
                              const MacGeometry<dim>& geometry, const CellField& distance,
                              const FaceField<dim>& velocity) {
  NearSurface<dim> result(domain, tiles);
  const double reach = reach_of_motion * domain.spacing();
  for_each_owned_cell_of(domain.grid, tiles, [&](int cell) {
    if (std::abs(distance[cell]) >= reach || geometry.near_surface(cell) ||
        geometry.state.cells[cell] == CellState::solid)
      return;
    Point<dim> u;
    for (int axis = 0; axis < dim; ++axis) {
      const int upper = domain.grid.neighbor(cell, axis, 1);
      if (geometry.state.faces[axis][cell] == FaceState::inactive ||
          (upper >= 0 && geometry.state.faces[axis][upper] == FaceState::inactive))
        return;
      u[axis] = 0.5 * (velocity[axis][cell] + (upper < 0 ? 0 : velocity[axis][upper]));
    }
    result.values.set(cell, u.dot(normal(domain.grid, distance, cell)));
  });
  domain.full_halo.fill(result.values);
  return result;
}
}  // namespace

template <int dim>
CellField short_wave_filter(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                            const CellField& distance, const FaceField<dim>& velocity,
                            double gravity, double dt) {
  const TiledGrid<dim>& grid = domain.grid;
  const double h = grid.spacing();
  const std::vector<char> tiles = tiles_within<dim>(grid, distance, reach_of_motion * h);
  const auto speed = normal_speed<dim>(domain, tiles, geometry, distance, velocity);
  const auto difference = [&](const NearSurface<dim>& field, double reach) {
    NearSurface<dim> result(domain, tiles);
    for_each_owned_cell_of(grid, tiles, [&](int cell) {
      if (field.values[cell] != unknown && std::abs(distance[cell]) < reach * h)
        result.values.set(cell, roughness(field, normal(grid, distance, cell), cell));
    });
    domain.full_halo.fill(result.values);
    return result;
  };
  const NearSurface<dim> second = difference(difference(speed, reach_of_first), reach_of_second);
  // Half of what would make the shortest waves overshoot in a step is the most.
  const double period = std::sqrt(h / gravity), ahead = period * std::min(2.0, 0.3 * period / dt);
  CellField lead(distance.size(), 0.0);
  for (std::size_t cell = 0; cell < lead.size(); ++cell)
    if (const double value = second.values[static_cast<int>(cell)]; value != unknown)
      lead[cell] = std::clamp(-ahead * value, -largest_shift * h, largest_shift * h);
  return lead;
}

template CellField short_wave_filter<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                        const CellField&, const FaceField<2>&, double, double);
template CellField short_wave_filter<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                        const CellField&, const FaceField<3>&, double, double);

}  // namespace lockstep
