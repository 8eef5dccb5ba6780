#include "mac/tiles/moving_tiles.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/domain/fitting_domain.hpp"
#include "staggered/domain/inflow_scalars.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {

constexpr double only_at_start = -1e300, for_ever = 1e300;

/// Calls f(name, list) for the named sublists.
template <typename Function>
void for_each_sublist(const ParameterList& list, const Function& f) {
  for (auto it = list.begin(); it != list.end(); ++it)
    f(list.sublist(list.name(it)));
}

/// Least difference of a value from that at rest that counts, if `largest` is the largest
/// difference of all; round-off does not.
double least_difference(double threshold, double largest, double ambient) {
  return std::max(threshold * largest, 1e-9 * (1e-3 + std::abs(ambient)));
}

}  // namespace

template <int dim>
void declare_moving_tiles(ParameterList& fluid) {
  ParameterList& list = declare_optional_list(
      fluid, "Moving Tiles",
      "Store and solve only where something moves or was asked for, in tiles of 16 x 16 cells (2D) "
      "or 8 x 8 x 8 that come and go. With a free surface: where liquid is; the rest is "
      "air. Without, beyond them the fluid is taken to be at rest, with ambient "
      "scalars and the pressure of fluid at rest, as in an unbounded surrounding: fluid flows in "
      "and out there freely, and what goes out is forgotten. docs/method.md, \"Moving tiles\", "
      "tells how far that is from the whole domain. Absent: all tiles are stored, always.");
  declare_at_least(list, "Tile Margin", 16, 4,
                   "Tiles are stored within so many cells of what moves, is solid or was asked for "
                   "[1]; at least 4 more than anything moves in a step.");
  declare_between(list, "Threshold", 0.01, 1e-6, 0.5,
                  "Threshold of motion without a free surface: fluid faster than this part of the "
                  "fastest, and scalars that differ from their ambient value by more than this "
                  "part of the largest difference [1].");
  ParameterList region;
  declare_shape<dim>(region);
  declare_named_sublists(list, "Keep", "Boxes and balls that are always stored.", region);
}

template <int dim>
MovingTiles<dim>::MovingTiles(const ParameterList& fluid, const DomainDescription<dim>& domain)
    : lattice_(domain.grid) {
  const FieldFormula<dim> gravity(fluid, "Gravity", "Fluid");
  const Point<dim> force = gravity_at_start<dim>(fluid) + point_value<dim>(fluid, "Body Force");
  for (int axis = 0; axis < dim; ++axis)
    check_input((gravity.is_number(axis) && force[axis] == 0) || !domain.grid.periodic[axis],
                "In \"Fluid\", \"Moving Tiles\" takes the fluid far away to be at rest, but along "
                "the periodic axis {} a force would make it move; leave it out.",
                "xyz"[axis]);
  const ParameterList& list = fluid.sublist("Moving Tiles");
  margin_ = list.get<int>("Tile Margin");
  threshold_ = list.get<double>("Threshold");
  ask_for(list.sublist("Keep"), for_ever);
  for (const char* scalar : {"Smoke", "Temperature"})
    if (fluid.isSublist(scalar))
      ask_for(fluid.sublist(scalar).sublist("Regions"), only_at_start);
  for_each_sublist(fluid.sublist("Sources"), [&](const ParameterList& source) {
    asked_.push_back({read_shape<dim>(source).bounds(),
                      source.isParameter("End") ? source.get<double>("End") : for_ever});
  });
  const auto has_formula = [&](const char* scalar) {
    return fluid.isSublist(scalar) && fluid.sublist(scalar).isParameter("Value");
  };
  if (!FieldFormula<dim>(fluid, "Velocity", "Fluid").vanishes() || has_formula("Smoke") ||
      has_formula("Temperature")) {
    const Point<dim> far = Point<dim>::Constant(1e300);
    asked_.push_back({Box<dim>(-far, far), only_at_start});
  }
  ask_for_sides(domain);
  if (fluid.isSublist("Free Surface"))
    liquid_ = read_liquid<dim>(fluid, gravity_at_start<dim>(fluid));
}

template <int dim>
void MovingTiles<dim>::ask_for(const ParameterList& regions, double until) {
  for_each_sublist(regions, [&](const ParameterList& region) {
    asked_.push_back({read_shape<dim>(region).bounds(), until});
  });
}

/// Inflows, walls that move, and open sides with a pressure.
template <int dim>
void MovingTiles<dim>::ask_for_sides(const DomainDescription<dim>& domain) {
  const GridDescription<dim>& grid = domain.grid;
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = domain.boundary.side(axis, end);
      if (!side.moves() && side.pressure.vanishes())
        continue;
      const double upper = grid.lower[axis] + grid.n_cells[axis] * grid.spacing;
      Point<dim> far = Point<dim>::Constant(1e300);
      Box<dim> region(-far, far);
      if (side.type == SideType::inflow)
        region = region.intersection(side.opening.box);
      region.min()[axis] = region.max()[axis] = end == 0 ? grid.lower[axis] : upper;
      asked_.push_back({region, for_ever});
    }
}

template <int dim>
void MovingTiles<dim>::add_regions(double time, NeededTiles<dim>& needed) const {
  for (const Asked& asked : asked_)
    if (time < asked.until || time == only_at_start)
      needed.add(asked.region);
}

/// Tiles that may hold some of it at the start; the ranks share the work.
template <int dim>
void MovingTiles<dim>::add_liquid(const Communicator& comm, NeededTiles<dim>& needed) const {
  if (!liquid_)
    return;
  const GridDescription<dim>& grid = lattice_.description();
  const double half_diagonal = 0.5 * tile_width<dim> * std::sqrt(dim) * grid.spacing;
  GlobalIndex n = 1;
  for (const int along : lattice_.n_tiles())
    n *= along;
  for (GlobalIndex i = comm->getRank(); i < n; i += comm->getSize()) {
    Index<dim> begin = lattice_.tile_coordinates(i), end{};
    Point<dim> center;
    for (int a = 0; a < dim; ++a) {
      begin[a] *= tile_width<dim>;
      end[a] = begin[a] + tile_width<dim>;
      center[a] = grid.lower[a] + 0.5 * (begin[a] + end[a]) * grid.spacing;
    }
    if (liquid_(center) < half_diagonal)
      needed.add(begin, end);
  }
}

template <int dim>
TileOwners MovingTiles<dim>::first(const Communicator& comm) const {
  NeededTiles<dim> needed(lattice_, 0, margin_);
  add_regions(only_at_start, needed);
  add_liquid(comm, needed);
  return needed.first(comm);
}

/// Fluid that is fast, and scalars that differ.
template <int dim>
void MovingTiles<dim>::add_moving(const Present& present, NeededTiles<dim>& needed) const {
  const TiledGrid<dim>& grid = present.grid;
  constexpr double still = 1e-6;  // cells a step
  const double slow =
      std::max(threshold_ * present.largest_speed, still * grid.spacing() / present.dt);
  std::vector<double> least;
  for (const Carried& scalar : present.scalars) {
    double largest = 0;
    grid.for_each_owned_cell([&](int cell) {
      if (present.state.cells[cell] == CellState::fluid)
        largest = std::max(largest, std::abs(scalar.values[cell] - scalar.ambient));
    });
    largest = max_all(grid.comm(), largest);
    least.push_back(least_difference(threshold_, largest, scalar.ambient));
  }
  needed.add_cells(grid, [&](int cell) {
    if (present.state.cells[cell] != CellState::fluid)
      return false;
    for (int axis = 0; axis < dim; ++axis)
      if (std::abs(present.velocity[axis][cell]) > slow)
        return true;
    for (std::size_t s = 0; s < least.size(); ++s)
      if (std::abs(present.scalars[s].values[cell] - present.scalars[s].ambient) > least[s])
        return true;
    return false;
  });
}

template <int dim>
std::optional<TileOwners> MovingTiles<dim>::change(const Present& present) const {
  const TiledGrid<dim>& grid = present.grid;
  const double fastest = std::max(present.largest_speed, present.solid_speed);
  int reach = static_cast<int>(std::ceil(fastest * present.dt / grid.spacing())) + 4;
  int margin = margin_;
  if (present.distance) {
    // Tiles beside those that a surface passes must exist, since stencils there reach into them.
    reach = std::max(reach, tile_width<dim>);
    margin = std::max(margin, reach + 4);
  }
  NeededTiles<dim> needed(lattice_, reach, margin);
  add_regions(present.is_start ? only_at_start : present.time, needed);
  if (present.is_start)
    add_liquid(grid.comm(), needed);
  if (present.distance)
    needed.add_cells(grid, [&](int cell) { return (*present.distance)[cell] < present.band; });
  else
    add_moving(present, needed);
  if (present.state.surface)
    add_surface(*present.state.surface, grid.comm(), needed);
  return needed.change(grid.comm(), present.owners);
}

/// The ranks share the work: all of them know the surface.
template <int dim>
void MovingTiles<dim>::add_surface(const SurfaceSnapshot<dim>& surface, const Communicator& comm,
                                   NeededTiles<dim>& needed) {
  for (int s = comm->getRank(); s < surface.n_simplices(); s += comm->getSize())
    needed.add(surface.bounds(s));
}

template <int dim>
void MovingTiles<dim>::check_room(const SurfaceSnapshot<dim>& surface, const TileOwners& owners,
                                  const Communicator& comm) const {
  NeededTiles<dim> needed(lattice_, 2, 2);
  add_surface(surface, comm, needed);
  check_solve(
      needed.are_there(comm, owners),
      "In one step a solid has come where no tiles are stored (\"Fluid/Moving Tiles\"): take "
      "a wider \"Tile Margin\" or shorter steps.");
}

template <int dim>
MacDomain<dim> make_domain(const ParameterList& fluid, const ParameterList& domain,
                           const Communicator& comm) {
  const bool tiles_move = fluid.isSublist("Moving Tiles");
  DomainDescription<dim> description =
      tiles_move ? read_domain<dim>(domain) : fitting_domain<dim>(domain, comm);
  read_waves(fluid, domain, description);
  read_inflow_scalars(fluid, domain, description.boundary);
  if (!tiles_move)
    return {description, comm};
  return {description, MovingTiles<dim>(fluid, description).first(comm), comm};
}

template <int dim>
std::vector<char> find_band_edge(const MacDomain<dim>& domain) {
  const TiledGrid<dim>& grid = domain.grid;
  if (grid.is_complete())
    return {};
  std::vector<char> rim(grid.n_stored_cells(), 0);
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
    for (int axis = 0; axis < dim; ++axis)
      for (int side = 0; side < 2; ++side) {
        if (!grid.ends_at(tile, axis, side))
          continue;
        const int layer = side == 0 ? 0 : grid.tile_domain_extent(tile)[axis] - 1;
        for (int cell = tile * tile_volume<dim>; cell < (tile + 1) * tile_volume<dim>; ++cell)
          if ((cell >> (axis * log_tile_width<dim>)&(tile_width<dim> - 1)) == layer)
            rim[cell] = 1;
      }
  domain.full_halo.fill(rim);
  return rim;
}

template <int dim>
void clear_band_edge(const MacDomain<dim>& domain, std::vector<CellState>& cells) {
  const std::vector<char> rim = find_band_edge(domain);
  for (std::size_t cell = 0; cell < rim.size(); ++cell)
    if (rim[cell] && cells[cell] == CellState::fluid)
      cells[cell] = CellState::air;
}

template class MovingTiles<2>;
template class MovingTiles<3>;
template void declare_moving_tiles<2>(ParameterList&);
template void declare_moving_tiles<3>(ParameterList&);
template MacDomain<2> make_domain(const ParameterList&, const ParameterList&, const Communicator&);
template MacDomain<3> make_domain(const ParameterList&, const ParameterList&, const Communicator&);
template void clear_band_edge(const MacDomain<2>&, std::vector<CellState>&);
template void clear_band_edge(const MacDomain<3>&, std::vector<CellState>&);
template std::vector<char> find_band_edge(const MacDomain<2>&);
template std::vector<char> find_band_edge(const MacDomain<3>&);

}  // namespace lockstep
