#pragma once
#include <initializer_list>
#include <type_traits>
#include <vector>

#include "grid/tile_field.hpp"
#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Count of what this rank has sent through a HaloExchange.
struct HaloStatistics {
  long long messages = 0;
  long long bytes = 0;
};

/// Copies values of owned cells into the ghost copies on other ranks. Built once for a grid and a
/// width, used for any number of fields; it does not refer to the grid afterwards. Collective calls
/// must be made in the same order on all ranks; one message to each neighbouring rank per call.
/// Values are double, int, char or GlobalIndex.
template <int dim>
class HaloExchange {
 public:
  /// Collective. The halo is the ghost lattice cells within `width` cells (maximum norm, through
  /// periodic boundaries and existing tiles or not) of an owned lattice cell. Throws InputError if
  /// `width` is not in 1 .. grid.ghost_width().
  HaloExchange(const TiledGrid<dim>& grid, int width);

  /// Collective: sets the halo cells of fields of size n_stored_cells() to their owners' values.
  /// Other ghost cells keep theirs.
  template <typename Value, typename = std::enable_if_t<!std::is_pointer_v<Value>>>
  void fill(std::vector<Value>& field) const {
    fill(std::vector<std::vector<Value>*>{&field});
  }
  void fill(FaceField<dim>& field) const;
  /// Several fields in one message to each neighbour.
  template <typename Value>
  void fill(const std::vector<std::vector<Value>*>& fields) const;
  template <typename Value>
  void fill(std::initializer_list<std::vector<Value>*> fields) const {
    fill(std::vector<std::vector<Value>*>(fields));
  }

  /// Fills the ghost cells for which the field has values here; a tile without values at its owner
  /// contributes the field's value elsewhere.
  template <typename Value>
  void fill(TileField<dim, Value>& field) const;

  /// Collective, the adjoint of `fill`: adds the halo cells' values to their owners' and sets them
  /// to zero, so that nothing is added twice.
  template <typename Value, typename = std::enable_if_t<!std::is_pointer_v<Value>>>
  void sum_to_owner(std::vector<Value>& field) const {
    sum_to_owner(std::vector<std::vector<Value>*>{&field});
  }
  void sum_to_owner(FaceField<dim>& field) const;
  template <typename Value>
  void sum_to_owner(const std::vector<std::vector<Value>*>& fields) const;

  int width() const { return width_; }
  int n_halo_cells() const { return static_cast<int>(ghost_cells_.size()); }
  /// Counted since construction, on this rank.
  const HaloStatistics& statistics() const { return statistics_; }

 private:
  /// A rank to exchange with and its ranges in the two lists of cells.
  struct Neighbor {
    int rank = 0;
    int ghost_begin = 0, ghost_end = 0;
    int source_begin = 0, source_end = 0;
  };

  void agree_on_sources(const TiledGrid<dim>& grid);
  /// Sends `outgoing` (`bytes_per_cell` for each cell of one list) and receives `incoming` of the
  /// other.
  void transfer(const std::vector<char>& outgoing, std::vector<char>& incoming, bool to_owner,
                std::size_t bytes_per_cell) const;

  Communicator comm_;
  int width_ = 0;
  int n_stored_cells_ = 0;
  std::vector<Neighbor> neighbors_;
  std::vector<int> ghost_cells_;   ///< halo cells, grouped by owner
  std::vector<int> source_cells_;  ///< owned cells that others hold, grouped by holder
  mutable std::vector<char> outgoing_, incoming_;
  mutable HaloStatistics statistics_;
};

}  // namespace lockstep
