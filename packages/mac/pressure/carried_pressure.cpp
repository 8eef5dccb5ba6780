#include "mac/pressure/carried_pressure.hpp"

#include <algorithm>
#include <cmath>

#include "mac/pressure/extended_pressure.hpp"

namespace lockstep {

namespace {
/// Solids take their pressure no farther than this in a step [cells], so that halos hold all that
/// is asked for; it goes into them by one more.
constexpr double farthest = 2;

/// A rigid closed solid that has moved.
template <int dim>
struct Mover {
  Point<dim> way;                ///< mean displacement of its surface [m]
  double speed = 0;              ///< mean speed of its surface [m/s]
  double reach = 0;              ///< distance from which on nothing goes along [m]
  std::vector<Box<dim>> bounds;  ///< boxes of its images, after it has moved
};

template <int dim>
double area_of(const std::array<Point<dim>, dim>& corners) {
  if constexpr (dim == 2)
    return (corners[1] - corners[0]).norm();
  else
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
}

/// Mean of a value of each simplex of a solid, by area.
template <int dim, typename Value>
Point<dim> surface_mean(const SurfaceSnapshot<dim>& surface, const SolidDescription& solid,
                        const Value& value) {
  Point<dim> sum = Point<dim>::Zero();
  double area = 0;
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    const double size = area_of<dim>(surface.corners(s));
    sum += size * value(s);
    area += size;
  }
  return area > 0 ? Point<dim>(sum / area) : sum;
}

template <int dim>
std::vector<Mover<dim>> find_movers(const MovingSurface<dim>& surface, double spacing) {
  constexpr double round_off = 1e-12;
  const SurfaceSnapshot<dim>&before = *surface.before, &after = *surface.after;
  const auto displacement = [&](int simplex) {
    const auto from = before.corners(simplex), to = after.corners(simplex);
    Point<dim> sum = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k)
      sum += (to[k] - from[k]) / dim;
    return sum;
  };
  const auto velocity = [&](int simplex) {
    return surface.velocity({simplex, Barycentric<dim>::Constant(1.0 / dim)});
  };
  std::vector<Mover<dim>> movers;
  for (int i = 0; i < static_cast<int>(after.solids().size()); ++i) {
    const SolidDescription& solid = after.solids()[i];
    if (!solid.closed || !solid.rigid)
      continue;
    Point<dim> way = surface_mean<dim>(after, solid, displacement);
    if (way.norm() <= round_off * spacing)
      continue;
    way *= std::min(1.0, farthest * spacing / way.norm());
    movers.push_back({way, surface_mean<dim>(after, solid, velocity).norm(),
                      after.own_bounds(i).sizes().maxCoeff(), after.bounds_of_images(i)});
  }
  return movers;
}

/// A mover near a tile, at one of its places.
template <int dim>
struct Nearby {
  const Mover<dim>* mover = nullptr;
  const Box<dim>* bounds = nullptr;
};

/// Calls f(cell, mover, distance) for owned cells that something goes along at: with which solid,
/// and how far from the box around it [m].
template <int dim, typename Function>
void for_each_carried_cell(const TiledGrid<dim>& grid, const std::vector<Mover<dim>>& movers,
                           const Function& f) {
  const Point<dim> width = Point<dim>::Constant(tile_width<dim> * grid.spacing());
  std::vector<Nearby<dim>> near;
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    const int first = tile << log_tile_volume<dim>;
    const Point<dim> lower = grid.center(first) - Point<dim>::Constant(0.5 * grid.spacing());
    const Box<dim> box(lower, lower + width);
    near.clear();
    for (const Mover<dim>& mover : movers)
      for (const Box<dim>& bounds : mover.bounds)
        if (bounds.exteriorDistance(box) < mover.reach)
          near.push_back({&mover, &bounds});
    if (near.empty())
      continue;
    for (int cell = first; cell < first + (1 << log_tile_volume<dim>); ++cell) {
      if (!grid.in_domain(cell))
        continue;
      double largest = 0, least = 0;
      const Mover<dim>* nearest = nullptr;
      for (const auto& [mover, bounds] : near) {
        const double distance = bounds->exteriorDistance(grid.center(cell));
        const double part = 1 - distance / mover->reach;
        if (part > largest) {
          largest = part;
          least = distance;
          nearest = mover;
        }
      }
      if (nearest)
        f(cell, *nearest, least);
    }
  }
}

/// Value at a place that lies `way` from the centre of a cell [cells], multilinear; beyond what is
/// stored that of the last cell.
template <int dim>
double value_at(const TiledGrid<dim>& grid, const CellField& field, int cell,
                const Point<dim>& way) {
  const auto go = [&](int from, int axis, int side) {
    const int next = grid.neighbor(from, axis, side);
    return next < 0 ? from : next;
  };
  Point<dim> part;
  for (int axis = 0; axis < dim; ++axis) {
    const int whole = static_cast<int>(std::floor(way[axis]));
    part[axis] = way[axis] - whole;
    for (int k = 0; k < std::abs(whole); ++k)
      cell = go(cell, axis, whole < 0 ? 0 : 1);
  }
  double value = 0;
  for (int corner = 0; corner < (1 << dim); ++corner) {
    int at = cell;
    double weight = 1;
    for (int axis = 0; axis < dim; ++axis) {
      const bool upper = (corner >> axis & 1) != 0;
      weight *= upper ? part[axis] : 1 - part[axis];
      at = upper ? go(at, axis, 1) : at;
    }
    value += weight * field[at];
  }
  return value;
}
}  // namespace

template <int dim>
void carry_pressure(const MacDomain<dim>& domain, const MovingSurface<dim>& surface,
                    const PressureScales<dim>& scales, std::vector<CellState>& cells,
                    CellField& pressure) {
  const std::vector<Mover<dim>> movers = find_movers(surface, domain.spacing());
  if (movers.empty())
    return;
  const TiledGrid<dim>& grid = domain.grid;
  const double h = domain.spacing();
  // Cells whose centres solids hold say little of how the pressure goes on beside them.
  std::vector<CellState> known = cells, wanted = cells;
  const double deep = (farthest + 1) * h;
  const Point<dim> around = Point<dim>::Constant(deep);
  const double away = around.norm() + farthest * h;  // from where on nothing was near before either
  for_each_carried_cell(grid, movers, [&](int cell, const Mover<dim>&, double distance) {
    const Point<dim> x = grid.center(cell);
    if (cells[cell] == CellState::outside || distance > away ||
        !surface.before->touches(Box<dim>(x - around, x + around)))
      return;
    if (surface.before->inside(x) >= 0)
      known[cell] = CellState::solid;
    wanted[cell] = CellState::fluid;
  });
  fill_flags(domain.full_halo, known);
  fill_flags(domain.full_halo, wanted);
  CellField field = extended_pressure<dim>(domain, wanted, known, pressure, scales.at_rest);
  domain.full_halo.fill(field);
  for_each_carried_cell(grid, movers, [&](int cell, const Mover<dim>& mover, double distance) {
    const Point<dim> way = (1 - distance / mover.reach) * mover.way;
    const double most = (scales.inertia * mover.speed + scales.friction) * mover.speed;
    const double change =
        value_at<dim>(grid, field, cell, -way / h) + scales.at_rest.dot(way) - field[cell];
    const double present = cells[cell] == CellState::fluid ? pressure[cell] : field[cell];
    pressure[cell] = present + std::clamp(change, -most, most);
    if (wanted[cell] == CellState::fluid)
      cells[cell] = CellState::fluid;
  });
  fill_flags(domain.full_halo, cells);
  domain.full_halo.fill(pressure);
}

template void carry_pressure<2>(const MacDomain<2>&, const MovingSurface<2>&,
                                const PressureScales<2>&, std::vector<CellState>&, CellField&);
template void carry_pressure<3>(const MacDomain<3>&, const MovingSurface<3>&,
                                const PressureScales<3>&, std::vector<CellState>&, CellField&);

}  // namespace lockstep
