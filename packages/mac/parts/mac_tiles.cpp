#include "mac/parts/mac_tiles.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "grid/tile_migration.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

/// Where the pressure of fluid at rest is 0: the middle of an open side, else of the domain.
template <int dim>
Point<dim> origin_of_pressure(const MacDomain<dim>& domain, const Box<dim>& bounds) {
  Point<dim> origin = bounds.center();
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      if (domain.boundary.side(axis, end).type == SideType::open)
        origin[axis] = end == 0 ? bounds.min()[axis] : bounds.max()[axis];
  return origin;
}

/// Work of the tiles; at surfaces that of this rank's tiles alone.
template <int dim>
TileWork work_of_tiles(const TiledGrid<dim>& grid, const TileOwners& owners,
                       const SurfaceSnapshot<dim>* surface) {
  // Measured: advection and geometry near a ball, by the tiles that it touches.
  constexpr int of_surface_tile = 4 * tile_volume<dim>;
  constexpr double reach = 2;  // cells
  const TileLattice<dim>& lattice = grid.tile_lattice();
  const int rank = grid.comm()->getRank();
  TileWork work;
  work.at_surfaces.assign(owners.tiles.size(), 0);
  for (std::size_t i = 0; i < owners.tiles.size(); ++i) {
    const Index<dim> tile = lattice.tile_coordinates(owners.tiles[i]);
    const Index<dim> size = lattice.domain_extent(tile);
    GlobalIndex n_cells = 1;
    Box<dim> box;
    for (int a = 0; a < dim; ++a) {
      n_cells *= size[a];
      const double begin = tile[a] * tile_width<dim>;
      box.min()[a] = grid.lower()[a] + (begin - reach) * grid.spacing();
      box.max()[a] = grid.lower()[a] + (begin + size[a] + reach) * grid.spacing();
    }
    work.everywhere.push_back(n_cells);
    if (surface && owners.ranks[i] == rank && surface->touches(box))
      work.at_surfaces[i] = of_surface_tile;
  }
  return work;
}

/// Replaces the work of cells by that of wet cells on this rank's tiles, and adds the work of the
/// liquid's surface within `band` of it.
template <int dim>
void add_liquid(const TiledGrid<dim>& grid, const TileOwners& owners, const CellField& distance,
                double band, TileWork& work) {
  // Measured in a tank of 64^3 cells, by what a surface adds to a step.
  constexpr GlobalIndex of_band_cell = 5, dry_cells_a_wet_one = 8;
  std::fill(work.everywhere.begin(), work.everywhere.end(), 0);
  const TileLattice<dim>& lattice = grid.tile_lattice();
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    Index<dim> coordinates;
    for (int a = 0; a < dim; ++a)
      coordinates[a] = grid.tile_begin(tile)[a] / tile_width<dim>;
    const auto place = std::lower_bound(owners.tiles.begin(), owners.tiles.end(),
                                        lattice.tile_number(coordinates));
    if (place == owners.tiles.end() || *place != lattice.tile_number(coordinates))
      continue;  // a layer of faces above the domain
    const auto i = place - owners.tiles.begin();
    GlobalIndex n_cells = 0, n_wet = 0, n_band = 0;
    for (int k = 0; k < tile_volume<dim>; ++k) {
      const int cell = tile * tile_volume<dim> + k;
      if (!grid.in_domain(cell))
        continue;  // values kept there are no state: a restart has others
      ++n_cells;
      n_wet += distance[cell] < 0;
      n_band += std::abs(distance[cell]) < band;
    }
    work.everywhere[i] = n_wet + (n_cells - n_wet) / dry_cells_a_wet_one;
    work.at_surfaces[i] += of_band_cell * n_band;
  }
}

/// Sums values on rank 0; the other ranks keep theirs.
void sum_on_root(const Communicator& comm, std::vector<GlobalIndex>& values) {
  MPI_Reduce(is_root(comm) ? MPI_IN_PLACE : values.data(), values.data(),
             static_cast<int>(values.size()), MPI_LONG_LONG, MPI_SUM, 0, raw_communicator(comm));
}

}  // namespace

template <int dim>
MacTiles<dim>::MacTiles(const ParameterList& fluid, MacFlow<dim>& flow) : flow_(flow) {
  if (!fluid.isSublist("Moving Tiles"))
    return;
  check_input(!flow_.liquid || flow_.liquid->interface().migrates(),
              "The interface \"{}\" cannot follow \"Moving Tiles\"; leave them out.",
              flow_.liquid ? flow_.liquid->interface().name() : "");
  moving_.emplace(fluid,
                  DomainDescription<dim>{flow_.domain.grid.description(), flow_.domain.boundary});
  owners_ = flow_.domain.grid.tile_owners();
}

template <int dim>
typename MovingTiles<dim>::Present MacTiles<dim>::present(const GridState<dim>& state, double time,
                                                          double dt) const {
  typename MovingTiles<dim>::Present present{
      flow_.domain.grid, owners_, state, flow_.velocity, 0, {}, time, dt, 0, nullptr, 0, false};
  for (const Scalar& scalar : flow_.scalars.all())
    present.scalars.push_back({scalar.values, scalar.ambient});
  if (flow_.liquid) {
    present.distance = &flow_.liquid->interface().distance();
    present.band = (1 - 1e-6) * flow_.liquid->interface().band(0) * flow_.domain.spacing();
  }
  return present;
}

template <int dim>
bool MacTiles<dim>::begin_step(double time, double dt, const std::function<double()>& solid_speed) {
  step_is_counted_ = false;
  if (!moving_) {
    if (share_work())
      steps_since_regrid_ = 0;
    return steps_since_regrid_ == 0;
  }
  auto now = present(flow_.geometry.state, time, dt);
  now.largest_speed = flow_.largest_speed();
  now.solid_speed = solid_speed();
  if (const std::optional<TileOwners> owners = moving_->change(now)) {
    regrid(*owners);
    steps_since_regrid_ = 0;
  } else if (share_work()) {
    steps_since_regrid_ = 0;
  }
  return steps_since_regrid_ == 0;
}

/// Gives ranks other tiles where surfaces, or liquid that is not everywhere, have made their work
/// uneven. The same work as at the last time would find the same tiles.
template <int dim>
bool MacTiles<dim>::share_work() {
  const Communicator& comm = flow_.domain.grid.comm();
  if (comm->getSize() == 1 || !(flow_.geometry.state.surface || flow_.liquid) ||
      steps_to_sharing_ > 0 || (flow_.liquid && !flow_.liquid->interface().migrates()))
    return false;
  constexpr int steps_between = 20;
  steps_to_sharing_ = steps_between;
  if (owners_.tiles.empty())
    owners_ = flow_.domain.grid.tile_owners();
  TileWork work = work_of_tiles(flow_.domain.grid, owners_, flow_.geometry.state.surface.get());
  if (flow_.liquid)
    add_liquid(flow_.domain.grid, owners_, flow_.liquid->interface().distance(),
               flow_.liquid->interface().band(0) * flow_.domain.spacing(), work);
  const GlobalIndex differs = work.at_surfaces != compared_work_.at_surfaces ||
                              work.everywhere != compared_work_.everywhere;
  if (max_all(comm, differs) == 0)
    return false;
  compared_work_ = work;
  sum_on_root(comm, work.at_surfaces);
  if (flow_.liquid)
    sum_on_root(comm, work.everywhere);
  const auto owners = share_better(flow_.domain.grid.tile_lattice(), comm, owners_, work);
  if (owners)
    regrid(*owners);
  return owners.has_value();
}

template <int dim>
void MacTiles<dim>::make_room(const Surface& surface) {
  if (!moving_)
    return;
  if (!has_room_)
    make_first_room(surface);
  if (surface)
    moving_->check_room(*surface, owners_, flow_.domain.grid.comm());
}

template <int dim>
void MacTiles<dim>::make_first_room(const Surface& surface) {
  GridState<dim> state;
  state.surface = surface;
  state.cells.assign(flow_.domain.grid.n_stored_cells(), CellState::fluid);
  constexpr double any_step = 1;
  auto now = present(state, flow_.time, any_step);
  now.is_start = true;
  if (const auto owners = moving_->change(now))
    regrid(*owners);
  has_room_ = true;
}

template <int dim>
void MacTiles<dim>::regrid(const TileOwners& owners) {
  TiledGrid<dim> grid(flow_.domain.grid.description(), flow_.domain.grid.comm(), owners);
  const TileMigration<dim> migration(flow_.domain.grid, grid);
  for (const StoredField& field : flow_.fields)
    migration.move(field.components, CellField(field.components.size(), field.at_rest));
  // A rank without tiles has none, whatever was accepted.
  if (max_all(flow_.domain.grid.comm(), static_cast<GlobalIndex>(flow_.accepted_cells.size())) >
      0) {
    std::vector<char> cells(flow_.accepted_cells.size());
    std::transform(flow_.accepted_cells.begin(), flow_.accepted_cells.end(), cells.begin(),
                   [](CellState state) { return static_cast<char>(state); });
    migration.move(cells, static_cast<char>(CellState::air));
    flow_.accepted_cells.resize(cells.size());
    std::transform(cells.begin(), cells.end(), flow_.accepted_cells.begin(),
                   [](char state) { return static_cast<CellState>(state); });
  }
  const std::function<void()> finish_liquid =
      flow_.liquid ? flow_.liquid->interface().migrate(migration) : std::function<void()>();
  flow_.geometry = {};
  flow_.forget_speed();
  flow_.ray_halo.forget();
  flow_.nearby = {};
  flow_.domain.set_grid(std::move(grid));
  if (finish_liquid)
    finish_liquid();
  flow_.blocks = lattice_blocks(flow_.domain.grid);
  owners_ = owners;
  has_room_ = true;
  rest_at_band_edge();
  flow_.prediction = flow_.velocity;
  flow_.scaled_pressure = flow_.accepted_pressure;
}

/// Nothing of what left the tiles that are gone may come back from their rim.
template <int dim>
void MacTiles<dim>::rest_at_band_edge() {
  const TiledGrid<dim>& grid = flow_.domain.grid;
  const std::vector<char> rim = find_band_edge(flow_.domain);
  if (rim.empty())
    return;
  grid.for_each_owned_cell([&](int cell) {
    if (!rim[cell])
      return;
    for (Scalar& scalar : flow_.scalars.all())
      scalar.values[cell] = scalar.ambient;
    for (int axis = 0; axis < dim; ++axis) {
      const int lower = grid.neighbor(cell, axis, 0);
      if (lower >= 0 && !rim[lower])
        continue;
      flow_.velocity[axis][cell] = 0;
      for (const StoredField& field : flow_.rates())
        (*field.components[axis])[cell] = 0;
    }
  });
  flow_.domain.full_halo.fill(flow_.velocity);
  for (const StoredField& field : flow_.rates())
    for (CellField* component : field.components)
      flow_.domain.full_halo.fill(*component);
  for (Scalar& scalar : flow_.scalars.all())
    flow_.domain.full_halo.fill(scalar.values);
}

template <int dim>
Momentum<dim> MacTiles<dim>::push_at_band_edge(const Point<dim>& force, double dt) {
  Momentum<dim> given;
  if (force == Point<dim>::Zero())
    return given;
  const TiledGrid<dim>& grid = flow_.domain.grid;
  const Point<dim> origin = origin_of_pressure(flow_.domain, flow_.domain.bounds());
  for (const auto& [axis, cell] : flow_.geometry.band_edge) {
    const bool is_above = flow_.geometry.state.cells[cell] == CellState::air;
    const Point<dim> face = grid.face_center(axis, cell);
    const Point<dim> beyond =
        face + (is_above ? 0.5 : -0.5) * grid.spacing() * Point<dim>::Unit(axis);
    const double pressure = flow_.parameters.density * force.dot(beyond - origin);
    const double change =
        (is_above ? -dt : dt) * flow_.geometry.face_table(axis, cell).gradient * pressure;
    flow_.prediction[axis][cell] += change;
    given.add(face, axis, flow_.geometry.mass(axis, cell) * change);
  }
  return given;
}

/// With their ranks: the sums of a run that goes on are those of one that never stopped.
template <int dim>
void MacTiles<dim>::save(CheckpointWriter& checkpoint) const {
  if (owners_.tiles.empty())
    return;
  const int rank = flow_.domain.grid.comm()->getRank();
  std::vector<GlobalIndex> mine;
  for (std::size_t i = 0; i < owners_.tiles.size(); ++i)
    if (owners_.ranks[i] == rank)
      mine.push_back(owners_.tiles[i]);
  checkpoint.write_distributed("fluid/tiles", mine, std::vector<long long>(mine.size(), rank));
  checkpoint.file().write_attribute<long long>("fluid/tiles", "ranks",
                                               flow_.domain.grid.comm()->getSize());
  checkpoint.file().write_attribute<long long>("fluid/tiles", "steps_to_sharing",
                                               steps_to_sharing_);
  checkpoint.file().write_attribute<long long>("fluid/tiles", "steps_since_regrid",
                                               steps_since_regrid_);
}

template <int dim>
void MacTiles<dim>::check_owners(const CheckpointReader& checkpoint, const TileOwners& owners,
                                 long long n_ranks) const {
  const auto& lattice = flow_.domain.grid.tile_lattice();
  GlobalIndex n_tiles = 1;
  for (int a = 0; a < dim; ++a)
    n_tiles *= lattice.n_tiles()[a];
  const auto exists = [&](GlobalIndex tile) { return tile >= 0 && tile < n_tiles; };
  const auto is_rank = [&](int rank) { return rank >= 0 && rank < n_ranks; };
  checkpoint.check(!owners.tiles.empty() && owners.ranks.size() == owners.tiles.size() &&
                       std::all_of(owners.tiles.begin(), owners.tiles.end(), exists) &&
                       std::adjacent_find(owners.tiles.begin(), owners.tiles.end(),
                                          std::greater_equal<>()) == owners.tiles.end() &&
                       std::all_of(owners.ranks.begin(), owners.ranks.end(), is_rank),
                   "its tiles and their ranks cannot be");
}

template <int dim>
void MacTiles<dim>::load(const CheckpointReader& checkpoint) {
  const Hdf5File& file = checkpoint.file();
  if (!file.exists("fluid/tiles"))
    return;
  TileOwners owners;
  for (const long long tile : file.read_all<long long>("fluid/tiles/ids"))
    owners.tiles.push_back(tile);
  for (const long long rank : file.read_all<long long>("fluid/tiles/values"))
    owners.ranks.push_back(static_cast<int>(rank));
  const Communicator& comm = flow_.domain.grid.comm();
  const auto n_ranks = file.read_attribute<long long>("fluid/tiles", "ranks");
  check_owners(checkpoint, owners, n_ranks);
  if (file.has_attribute("fluid/tiles", "steps_to_sharing"))
    steps_to_sharing_ =
        static_cast<int>(file.read_attribute<long long>("fluid/tiles", "steps_to_sharing"));
  if (file.has_attribute("fluid/tiles", "steps_since_regrid"))
    steps_since_regrid_ =
        static_cast<int>(file.read_attribute<long long>("fluid/tiles", "steps_since_regrid"));
  if (n_ranks != comm->getSize())
    owners = share_tiles(flow_.domain.grid.tile_lattice(), comm, owners.tiles,
                         std::vector<GlobalIndex>(owners.tiles.size(), tile_volume<dim>));
  regrid(owners);
}

template <int dim>
void MacTiles<dim>::accept() {
  if (step_is_counted_)
    return;
  step_is_counted_ = true;
  steps_since_regrid_ = std::min(steps_since_regrid_ + 1, 2);
  steps_to_sharing_ = std::max(steps_to_sharing_ - 1, 0);
}

template <int dim>
std::vector<std::pair<std::string, std::string>> MacTiles<dim>::notes() const {
  if (!moving_)
    return {};
  GlobalIndex n_tiles = 1;
  for (const int n : flow_.domain.grid.tile_lattice().n_domain_tiles())
    n_tiles *= n;
  return {{"moving tiles", fmt::format("{} of {} at the start", owners_.tiles.size(), n_tiles)}};
}

template class MacTiles<2>;
template class MacTiles<3>;

}  // namespace lockstep
