#include "mac/make_geometry.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <optional>

#include "liquid/gas/gas_faces.hpp"
#include "liquid/surface/free_surface.hpp"
#include "mac/tiles/moving_tiles.hpp"
#include "staggered/state/cell_sides.hpp"
#include "staggered/state/contact_patches.hpp"
#include "staggered/state/covered_sides.hpp"
#include "staggered/state/cut_cells.hpp"
#include "staggered/state/ghost_faces.hpp"
#include "staggered/state/surface_marks.hpp"

namespace lockstep {

namespace {
template <int dim>
void number_pressures(const MacDomain<dim>& domain, MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto& cells = geometry.state.cells;
  int n = 0;
  grid.for_each_owned_cell([&](int cell) { n += cells[cell] == CellState::fluid; });
  geometry.pressure_map = make_map(n, grid.comm());
  geometry.unknown.assign(grid.n_stored_cells(), no_index);
  GlobalIndex next = n == 0 ? 0 : geometry.pressure_map->getMinGlobalIndex();
  grid.for_each_owned_cell([&](int cell) {
    if (cells[cell] == CellState::fluid)
      geometry.unknown[cell] = next++;
  });
  domain.halo.fill(geometry.unknown);
}

template <int dim>
bool sees(const SurfaceSnapshot<dim>& surface, const ControlVolume<dim>& volume) {
  for (const PressureSide<dim>& side : volume.sides)
    if (side.unknown != no_index && !surface.first_hit(side.center, volume.center))
      return true;
  return false;
}

/// Free, coupled, prescribed or inactive, where no surface is near.
template <int dim>
FaceState state_far_from_surfaces(const MacDomain<dim>& domain, const std::vector<CellState>& cells,
                                  int axis, const FaceCells& face) {
  const bool lower_fluid = face.lower >= 0 && cells[face.lower] == CellState::fluid;
  const bool upper_fluid = face.upper >= 0 && cells[face.upper] == CellState::fluid;
  if (!lower_fluid && !upper_fluid)
    return FaceState::inactive;
  if (face.at_side() && domain.boundary.side(axis, face.lower < 0 ? 0 : 1).prescribed())
    return FaceState::prescribed;
  return FaceState::free;
}

/// A free face between fluid and a cell whose pressure is known.
bool leads_to_air(const std::vector<CellState>& cells, const FaceCells& face) {
  const auto empty = [&](int cell) { return cell >= 0 && cells[cell] == CellState::air; };
  return empty(face.lower) || empty(face.upper);
}

template <int dim>
bool in_solid(const std::vector<CellState>& cells, int cell) {
  return cell >= 0 && cells[cell] == CellState::solid;
}

/// Open fractions of all owned faces and those above them, where cut cells are wanted.
template <int dim>
using OpenFractions = std::array<CellField, dim>;

/// Asks a cut-cell rule about all faces near the surface, and closes those behind which a cell has
/// its fluid on the other side of a thin wall. Walls and inflows open no cell.
template <int dim>
OpenFractions<dim> find_open_fractions(const MacDomain<dim>& domain,
                                       const OpenFractionRule<dim>& rule,
                                       const SurfaceMarks<dim>& marks, MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto& cells = geometry.state.cells;
  geometry.unknown.assign(grid.n_stored_cells(), no_index);
  const CellSides<dim> sides(domain, *geometry.state.surface, marks, cells);
  OpenFractions<dim> fractions;
  for (int axis = 0; axis < dim; ++axis) {
    fractions[axis].assign(grid.n_stored_cells(), 0.0);
    grid.for_each_owned_face(axis, [&](int cell) {
      const FaceCells face = cells_of_face(grid, cells, axis, cell);
      if (face.lower < 0 && face.upper < 0)
        return;
      if (face.at_side() && domain.boundary.side(axis, face.lower < 0 ? 0 : 1).prescribed())
        return;
      double& fraction = fractions[axis][cell];
      const bool parted = !sides.joined(axis, cell);
      if (geometry.near_surface(cell))
        fraction = rule.open_fraction(control_volume(domain, geometry, axis, cell), parted,
                                      *geometry.state.surface);
      else if (!in_solid<dim>(cells, face.lower) && !in_solid<dim>(cells, face.upper) && !parted)
        fraction = 1;
    });
    domain.halo.fill(fractions[axis]);
  }
  return fractions;
}

/// True if a thin shell comes between a cell and its neighbours' centres.
template <int dim>
bool holds_shell(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface, int cell) {
  const Point<dim> reach = Point<dim>::Constant(domain.spacing());
  const Point<dim> x = domain.grid.center(cell);
  std::vector<int> touching;
  surface.touching(Box<dim>(x - reach, x + reach), touching);
  return std::any_of(touching.begin(), touching.end(),
                     [&](int s) { return !surface.solids()[surface.solid_of(s)].closed; });
}

/// Near the surface, the cells with an open face are fluid, wherever their centres are; and so are
/// gaps between shells.
template <int dim>
void open_cut_cells(const MacDomain<dim>& domain, const OpenFractions<dim>& fractions,
                    MacGeometry<dim>& geometry) {
  auto& cells = geometry.state.cells;
  domain.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (!geometry.near_surface(cell) || cells[cell] == CellState::outside)
      return;
    bool open = false;
    for (int axis = 0; axis < dim; ++axis) {
      const int upper = neighbors[2 * axis + 1];
      open = open || fractions[axis][cell] > 0 || (upper >= 0 && fractions[axis][upper] > 0);
    }
    const bool is_pocket = !open && cells[cell] == CellState::fluid &&
                           holds_shell(domain, *geometry.state.surface, cell);
    cells[cell] = open || is_pocket ? CellState::fluid : CellState::solid;
  });
  fill_flags(domain.full_halo, cells);
}

/// The centroid of the open part of a face; or, where that lies in a solid (its tip is in the
/// face), a place beside the edge of the face from which one sees farthest towards its centre. That
/// names no axis and no end, so that a scene and its mirror image choose alike. None if the
/// centroid lies outside of the face: solids that overlap close a part of it twice, and their
/// moments say nothing about the rest. It has what its neighbours have.
template <int dim>
std::optional<Point<dim>> place_in_fluid(const ControlVolume<dim>& volume,
                                         const SurfaceSnapshot<dim>& surface) {
  Point<dim> place = volume.open_center.cwiseMax(volume.box.min()).cwiseMin(volume.box.max());
  if ((place - volume.open_center).norm() > 1e-9 * volume.box.sizes().maxCoeff())
    return std::nullopt;
  if (surface.inside(place) < 0)
    return place;
  double farthest = 0;
  for (int k = 1; k < dim; ++k) {
    const int across = (volume.direction + k) % dim;
    for (const double end : {0.49, -0.49}) {
      const Point<dim> edge =
          volume.center + end * volume.box.sizes()[across] * Point<dim>::Unit(across);
      if (surface.inside(edge) >= 0)
        continue;
      const auto hit = surface.first_hit(edge, volume.center);
      const double sight = ((hit ? hit->position : volume.center) - edge).norm();
      if (sight > farthest) {
        farthest = sight;
        place = edge;
      }
    }
  }
  return place;
}

/// Takes an open fraction below one for a face near the surface that would be free otherwise.
template <int dim>
void take_fraction(const OpenFractionRule<dim>& rule, int axis, int cell, ControlVolume<dim> volume,
                   MacGeometry<dim>& geometry) {
  if (volume.open_fraction >= 1)
    return;
  const SurfaceSnapshot<dim>& surface = *geometry.state.surface;
  if (volume.open_fraction > 0) {
    geometry.face_table.set_open(axis, cell, volume.open_fraction);
    volume.open_center = rule.open_center(volume, surface);
    if (const auto place = place_in_fluid(volume, surface))
      geometry.state.open_centers[axis][cell] = *place;
  } else {
    geometry.state.faces[axis][cell] = FaceState::coupled;
  }
  volume.seen_by_fluid = sees(surface, volume);
  geometry.coupled.push_back({axis, cell});
  geometry.coupled_volumes.push_back(volume);
}

/// Owned tiles all of whose cells are fluid, with no surface near.
template <int dim>
std::vector<char> find_regular_tiles(const TiledGrid<dim>& grid, const MacGeometry<dim>& geometry) {
  std::vector<char> plain(grid.n_owned_tiles());
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    bool is_regular = true;
    for (int cell = tile * tile_volume<dim>; cell < (tile + 1) * tile_volume<dim>; ++cell)
      is_regular &= geometry.state.cells[cell] == CellState::fluid && !geometry.near_surface(cell);
    plain[tile] = is_regular;
  }
  return plain;
}

/// Asks the rule about a face near the surface that would be free otherwise.
template <int dim>
double ask_rule(const OpenFractionRule<dim>& rule, const ControlVolume<dim>& volume,
                const MacGeometry<dim>& geometry, const FaceCells& face, bool crossed) {
  const auto& cells = geometry.state.cells;
  const bool leads_into_solid =
      in_solid<dim>(cells, face.lower) || in_solid<dim>(cells, face.upper);
  const double fraction =
      rule.open_fraction(volume, crossed || leads_into_solid, *geometry.state.surface);
  // An open face between fluid and solid would be a silent leak, whatever the rule says.
  return leads_into_solid ? 0 : fraction;
}
}  // namespace

template <int dim>
MacGeometry<dim> make_geometry(const MacDomain<dim>& domain, double density,
                               const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                               const OpenFractionRule<dim>& rule,
                               const FreeSurface<dim>* free_surface) {
  const TiledGrid<dim>& grid = domain.grid;
  MacGeometry<dim> geometry;
  geometry.face_table = FaceTable<dim>(domain, density);
  GridState<dim>& state = geometry.state;
  state.cells.assign(grid.n_stored_cells(), CellState::outside);
  grid.for_each_stored_cell([&](int cell) { state.cells[cell] = CellState::fluid; });
  clear_band_edge(domain, state.cells);
  const bool has_band_edge = !grid.is_complete() && !free_surface;
  SurfaceMarks<dim> marks;
  if (surface && !surface->empty()) {
    state.surface = surface;
    marks = mark_surface(domain, *surface, state.cells);
    geometry.near = marks.near;
  }
  OpenFractions<dim> fractions;
  const bool cut = state.surface && rule.cuts_cells();
  state.has_cut_cells = cut;
  if (cut) {
    fractions = find_open_fractions(domain, rule, marks, geometry);
    open_cut_cells<dim>(domain, fractions, geometry);
  }
  const bool has_air = free_surface && !free_surface->has_gas();
  if (has_air)
    empty_dry_cells(grid, *free_surface, state.cells);
  if (free_surface && free_surface->gas)
    find_bubbles<dim>(*free_surface, marks, fractions, geometry);
  number_pressures(domain, geometry);
  if (cut)
    geometry.cut_cells = find_cut_cells(domain, geometry);
  geometry.regular_tiles = find_regular_tiles(grid, geometry);
  std::vector<ControlVolume<dim>> gas_volumes;
  for (int axis = 0; axis < dim; ++axis) {
    state.faces[axis].assign(grid.n_stored_cells(), FaceState::inactive);
    const int place_in_tile = (tile_width<dim> - 1) << (axis * log_tile_width<dim>);
    grid.for_each_owned_face(axis, [&](int cell) {
      if (geometry.is_regular(cell) && (cell & place_in_tile) != 0) {
        state.faces[axis][cell] = FaceState::free;
        return;
      }
      const FaceCells face = cells_of_face(grid, state.cells, axis, cell);
      FaceState& result = state.faces[axis][cell];
      result = state_far_from_surfaces(domain, state.cells, axis, face);
      // A closed face behind a cut cell need not be near the surface.
      const bool asked = geometry.near_surface(cell) || (cut && fractions[axis][cell] == 0);
      const bool only_gas = asked && only_gas_beside(state.cells, geometry.bubble, face);
      if (asked && (result == FaceState::free || only_gas)) {
        ControlVolume<dim> volume = control_volume(domain, geometry, axis, cell);
        volume.open_fraction =
            cut ? fractions[axis][cell]
                : ask_rule(rule, volume, geometry, face, (marks.occluded[cell] >> axis & 1) != 0);
        if (!only_gas)
          take_fraction(rule, axis, cell, volume, geometry);
        else if (volume.open_fraction < 1)
          gas_volumes.push_back(volume);
      }
      if (result == FaceState::prescribed)
        geometry.prescribed.push_back({axis, cell});
      if (has_band_edge && result == FaceState::free && leads_to_air(state.cells, face))
        geometry.band_edge.push_back({axis, cell});
      if (result == FaceState::free && face.at_side())
        geometry.face_table.set_distance_factor(axis, cell, 2);
    });
    if (grid.comm()->getSize() > 1)
      fill_flags(domain.full_halo, state.faces[axis]);
  }
  if (cut)
    add_covered_sides(domain, rule, geometry);
  geometry.coupled_volumes.insert(geometry.coupled_volumes.end(), gas_volumes.begin(),
                                  gas_volumes.end());
  if (state.surface)
    add_contact_patches(domain, geometry);
  complete_ghost_faces(domain, geometry);
  if (has_air)
    set_distance_factor_to_air(domain, *free_surface, geometry);
  share_open_fractions(domain, geometry);
  if (free_surface && free_surface->has_gas())
    set_phase_densities(domain, *free_surface, geometry);
  return geometry;
}

template MacGeometry<2> make_geometry<2>(const MacDomain<2>&, double,
                                         const std::shared_ptr<const SurfaceSnapshot<2>>&,
                                         const OpenFractionRule<2>&, const FreeSurface<2>*);
template MacGeometry<3> make_geometry<3>(const MacDomain<3>&, double,
                                         const std::shared_ptr<const SurfaceSnapshot<3>>&,
                                         const OpenFractionRule<3>&, const FreeSurface<3>*);

}  // namespace lockstep
