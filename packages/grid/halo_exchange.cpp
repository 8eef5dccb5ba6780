#include "grid/halo_exchange.hpp"

#include <algorithm>
#include <cstring>

#include "grid/message_tag.hpp"

namespace lockstep {
namespace {

/// Sets the flags of the cells [begin, end) of a tile.
template <int dim>
void flag_box(char* flags, const Index<dim>& begin, const Index<dim>& end) {
  const int z_begin = dim == 3 ? begin[dim - 1] : 0, z_end = dim == 3 ? end[dim - 1] : 1;
  for (int z = z_begin; z < z_end; ++z) {
    for (int y = begin[1]; y < end[1]; ++y) {
      char* row = flags + (z * tile_width<dim> + y) * tile_width<dim>;
      std::fill(row + begin[0], row + end[0], 1);
    }
  }
}

/// The ghost cells within `width` of an owned cell, in ascending order of id.
template <int dim>
std::vector<int> find_halo(const TiledGrid<dim>& grid, int width) {
  const TileLattice<dim>& lattice = grid.tile_lattice();
  std::vector<char> in_halo(grid.n_stored_cells() - grid.n_owned_cells(), 0);
  std::vector<char> whole_tile(grid.n_tiles(), 0);
  for (int t = 0; t < grid.n_owned_tiles(); ++t) {
    Index<dim> tile{};
    for (int a = 0; a < dim; ++a)
      tile[a] = grid.tile_begin(t)[a] / tile_width<dim>;
    lattice.for_each_tile_within(
        tile, width, [&](const Index<dim>& other, const Index<dim>& begin, const Index<dim>& end) {
          Index<dim> first{};
          for (int a = 0; a < dim; ++a)
            first[a] = other[a] * tile_width<dim>;
          const int cell = grid.cell(first);
          if (cell < 0 || grid.owned(cell) || whole_tile[grid.tile_of(cell)])
            return;
          flag_box<dim>(in_halo.data() + (cell - grid.n_owned_cells()), begin, end);
          whole_tile[grid.tile_of(cell)] = begin == Index<dim>{} && end == lattice.extent(other);
        });
  }
  std::vector<int> halo;
  for (std::size_t i = 0; i < in_halo.size(); ++i)
    if (in_halo[i])
      halo.push_back(grid.n_owned_cells() + static_cast<int>(i));
  return halo;
}

template <typename Value>
void pack(const std::vector<std::vector<Value>*>& fields, const std::vector<int>& cells, int begin,
          int end, char*& buffer) {
  for (const std::vector<Value>* field : fields) {
    for (int i = begin; i < end; ++i) {
      std::memcpy(buffer, &(*field)[cells[i]], sizeof(Value));
      buffer += sizeof(Value);
    }
  }
}

template <typename Value>
Value unpack_one(const char*& buffer) {
  Value value;
  std::memcpy(&value, buffer, sizeof(Value));
  buffer += sizeof(Value);
  return value;
}

}  // namespace

template <int dim>
HaloExchange<dim>::HaloExchange(const TiledGrid<dim>& grid, int width)
    : comm_(grid.comm()), width_(width), n_stored_cells_(grid.n_stored_cells()) {
  check_input(
      width >= 1 && width <= grid.ghost_width(),
      "A halo of {} cells was asked of a grid whose ghost tiles reach {}; make a grid with a "
      "wider reach.",
      width, grid.ghost_width());
  ghost_cells_ = find_halo(grid, width);
  // Reach is mutual, so the owners of this rank's ghost tiles are just those that hold its tiles.
  for (int t = grid.n_owned_tiles(); t < grid.n_tiles(); ++t) {
    if (neighbors_.empty() || neighbors_.back().rank != grid.owner(t)) {
      neighbors_.emplace_back();
      neighbors_.back().rank = grid.owner(t);
    }
  }
  int next = 0;
  const int n_ghosts = n_halo_cells();
  for (Neighbor& neighbor : neighbors_) {
    neighbor.ghost_begin = next;
    while (next < n_ghosts && grid.owner(grid.tile_of(ghost_cells_[next])) == neighbor.rank)
      ++next;
    neighbor.ghost_end = next;
  }
  LOCKSTEP_ASSERT(next == n_ghosts);
  agree_on_sources(grid);
}

template <int dim>
void HaloExchange<dim>::agree_on_sources(const TiledGrid<dim>& grid) {
  const MPI_Comm mpi = raw_communicator(comm_);
  const std::size_t n = neighbors_.size();
  std::vector<MPI_Request> requests(2 * n);
  std::vector<int> n_wanted(n), n_asked(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Neighbor& neighbor = neighbors_[i];
    n_wanted[i] = neighbor.ghost_end - neighbor.ghost_begin;
    MPI_Irecv(&n_asked[i], 1, MPI_INT, neighbor.rank, MessageTag::halo, mpi, &requests[2 * i]);
    MPI_Isend(&n_wanted[i], 1, MPI_INT, neighbor.rank, MessageTag::halo, mpi, &requests[2 * i + 1]);
  }
  MPI_Waitall(static_cast<int>(2 * n), requests.data(), MPI_STATUSES_IGNORE);

  int n_sources = 0;
  for (std::size_t i = 0; i < n; ++i) {
    neighbors_[i].source_begin = n_sources;
    neighbors_[i].source_end = n_sources += n_asked[i];
  }
  std::vector<GlobalIndex> wanted(ghost_cells_.size()), asked(n_sources);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    wanted[i] = grid.global_id(ghost_cells_[i]);
  for (std::size_t i = 0; i < n; ++i) {
    const Neighbor& neighbor = neighbors_[i];
    MPI_Irecv(asked.data() + neighbor.source_begin, n_asked[i], MPI_LONG_LONG, neighbor.rank,
              MessageTag::halo, mpi, &requests[2 * i]);
    MPI_Isend(wanted.data() + neighbor.ghost_begin, n_wanted[i], MPI_LONG_LONG, neighbor.rank,
              MessageTag::halo, mpi, &requests[2 * i + 1]);
  }
  MPI_Waitall(static_cast<int>(2 * n), requests.data(), MPI_STATUSES_IGNORE);
  source_cells_.resize(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    source_cells_[i] = grid.cell_of_global_id(asked[i]);
    LOCKSTEP_ASSERT(source_cells_[i] >= 0 && grid.owned(source_cells_[i]));
  }
}

template <int dim>
void HaloExchange<dim>::transfer(const std::vector<char>& outgoing, std::vector<char>& incoming,
                                 bool to_owner, std::size_t bytes_per_cell) const {
  const MPI_Comm mpi = raw_communicator(comm_);
  // One element of the type is one cell, so that counts fit an int whatever the number of fields.
  MPI_Datatype cell_type;
  MPI_Type_contiguous(static_cast<int>(bytes_per_cell), MPI_BYTE, &cell_type);
  MPI_Type_commit(&cell_type);
  std::vector<MPI_Request> requests;
  for (const Neighbor& neighbor : neighbors_) {
    int in_begin = neighbor.ghost_begin, in_end = neighbor.ghost_end;
    int out_begin = neighbor.source_begin, out_end = neighbor.source_end;
    if (to_owner) {
      std::swap(in_begin, out_begin);
      std::swap(in_end, out_end);
    }
    if (in_end > in_begin) {
      MPI_Irecv(incoming.data() + in_begin * bytes_per_cell, in_end - in_begin, cell_type,
                neighbor.rank, MessageTag::halo, mpi, &requests.emplace_back());
    }
    if (out_end > out_begin) {
      MPI_Isend(outgoing.data() + out_begin * bytes_per_cell, out_end - out_begin, cell_type,
                neighbor.rank, MessageTag::halo, mpi, &requests.emplace_back());
      ++statistics_.messages;
      statistics_.bytes += static_cast<long long>((out_end - out_begin) * bytes_per_cell);
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Type_free(&cell_type);
}

template <int dim>
template <typename Value>
void HaloExchange<dim>::fill(const std::vector<std::vector<Value>*>& fields) const {
  if (fields.empty() || neighbors_.empty())
    return;
  const std::size_t bytes_per_cell = fields.size() * sizeof(Value);
  outgoing_.resize(source_cells_.size() * bytes_per_cell);
  incoming_.resize(ghost_cells_.size() * bytes_per_cell);
  char* end = outgoing_.data();
  for (const Neighbor& neighbor : neighbors_)
    pack(fields, source_cells_, neighbor.source_begin, neighbor.source_end, end);
  transfer(outgoing_, incoming_, false, bytes_per_cell);
  const char* next = incoming_.data();
  for (const Neighbor& neighbor : neighbors_) {
    for (std::vector<Value>* field : fields) {
      LOCKSTEP_ASSERT(static_cast<int>(field->size()) == n_stored_cells_);
      for (int i = neighbor.ghost_begin; i < neighbor.ghost_end; ++i)
        (*field)[ghost_cells_[i]] = unpack_one<Value>(next);
    }
  }
}

template <int dim>
template <typename Value>
void HaloExchange<dim>::fill(TileField<dim, Value>& field) const {
  LOCKSTEP_ASSERT(field.n_stored_tiles() << log_tile_volume<dim> ==
                  static_cast<std::size_t>(n_stored_cells_));
  if (neighbors_.empty())
    return;
  outgoing_.resize(source_cells_.size() * sizeof(Value));
  incoming_.resize(ghost_cells_.size() * sizeof(Value));
  char* end = outgoing_.data();
  for (const int cell : source_cells_) {
    const Value value = field[cell];
    std::memcpy(end, &value, sizeof(Value));
    end += sizeof(Value);
  }
  transfer(outgoing_, incoming_, false, sizeof(Value));
  const char* next = incoming_.data();
  for (const int cell : ghost_cells_)
    if (const Value value = unpack_one<Value>(next); field.has(cell))
      field.set(cell, value);
}

template <int dim>
template <typename Value>
void HaloExchange<dim>::sum_to_owner(const std::vector<std::vector<Value>*>& fields) const {
  if (fields.empty() || neighbors_.empty())
    return;
  const std::size_t bytes_per_cell = fields.size() * sizeof(Value);
  outgoing_.resize(ghost_cells_.size() * bytes_per_cell);
  incoming_.resize(source_cells_.size() * bytes_per_cell);
  char* end = outgoing_.data();
  for (const Neighbor& neighbor : neighbors_)
    pack(fields, ghost_cells_, neighbor.ghost_begin, neighbor.ghost_end, end);
  transfer(outgoing_, incoming_, true, bytes_per_cell);
  for (std::vector<Value>* field : fields) {
    LOCKSTEP_ASSERT(static_cast<int>(field->size()) == n_stored_cells_);
    for (const int cell : ghost_cells_)
      (*field)[cell] = Value{};
  }
  const char* next = incoming_.data();
  for (const Neighbor& neighbor : neighbors_) {
    for (std::vector<Value>* field : fields) {
      for (int i = neighbor.source_begin; i < neighbor.source_end; ++i) {
        Value& sum = (*field)[source_cells_[i]];
        sum = static_cast<Value>(sum + unpack_one<Value>(next));
      }
    }
  }
}

template <int dim>
void HaloExchange<dim>::fill(FaceField<dim>& field) const {
  std::vector<CellField*> components;
  for (CellField& component : field)
    components.push_back(&component);
  fill(components);
}

template <int dim>
void HaloExchange<dim>::sum_to_owner(FaceField<dim>& field) const {
  std::vector<CellField*> components;
  for (CellField& component : field)
    components.push_back(&component);
  sum_to_owner(components);
}

template class HaloExchange<2>;
template class HaloExchange<3>;
template void HaloExchange<2>::fill(const std::vector<std::vector<double>*>&) const;
template void HaloExchange<2>::fill(const std::vector<std::vector<int>*>&) const;
template void HaloExchange<2>::fill(const std::vector<std::vector<char>*>&) const;
template void HaloExchange<2>::fill(const std::vector<std::vector<GlobalIndex>*>&) const;
template void HaloExchange<3>::fill(const std::vector<std::vector<double>*>&) const;
template void HaloExchange<3>::fill(const std::vector<std::vector<int>*>&) const;
template void HaloExchange<3>::fill(const std::vector<std::vector<char>*>&) const;
template void HaloExchange<3>::fill(const std::vector<std::vector<GlobalIndex>*>&) const;
template void HaloExchange<2>::fill(TileField<2>&) const;
template void HaloExchange<3>::fill(TileField<3>&) const;
template void HaloExchange<2>::sum_to_owner(const std::vector<std::vector<double>*>&) const;
template void HaloExchange<2>::sum_to_owner(const std::vector<std::vector<int>*>&) const;
template void HaloExchange<2>::sum_to_owner(const std::vector<std::vector<char>*>&) const;
template void HaloExchange<2>::sum_to_owner(const std::vector<std::vector<GlobalIndex>*>&) const;
template void HaloExchange<3>::sum_to_owner(const std::vector<std::vector<double>*>&) const;
template void HaloExchange<3>::sum_to_owner(const std::vector<std::vector<int>*>&) const;
template void HaloExchange<3>::sum_to_owner(const std::vector<std::vector<char>*>&) const;
template void HaloExchange<3>::sum_to_owner(const std::vector<std::vector<GlobalIndex>*>&) const;

}  // namespace lockstep
