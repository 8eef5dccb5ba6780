#pragma once
#include <cstring>
#include <type_traits>
#include <vector>

#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Carries what lives on one grid over to another of the same lattice with other tiles, or the same
/// tiles on other ranks. Made once for a change, used for all that lives by the tiles; it refers to
/// neither grid afterwards. Every call sends one message to each rank that takes tiles from this
/// one. Collective calls must be made in the same order on all ranks.
template <int dim>
class TileMigration {
 public:
  /// Collective.
  TileMigration(const TiledGrid<dim>& from, const TiledGrid<dim>& to);

  /// Collective: fields of the old grid become fields of the new one. Its stored cells, ghosts
  /// included, have the values of the old grid's owned cells, and `fill` of each field where there
  /// was no tile. Values are double, int, char or GlobalIndex.
  template <typename Value>
  void move(const std::vector<std::vector<Value>*>& fields, const std::vector<Value>& fill) const;
  template <typename Value, typename = std::enable_if_t<!std::is_pointer_v<Value>>>
  void move(std::vector<Value>& field, Value fill = {}) const {
    move(std::vector<std::vector<Value>*>{&field}, std::vector<Value>{fill});
  }
  void move(FaceField<dim>& field, double fill = 0) const;

  /// Collective: lists by owned tile, of any length and of anything that can be copied byte by
  /// byte, as the particles of each tile. A new tile has an empty one; the lists of tiles that are
  /// gone are lost.
  template <typename Item>
  void move_lists(std::vector<std::vector<Item>>& of_tile) const;

  /// Owned tiles of the old grid that are gone on all ranks, by their local numbers there.
  const std::vector<int>& gone() const { return gone_; }
  /// Owned tiles that are gone, and those that are new, on this rank.
  int n_gone() const { return static_cast<int>(gone_.size()); }
  int n_new() const { return n_new_; }

 private:
  /// A rank that tiles come from and go to (maybe this one): old local tiles and new ones, in the
  /// order both sides agree on, first those that the receiver owns.
  struct Peer {
    int rank = 0;
    std::vector<int> sent, received;
    int n_owned_sent = 0, n_owned_received = 0;
  };
  using Bytes = std::vector<std::vector<char>>;

  /// Sends outgoing[p] to each peer p; incoming[p] has the right size before.
  void transfer(const Bytes& outgoing, Bytes& incoming) const;
  /// `of_tile`: bytes by owned tile.
  void move_bytes(Bytes& of_tile) const;

  Communicator comm_;
  int n_old_tiles_ = 0, n_tiles_ = 0, n_owned_tiles_ = 0;
  int n_new_ = 0;
  std::vector<int> gone_;
  std::vector<Peer> peers_;
};

template <int dim>
template <typename Item>
void TileMigration<dim>::move_lists(std::vector<std::vector<Item>>& of_tile) const {
  static_assert(std::is_trivially_copyable_v<Item>);
  Bytes bytes(of_tile.size());
  for (std::size_t tile = 0; tile < of_tile.size(); ++tile) {
    bytes[tile].resize(of_tile[tile].size() * sizeof(Item));
    if (!bytes[tile].empty())
      std::memcpy(bytes[tile].data(), of_tile[tile].data(), bytes[tile].size());
  }
  move_bytes(bytes);
  of_tile.assign(bytes.size(), {});
  for (std::size_t tile = 0; tile < bytes.size(); ++tile) {
    of_tile[tile].resize(bytes[tile].size() / sizeof(Item));
    if (!bytes[tile].empty())
      std::memcpy(of_tile[tile].data(), bytes[tile].data(), bytes[tile].size());
  }
}

}  // namespace lockstep
