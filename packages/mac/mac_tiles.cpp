// How the grid of a MacFluid follows what happens in it.
#include "grid/tile_migration.hpp"
#include "mac/mac_fluid.hpp"
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

/// At surfaces that of this rank's tiles alone.
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

/// Of a liquid, that of this rank's tiles: in the place of the cells those that are wet, and what
/// its surface adds within so far of it.
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
    GlobalIndex n_wet = 0, n_band = 0;
    for (int k = 0; k < tile_volume<dim>; ++k) {
      const double phi = distance[tile * tile_volume<dim> + k];
      n_wet += phi < 0;
      n_band += std::abs(phi) < band;
    }
    work.everywhere[i] = n_wet + (tile_volume<dim> - n_wet) / dry_cells_a_wet_one;
    work.at_surfaces[i] += of_band_cell * n_band;
  }
}

/// On rank 0; the others keep theirs.
void sum_on_root(const Communicator& comm, std::vector<GlobalIndex>& values) {
  MPI_Reduce(is_root(comm) ? MPI_IN_PLACE : values.data(), values.data(),
             static_cast<int>(values.size()), MPI_LONG_LONG, MPI_SUM, 0, raw_communicator(comm));
}

}  // namespace

template <int dim>
typename MovingTiles<dim>::Present MacFluid<dim>::present(const GridState<dim>& state, double time,
                                                          double dt) const {
  typename MovingTiles<dim>::Present present{domain_.grid, owners_, state, velocity_, 0, {},
                                             time,         dt,      0,     nullptr,   0, false};
  for (const Scalar& scalar : scalars_.all())
    present.scalars.push_back({scalar.values, scalar.ambient});
  if (liquid_) {
    present.distance = &liquid_->interface().distance();
    present.band = (1 - 1e-6) * liquid_->interface().band(0) * domain_.spacing();
  }
  return present;
}

template <int dim>
MigratingInterface<dim>* MacFluid<dim>::migrating_interface() {
  return side_of<MigratingInterface<dim>>(liquid_->interface());
}

template <int dim>
bool MacFluid<dim>::begin_step(double time, double dt, const std::function<double()>& solid_speed) {
  if (time != time_) {  // a run that does not start at 0
    time_ = time;
    set_prescribed(time_, velocity_);
  }
  if (!moving_tiles_) {
    if (share_work())
      steps_since_regrid_ = 0;
    return steps_since_regrid_ == 0;
  }
  auto now = present(geometry_.state, time, dt);
  now.largest_speed = largest_speed();
  now.solid_speed = solid_speed();
  if (const std::optional<TileOwners> owners = moving_tiles_->change(now)) {
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
bool MacFluid<dim>::share_work() {
  const Communicator& comm = domain_.grid.comm();
  if (comm->getSize() == 1 || !(geometry_.state.surface || liquid_) || steps_to_sharing_ > 0 ||
      (liquid_ && !migrating_interface()))
    return false;
  constexpr int steps_between = 20;
  steps_to_sharing_ = steps_between;
  if (owners_.tiles.empty())
    owners_ = domain_.grid.tile_owners();
  TileWork work = work_of_tiles(domain_.grid, owners_, geometry_.state.surface.get());
  if (liquid_)
    add_liquid(domain_.grid, owners_, liquid_->interface().distance(),
               liquid_->interface().band(0) * domain_.spacing(), work);
  const GlobalIndex differs = work.at_surfaces != compared_work_.at_surfaces ||
                              work.everywhere != compared_work_.everywhere;
  if (max_all(comm, differs) == 0)
    return false;
  compared_work_ = work;
  sum_on_root(comm, work.at_surfaces);
  if (liquid_)
    sum_on_root(comm, work.everywhere);
  const auto owners = share_better(domain_.grid.tile_lattice(), comm, owners_, work);
  if (owners)
    regrid(*owners);
  return owners.has_value();
}

template <int dim>
void MacFluid<dim>::make_room_for(const Surface& surface) {
  GridState<dim> state;
  state.surface = surface;
  state.cells.assign(domain_.grid.n_stored_cells(), CellState::fluid);
  constexpr double any_step = 1;
  auto now = present(state, time_, any_step);
  now.is_start = true;
  if (const auto owners = moving_tiles_->change(now))
    regrid(*owners);
  has_room_ = true;
}

template <int dim>
void MacFluid<dim>::regrid(const TileOwners& owners) {
  TiledGrid<dim> grid(domain_.grid.description(), domain_.grid.comm(), owners);
  const TileMigration<dim> migration(domain_.grid, grid);
  for (const StoredField& field : fields_)
    migration.move(field.components, CellField(field.components.size(), field.at_rest));
  // A rank without tiles has none, whatever was accepted.
  if (max_all(domain_.grid.comm(), static_cast<GlobalIndex>(accepted_cells_.size())) > 0) {
    std::vector<char> cells(accepted_cells_.size());
    std::transform(accepted_cells_.begin(), accepted_cells_.end(), cells.begin(),
                   [](CellState state) { return static_cast<char>(state); });
    migration.move(cells, static_cast<char>(CellState::empty));
    accepted_cells_.resize(cells.size());
    std::transform(cells.begin(), cells.end(), accepted_cells_.begin(),
                   [](char state) { return static_cast<CellState>(state); });
  }
  const std::function<void()> finish_liquid =
      liquid_ ? migrating_interface()->migrate(migration) : std::function<void()>();
  viscosity_.reset();
  geometry_ = {};
  largest_speed_.reset();
  invalid_ = {};
  ray_halo_.forget();
  nearby_ = {};
  domain_.set_grid(std::move(grid));
  if (finish_liquid)
    finish_liquid();
  if (liquid_)
    liquid_->forget();
  lattice_blocks_ = lattice_blocks(domain_.grid);
  owners_ = owners;
  has_room_ = true;
  rest_at_rim();
  prediction_ = velocity_;
  scaled_pressure_ = accepted_pressure_;
}

/// Nothing of what left the tiles that are gone may come back from their rim.
template <int dim>
void MacFluid<dim>::rest_at_rim() {
  const TiledGrid<dim>& grid = domain_.grid;
  const std::vector<char> rim = find_rim(domain_);
  if (rim.empty())
    return;
  grid.for_each_owned_cell([&](int cell) {
    if (!rim[cell])
      return;
    for (Scalar& scalar : scalars_.all())
      scalar.values[cell] = scalar.ambient;
    for (int axis = 0; axis < dim; ++axis) {
      const int lower = grid.neighbor(cell, axis, 0);
      if (lower >= 0 && !rim[lower])
        continue;
      velocity_[axis][cell] = 0;
      if (history_)
        for (const StoredField& field : history_->fields())
          (*field.components[axis])[cell] = 0;
    }
  });
  domain_.full_halo.fill(velocity_);
  if (history_)
    for (const StoredField& field : history_->fields())
      for (CellField* component : field.components)
        domain_.full_halo.fill(*component);
  for (Scalar& scalar : scalars_.all())
    domain_.full_halo.fill(scalar.values);
}

template <int dim>
Momentum<dim> MacFluid<dim>::push_at_rim(const Point<dim>& force, double dt) {
  Momentum<dim> given;
  if (force == Point<dim>::Zero())
    return given;
  const TiledGrid<dim>& grid = domain_.grid;
  const Point<dim> origin = origin_of_pressure(domain_, bounds());
  for (const auto& [axis, cell] : geometry_.rim) {
    const bool is_above = geometry_.state.cells[cell] == CellState::empty;
    const Point<dim> face = grid.face_center(axis, cell);
    const Point<dim> beyond =
        face + (is_above ? 0.5 : -0.5) * grid.spacing() * Point<dim>::Unit(axis);
    const double pressure = parameters_.density * force.dot(beyond - origin);
    const double change =
        (is_above ? -dt : dt) * geometry_.face_table(axis, cell).gradient * pressure;
    prediction_[axis][cell] += change;
    given.add(face, axis, geometry_.mass(axis, cell) * change);
  }
  return given;
}

/// With their ranks: the sums of a run that goes on are those of one that never stopped.
template <int dim>
void MacFluid<dim>::save_tiles(CheckpointWriter& checkpoint) const {
  if (owners_.tiles.empty())
    return;
  const int rank = domain_.grid.comm()->getRank();
  std::vector<GlobalIndex> mine;
  for (std::size_t i = 0; i < owners_.tiles.size(); ++i)
    if (owners_.ranks[i] == rank)
      mine.push_back(owners_.tiles[i]);
  checkpoint.write_distributed("fluid/tiles", mine, std::vector<long long>(mine.size(), rank));
  checkpoint.file().write_attribute<long long>("fluid/tiles", "ranks",
                                               domain_.grid.comm()->getSize());
  checkpoint.file().write_attribute<long long>("fluid/tiles", "steps_to_sharing",
                                               steps_to_sharing_);
  checkpoint.file().write_attribute<long long>("fluid/tiles", "steps_since_regrid",
                                               steps_since_regrid_);
}

template <int dim>
void MacFluid<dim>::load_tiles(const CheckpointReader& checkpoint) {
  const Hdf5File& file = checkpoint.file();
  if (!file.exists("fluid/tiles"))
    return;
  TileOwners owners;
  for (const long long tile : file.read_all<long long>("fluid/tiles/ids"))
    owners.tiles.push_back(tile);
  for (const long long rank : file.read_all<long long>("fluid/tiles/values"))
    owners.ranks.push_back(static_cast<int>(rank));
  const Communicator& comm = domain_.grid.comm();
  if (file.has_attribute("fluid/tiles", "steps_to_sharing"))
    steps_to_sharing_ =
        static_cast<int>(file.read_attribute<long long>("fluid/tiles", "steps_to_sharing"));
  if (file.has_attribute("fluid/tiles", "steps_since_regrid"))
    steps_since_regrid_ =
        static_cast<int>(file.read_attribute<long long>("fluid/tiles", "steps_since_regrid"));
  if (file.read_attribute<long long>("fluid/tiles", "ranks") != comm->getSize())
    owners = share_tiles(domain_.grid.tile_lattice(), comm, owners.tiles,
                         std::vector<GlobalIndex>(owners.tiles.size(), tile_volume<dim>));
  regrid(owners);
}

template MovingTiles<2>::Present MacFluid<2>::present(const GridState<2>&, double, double) const;
template MovingTiles<3>::Present MacFluid<3>::present(const GridState<3>&, double, double) const;
template bool MacFluid<2>::begin_step(double, double, const std::function<double()>&);
template bool MacFluid<3>::begin_step(double, double, const std::function<double()>&);
template MigratingInterface<2>* MacFluid<2>::migrating_interface();
template MigratingInterface<3>* MacFluid<3>::migrating_interface();
template bool MacFluid<2>::share_work();
template bool MacFluid<3>::share_work();
template void MacFluid<2>::make_room_for(const Surface&);
template void MacFluid<3>::make_room_for(const Surface&);
template void MacFluid<2>::regrid(const TileOwners&);
template void MacFluid<3>::regrid(const TileOwners&);
template void MacFluid<2>::rest_at_rim();
template void MacFluid<3>::rest_at_rim();
template Momentum<2> MacFluid<2>::push_at_rim(const Point<2>&, double);
template Momentum<3> MacFluid<3>::push_at_rim(const Point<3>&, double);
template void MacFluid<2>::save_tiles(CheckpointWriter&) const;
template void MacFluid<3>::save_tiles(CheckpointWriter&) const;
template void MacFluid<2>::load_tiles(const CheckpointReader&);
template void MacFluid<3>::load_tiles(const CheckpointReader&);

}  // namespace lockstep
