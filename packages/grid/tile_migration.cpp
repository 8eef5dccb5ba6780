#include "grid/tile_migration.hpp"

#include <map>

#include "grid/message_tag.hpp"

namespace lockstep {

namespace {

/// Numbers of the stored tiles, by local tile.
template <int dim>
std::vector<GlobalIndex> tile_numbers(const TiledGrid<dim>& grid, int n_tiles) {
  std::vector<GlobalIndex> numbers;
  for (int t = 0; t < n_tiles; ++t) {
    Index<dim> tile = grid.tile_begin(t);
    for (int& i : tile)
      i /= tile_width<dim>;
    numbers.push_back(grid.tile_lattice().tile_number(tile));
  }
  return numbers;
}

/// Rank of each tile of a grid, by number.
std::map<GlobalIndex, int> ranks_by_number(const Communicator& comm,
                                           const std::vector<GlobalIndex>& mine) {
  std::vector<GlobalIndex> pairs;
  for (const GlobalIndex number : mine)
    pairs.insert(pairs.end(), {number, static_cast<GlobalIndex>(comm->getRank())});
  const std::vector<GlobalIndex> all = gather_all(comm, pairs);
  std::map<GlobalIndex, int> ranks;
  for (std::size_t i = 0; i < all.size(); i += 2)
    ranks[all[i]] = static_cast<int>(all[i + 1]);
  return ranks;
}

}  // namespace

template <int dim>
TileMigration<dim>::TileMigration(const TiledGrid<dim>& from, const TiledGrid<dim>& to)
    : comm_(to.comm()),
      n_old_tiles_(from.n_tiles()),
      n_tiles_(to.n_tiles()),
      n_owned_tiles_(to.n_owned_tiles()) {
  const std::vector<GlobalIndex> old_numbers = tile_numbers(from, from.n_owned_tiles());
  const std::vector<GlobalIndex> numbers = tile_numbers(to, n_tiles_);
  const std::map<GlobalIndex, int> old_ranks = ranks_by_number(comm_, old_numbers);
  const std::map<GlobalIndex, int> new_ranks =
      ranks_by_number(comm_, {numbers.begin(), numbers.begin() + n_owned_tiles_});
  for (std::size_t tile = 0; tile < old_numbers.size(); ++tile)
    if (new_ranks.count(old_numbers[tile]) == 0)
      gone_.push_back(static_cast<int>(tile));

  // tiles that this rank wants of each rank, in the order of its tiles: owned ones come first
  const int n_ranks = comm_->getSize();
  std::vector<std::vector<int>> wanted(n_ranks);
  std::vector<int> n_wanted(2 * n_ranks, 0), n_asked(2 * n_ranks);
  for (int t = 0; t < n_tiles_; ++t) {
    const auto found = old_ranks.find(numbers[t]);
    const bool owned = t < n_owned_tiles_;
    n_new_ += owned && found == old_ranks.end();
    if (found == old_ranks.end())
      continue;
    wanted[found->second].push_back(t);
    ++n_wanted[2 * found->second];
    n_wanted[2 * found->second + 1] += owned;
  }
  MPI_Alltoall(n_wanted.data(), 2, MPI_INT, n_asked.data(), 2, MPI_INT, raw_communicator(comm_));
  Bytes outgoing, incoming;
  for (int rank = 0; rank < n_ranks; ++rank) {
    if (n_wanted[2 * rank] == 0 && n_asked[2 * rank] == 0)
      continue;
    Peer peer;
    peer.rank = rank;
    peer.received = wanted[rank];
    peer.n_owned_received = n_wanted[2 * rank + 1];
    peer.n_owned_sent = n_asked[2 * rank + 1];
    std::vector<char> request(peer.received.size() * sizeof(GlobalIndex));
    for (std::size_t i = 0; i < peer.received.size(); ++i)
      std::memcpy(request.data() + i * sizeof(GlobalIndex), &numbers[peer.received[i]],
                  sizeof(GlobalIndex));
    outgoing.push_back(std::move(request));
    incoming.emplace_back(n_asked[2 * rank] * sizeof(GlobalIndex));
    peers_.push_back(std::move(peer));
  }
  transfer(outgoing, incoming);
  std::map<GlobalIndex, int> old_tile;
  for (std::size_t t = 0; t < old_numbers.size(); ++t)
    old_tile[old_numbers[t]] = static_cast<int>(t);
  for (std::size_t p = 0; p < peers_.size(); ++p)
    for (std::size_t i = 0; i < incoming[p].size(); i += sizeof(GlobalIndex)) {
      GlobalIndex number;
      std::memcpy(&number, incoming[p].data() + i, sizeof(GlobalIndex));
      peers_[p].sent.push_back(old_tile.at(number));
    }
}

template <int dim>
void TileMigration<dim>::transfer(const Bytes& outgoing, Bytes& incoming) const {
  const MPI_Comm mpi = raw_communicator(comm_);
  // Lists of tiles may be longer than an int counts bytes.
  constexpr std::size_t most = std::size_t{1} << 30;
  std::vector<MPI_Request> requests;
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    const int rank = peers_[p].rank;
    if (rank == comm_->getRank()) {
      incoming[p] = outgoing[p];
      continue;
    }
    for (std::size_t begin = 0; begin < incoming[p].size(); begin += most)
      MPI_Irecv(incoming[p].data() + begin,
                static_cast<int>(std::min(most, incoming[p].size() - begin)), MPI_BYTE, rank,
                MessageTag::migration, mpi, &requests.emplace_back());
    for (std::size_t begin = 0; begin < outgoing[p].size(); begin += most)
      MPI_Isend(outgoing[p].data() + begin,
                static_cast<int>(std::min(most, outgoing[p].size() - begin)), MPI_BYTE, rank,
                MessageTag::migration, mpi, &requests.emplace_back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

template <int dim>
template <typename Value>
void TileMigration<dim>::move(const std::vector<std::vector<Value>*>& fields,
                              const std::vector<Value>& fill) const {
  constexpr std::size_t bytes_per_tile = tile_volume<dim> * sizeof(Value);
  LOCKSTEP_ASSERT(fields.size() == fill.size());
  Bytes outgoing(peers_.size()), incoming(peers_.size());
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    if (peers_[p].rank == comm_->getRank())
      continue;
    outgoing[p].resize(peers_[p].sent.size() * fields.size() * bytes_per_tile);
    incoming[p].resize(peers_[p].received.size() * fields.size() * bytes_per_tile);
    char* to = outgoing[p].data();
    for (const std::vector<Value>* field : fields) {
      LOCKSTEP_ASSERT(static_cast<int>(field->size()) == n_old_tiles_ * tile_volume<dim>);
      for (const int tile : peers_[p].sent) {
        std::memcpy(to, field->data() + tile * tile_volume<dim>, bytes_per_tile);
        to += bytes_per_tile;
      }
    }
  }
  transfer(outgoing, incoming);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    std::vector<Value>& field = *fields[f];
    const std::vector<Value> before = std::move(field);
    field = std::vector<Value>(static_cast<std::size_t>(n_tiles_) * tile_volume<dim>, fill[f]);
    for (std::size_t p = 0; p < peers_.size(); ++p) {
      const std::vector<int>& tiles = peers_[p].received;
      if (peers_[p].rank == comm_->getRank()) {
        for (std::size_t i = 0; i < tiles.size(); ++i)
          std::memcpy(field.data() + tiles[i] * tile_volume<dim>,
                      before.data() + peers_[p].sent[i] * tile_volume<dim>, bytes_per_tile);
        continue;
      }
      const char* from = incoming[p].data() + f * tiles.size() * bytes_per_tile;
      for (const int tile : tiles) {
        std::memcpy(field.data() + tile * tile_volume<dim>, from, bytes_per_tile);
        from += bytes_per_tile;
      }
    }
  }
}

template <int dim>
void TileMigration<dim>::move(FaceField<dim>& field, double fill) const {
  std::vector<CellField*> components;
  for (CellField& component : field)
    components.push_back(&component);
  move(components, std::vector<double>(dim, fill));
}

template <int dim>
void TileMigration<dim>::move_bytes(Bytes& of_tile) const {
  using Length = unsigned long long;
  Bytes lengths(peers_.size()), their_lengths(peers_.size());
  Bytes outgoing(peers_.size()), incoming(peers_.size());
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    their_lengths[p].resize(peers_[p].n_owned_received * sizeof(Length));
    for (int i = 0; i < peers_[p].n_owned_sent; ++i) {
      const std::vector<char>& list = of_tile[peers_[p].sent[i]];
      const Length length = list.size();
      const char* bytes = reinterpret_cast<const char*>(&length);
      lengths[p].insert(lengths[p].end(), bytes, bytes + sizeof(Length));
      outgoing[p].insert(outgoing[p].end(), list.begin(), list.end());
    }
  }
  transfer(lengths, their_lengths);
  const auto length_of = [&](std::size_t p, int i) {
    Length length;
    std::memcpy(&length, their_lengths[p].data() + i * sizeof(Length), sizeof(Length));
    return length;
  };
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    Length n = 0;
    for (int i = 0; i < peers_[p].n_owned_received; ++i)
      n += length_of(p, i);
    incoming[p].resize(n);
  }
  transfer(outgoing, incoming);
  of_tile.assign(n_owned_tiles_, {});
  for (std::size_t p = 0; p < peers_.size(); ++p) {
    auto from = incoming[p].begin();
    for (int i = 0; i < peers_[p].n_owned_received; ++i) {
      const auto end = from + static_cast<std::ptrdiff_t>(length_of(p, i));
      of_tile[peers_[p].received[i]].assign(from, end);
      from = end;
    }
  }
}

template class TileMigration<2>;
template class TileMigration<3>;
template void TileMigration<2>::move(const std::vector<std::vector<double>*>&,
                                     const std::vector<double>&) const;
template void TileMigration<2>::move(const std::vector<std::vector<int>*>&,
                                     const std::vector<int>&) const;
template void TileMigration<2>::move(const std::vector<std::vector<char>*>&,
                                     const std::vector<char>&) const;
template void TileMigration<2>::move(const std::vector<std::vector<GlobalIndex>*>&,
                                     const std::vector<GlobalIndex>&) const;
template void TileMigration<3>::move(const std::vector<std::vector<double>*>&,
                                     const std::vector<double>&) const;
template void TileMigration<3>::move(const std::vector<std::vector<int>*>&,
                                     const std::vector<int>&) const;
template void TileMigration<3>::move(const std::vector<std::vector<char>*>&,
                                     const std::vector<char>&) const;
template void TileMigration<3>::move(const std::vector<std::vector<GlobalIndex>*>&,
                                     const std::vector<GlobalIndex>&) const;

}  // namespace lockstep
