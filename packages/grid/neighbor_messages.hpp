#pragma once
#include <map>
#include <vector>

#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Numbers of any count for the ranks that own ghost tiles of a grid: one message to each.
template <int dim>
class NeighborMessages {
 public:
  explicit NeighborMessages(const TiledGrid<dim>& grid);

  /// Returns the message to the owner of a stored cell of another rank.
  std::vector<double>& to_owner(const TiledGrid<dim>& grid, int cell) {
    return outgoing_[grid.owner(TiledGrid<dim>::tile_of(cell))];
  }
  /// Collective: delivers what was put in since the last call and returns what has arrived, in the
  /// order of the senders.
  std::vector<double> exchange();

 private:
  Communicator comm_;
  std::map<int, std::vector<double>> outgoing_;  ///< one for each neighbour, empty ones too
};

}  // namespace lockstep
