#include "liquid/common/liquid_volume.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "geometry/clipping.hpp"
#include "geometry/solid_volume.hpp"
#include "liquid/common/wet_fraction.hpp"

namespace lockstep {

namespace {
/// phi beyond which no corner of a cell's boxes is on the other side [cells]; with what it may
/// change until then.
constexpr double far = 2.5;
/// The shift of phi that shows the area [cells].
constexpr double probe = 1e-3;

/// Volume in a box of the closed solids that no image repeats.
template <int dim>
double volume_of_unrepeated(const SurfaceSnapshot<dim>& surface, const Box<dim>& box) {
  std::vector<int> solids;
  surface.solids_touching(box, solids);
  double volume = 0;
  for (const int solid : solids)
    if (surface.solids()[solid].closed && !surface.images().repeats(solid))
      volume += solid_volume_in_box<dim>(surface, box, solid);
  return std::min(volume, box.volume());
}

/// Volume of closed solids in a box that may reach beyond the upper ends of periodic axes. Of
/// solids that are not repeated there, the part at the lower end counts, too.
template <int dim>
double solid_volume_across_sides(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
                                 const Box<dim>& box) {
  const Point<dim> upper = domain.bounds().max(), period = upper - domain.grid.lower();
  double volume = 0;
  for (int image = 0; image < 1 << dim; ++image) {
    Point<dim> shift = Point<dim>::Zero();
    bool reaches = true;
    for (int a = 0; a < dim; ++a)
      if (image >> a & 1) {
        shift[a] = period[a];
        reaches = reaches && domain.boundary.periodic(a) &&
                  box.max()[a] > upper[a] + 0.1 * domain.spacing();
      }
    const Box<dim> moved(box.min() - shift, box.max() - shift);
    if (reaches)
      volume += image == 0 ? solid_volume_in_box<dim>(surface, moved)
                           : volume_of_unrepeated<dim>(surface, moved);
  }
  return volume;
}

/// Shells in a cell, taken as a plane.
template <int dim>
struct PlaneOfShell {
  Point<dim> normal, point;
};

/// Nothing if no shell is in the box, or several sheets or a sharp fold, which are no plane.
/// `touching` is scratch.
template <int dim>
std::optional<PlaneOfShell<dim>> plane_of_shell(const SurfaceSnapshot<dim>& surface,
                                                const Box<dim>& box, std::vector<int>& touching) {
  surface.touching(box, touching);
  double area = 0;
  Point<dim> normal = Point<dim>::Zero(), middle = normal;
  for (const int simplex : touching) {
    if (surface.solids()[surface.solid_of(simplex)].closed)
      continue;
    const auto corners = surface.corners(simplex);
    const ClippedSimplex<dim> part = clip_to_box<dim>(corners, box);
    if (part.measure <= 0)
      continue;
    area += part.measure;
    normal += part.measure * area_vector<dim>(corners).normalized();
    middle += part.measure * part.centroid;
  }
  if (area == 0 || normal.norm() < 0.7 * area)
    return {};
  return PlaneOfShell<dim>{normal.normalized(), middle / area};
}

/// Turns the plane's normal away from the centre of its cell: which side that is on, links know
/// better than the plane. Returns the axis that is most nearly along it.
template <int dim>
int point_away_from_center(const TiledGrid<dim>& grid, const SolidCells<dim>& solids, int cell,
                           PlaneOfShell<dim>& plane) {
  int axis = 0;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  const auto is_hidden = [&](int side) {
    const int beside = grid.neighbor(cell, axis, side);
    return beside >= 0 && (solids.occluded[side == 0 ? cell : beside] >> axis & 1) != 0;
  };
  const bool below = is_hidden(0), above = is_hidden(1);
  if (below != above ? (plane.normal[axis] > 0) == below
                     : plane.normal.dot(grid.center(cell) - plane.point) > 0)
    plane.normal = -plane.normal;
  return axis;
}
}  // namespace

double GroupVolumes::total() const {
  return std::accumulate(volume.begin(), volume.end(), loose);
}

template <int dim>
double LiquidVolume<dim>::volume_of_cell(int cell) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Index<dim> place = grid.coordinates(cell);
  double volume = domain_.cell_volume();
  for (int a = 0; a < dim; ++a)
    if (!grid.description().periodic[a]) {
      volume *= (place[a] == 0 ? 0.5 : 0.0) + (place[a] + 1 == grid.n_cells()[a] ? 0.5 : 1.0);
    }
  return volume;
}

template <int dim>
bool LiquidVolume<dim>::is_divided(const SolidCells<dim>& solids,
                                   const std::array<int, n_corners>& corners) const {
  for (int k = 0; k < n_corners; ++k)
    for (int a = 0; a < dim; ++a) {
      const int upper = corners[k | 1 << a];
      if ((k >> a & 1) || upper == corners[k] || !solids.is_fluid(corners[k]) ||
          !solids.is_fluid(upper))
        continue;
      if (solids.occluded[upper] >> a & 1)
        return true;
    }
  return false;
}

template <int dim>
void LiquidVolume<dim>::list_boxes(const SolidCells<dim>& solids, const CellField& phi, int cell) {
  const TiledGrid<dim>& grid = domain_.grid;
  const Index<dim> place = grid.coordinates(cell);
  const double h = domain_.spacing();
  const bool near = !solids.near.empty() && solids.near[cell];
  // Bit a: the half box below the first centre along axis a.
  for (int below = 0; below < n_corners; ++below) {
    CutBox box;
    box.volume = 1;
    Point<dim> low = grid.center(cell), high = low;
    std::array<bool, dim> flat{};
    bool exists = true;
    for (int a = 0; a < dim; ++a) {
      const bool wraps = grid.description().periodic[a];
      const bool is_below = below >> a & 1;
      exists = exists && (!is_below || (!wraps && place[a] == 0));
      flat[a] = is_below || (!wraps && place[a] + 1 == grid.n_cells()[a]);
      if (flat[a] && domain_.boundary.side(a, is_below ? 0 : 1).type == SideType::open)
        box.open_sides |= 1 << (2 * a + (is_below ? 0 : 1));
      (is_below ? low : high)[a] += (is_below ? -1 : 1) * (flat[a] ? 0.5 * h : h);
      box.volume *= flat[a] ? 0.5 * h : h;
    }
    if (!exists)
      continue;
    box.corners.fill(cell);
    for (int k = 1; k < n_corners; ++k) {
      int a = 0;
      while (!(k >> a & 1))
        ++a;
      const int beside = box.corners[k ^ 1 << a];
      const int upper = flat[a] ? beside : grid.neighbor(beside, a, 1);
      box.corners[k] = upper < 0 ? beside : upper;
    }
    const bool stays_dry = std::none_of(box.corners.begin(), box.corners.end(),
                                        [&](int corner) { return phi[corner] < 0.5 * h; });
    if (stays_dry)
      continue;
    if (near)
      box.volume -= solid_volume_across_sides<dim>(domain_, *solids.state.surface, {low, high});
    if (box.volume <= 0)
      continue;
    if (near && is_divided(solids, box.corners)) {
      for (const int corner : box.corners)
        shares_[corner] += box.volume / n_corners;
    } else {
      cut_.push_back(box);
    }
  }
}

template <int dim>
void LiquidVolume<dim>::list_full(int cell) {
  const double volume = volume_of_cell(cell);
  if (full_.empty() || full_.back().begin + full_.back().n != cell || full_.back().volume != volume)
    full_.push_back({cell, 0, volume});
  ++full_.back().n;
}

template <int dim>
void LiquidVolume<dim>::list_beyond_shell(const SolidCells<dim>& solids, const CellField& phi,
                                          int cell, std::vector<int>& touching) {
  const TiledGrid<dim>& grid = domain_.grid;
  if (stays_dry(phi, cell))
    return;
  const Point<dim> center = grid.center(cell);
  const Point<dim> half = Point<dim>::Constant(0.5 * domain_.spacing());
  std::optional<PlaneOfShell<dim>> plane =
      plane_of_shell<dim>(*solids.state.surface, Box<dim>(center - half, center + half), touching);
  if (!plane)
    return;
  const int axis = point_away_from_center(grid, solids, cell, *plane);
  Index<dim> beyond = grid.coordinates(cell);
  for (int a = 0; a < dim; ++a)
    beyond[a] += static_cast<int>(std::lround(plane->normal[a] / std::abs(plane->normal[axis])));
  const int other = grid.cell(beyond);
  if (other < 0 || !grid.in_domain(other) || !solids.is_fluid(other))
    return;
  std::array<double, n_corners> depth;
  for (int k = 0; k < n_corners; ++k) {
    Point<dim> corner = center - half;
    for (int a = 0; a < dim; ++a)
      corner[a] += (k >> a & 1) * domain_.spacing();
    depth[k] = plane->normal.dot(plane->point - corner);
  }
  const double volume = wet_fraction<dim>(depth) * domain_.cell_volume();
  shares_[cell] -= volume;
  shares_[other] += volume;
}

template <int dim>
bool LiquidVolume<dim>::stays_dry(const CellField& phi, int cell) const {
  // A share is dry from phi = h/2, and phi may change by as much.
  const double dry = domain_.spacing();
  if (phi[cell] < dry)
    return false;
  const Index<dim> middle = domain_.grid.coordinates(cell);
  for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
    Index<dim> at = middle;
    for (int a = 0, rest = k; a < dim; ++a, rest /= 3)
      at[a] += rest % 3 - 1;
    const int other = domain_.grid.cell(at);
    if (other >= 0 && phi[other] < dry)
      return false;
  }
  return true;
}

template <int dim>
void LiquidVolume<dim>::list_beyond_shells(const SolidCells<dim>& solids, const CellField& phi) {
  if (!solids.has_shells())
    return;
  std::vector<int> touching;
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (solids.near[cell] && solids.is_fluid(cell))
      list_beyond_shell(solids, phi, cell, touching);
  });
}

template <int dim>
void LiquidVolume<dim>::list_divided_cells(const SolidCells<dim>& solids) {
  divided_.clear();
  if (solids.near.empty())
    return;
  domain_.halo.sum_to_owner(shares_);
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (shares_[cell] == 0)
      return;
    DividedCell of{cell, shares_[cell], {}};
    for (int i = 0; i < 2 * dim; ++i)
      of.beside[i] = solids.seen_neighbor(domain_.grid, cell, i / 2, i % 2);
    divided_.push_back(of);
  });
}

template <int dim>
void LiquidVolume<dim>::prepare(const SolidCells<dim>& solids, const CellField& phi) {
  const double deep = far * domain_.spacing();
  cut_.clear();
  full_.clear();
  if (!solids.near.empty())
    shares_.assign(phi.size(), 0);
  list_beyond_shells(solids, phi);
  domain_.grid.for_each_owned_cell([&](int cell) {
    const bool near = !solids.near.empty() && solids.near[cell];
    if (near || (std::abs(phi[cell]) < deep && solids.is_fluid(cell)))
      list_boxes(solids, phi, cell);
    else if (phi[cell] < 0 && solids.is_fluid(cell))
      list_full(cell);
  });
  list_divided_cells(solids);
}

/// Air that comes in through an open side shows by phi rising towards it, before it is at a centre.
template <int dim>
double LiquidVolume<dim>::at_corner(const CutBox& box, int corner, const CellField& phi) const {
  const int cell = box.corners[corner];
  double value = phi[cell];
  for (int a = 0; box.open_sides != 0 && a < dim; ++a) {
    const int side = corner >> a & 1;
    if ((box.open_sides >> (2 * a + side) & 1) == 0)
      continue;
    const int inside = domain_.grid.neighbor(cell, a, 1 - side);
    if (inside >= 0 && domain_.grid.in_domain(inside))
      value += 0.5 * std::clamp(phi[cell] - phi[inside], 0.0, domain_.spacing());
  }
  return value;
}

template <int dim>
void LiquidVolume<dim>::add_cut(const CutBox& box, const CellField& phi, const CellGroups& groups,
                                GroupVolumes& sums) const {
  const double shift = probe * domain_.spacing();
  std::array<double, n_corners> values, lower;
  int n_wet = 0, n_credited = 0;
  for (int k = 0; k < n_corners; ++k) {
    values[k] = at_corner(box, k, phi);
    lower[k] = values[k] - shift;
    n_wet += values[k] < 0;
    n_credited += values[k] < 0 && groups.of_cell[box.corners[k]] >= 0;
  }
  if (n_wet == 0)
    return;
  const double fraction = wet_fraction<dim>(values);
  const double volume = fraction * box.volume;
  const double area =
      n_wet == n_corners ? 0 : (wet_fraction<dim>(lower) - fraction) * box.volume / shift;
  if (n_credited == 0)
    sums.loose += volume;
  for (int k = 0; k < n_corners; ++k)
    if (const int group = groups.of_cell[box.corners[k]]; values[k] < 0 && group >= 0) {
      sums.volume[group] += volume / n_credited;
      sums.area[group] += area / n_credited;
    }
}

template <int dim>
void LiquidVolume<dim>::add_divided(const DividedCell& of, const CellField& phi,
                                    const CellGroups& groups, GroupVolumes& sums) const {
  const double h = domain_.spacing();
  const double fraction = std::clamp(0.5 - phi[of.cell] / h, 0.0, 1.0);
  if (fraction == 0)
    return;
  int wet = of.cell;
  for (const int other : of.beside)
    if (phi[of.cell] >= 0 && other >= 0 && phi[other] < phi[wet])
      wet = other;
  const int group = phi[wet] < 0 ? groups.of_cell[wet] : -1;
  if (group < 0) {
    sums.loose += fraction * of.volume;
  } else {
    sums.volume[group] += fraction * of.volume;
    sums.area[group] += fraction < 1 ? of.volume / h : 0;
  }
}

template <int dim>
GroupVolumes LiquidVolume<dim>::measure(const CellField& phi, const CellGroups& groups) const {
  GroupVolumes sums;
  sums.volume.assign(groups.n, 0);
  sums.area.assign(groups.n, 0);
  for (const CutBox& box : cut_)
    add_cut(box, phi, groups, sums);
  for (const DividedCell& of : divided_)
    add_divided(of, phi, groups, sums);
  for (const Run& run : full_)
    for (int cell = run.begin, end = run.begin + run.n; cell < end;) {
      const int first = cell, group = groups.of_cell[cell];
      while (cell < end && groups.of_cell[cell] == group)
        ++cell;
      (group < 0 ? sums.loose : sums.volume[group]) += (cell - first) * run.volume;
    }
  sum_over_ranks(domain_.grid.comm(), sums.volume, sums.area, sums.loose);
  return sums;
}

template class LiquidVolume<2>;
template class LiquidVolume<3>;

}  // namespace lockstep
