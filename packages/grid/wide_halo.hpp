#pragma once
#include "grid/halo_exchange.hpp"

namespace lockstep {

/// Brings fields of a grid onto `grid.with_reach(n)`, with all ghost cells the wide grid has: what
/// a backtraced ray of many cells' length needs.
template <int dim>
class WideHalo {
 public:
  /// Collective. `wide` must come from `with_reach` of `base` or of a grid with the same owned
  /// tiles.
  WideHalo(const TiledGrid<dim>& base, const TiledGrid<dim>& wide);
  /// Collective: `wide_field` gets the size of the wide grid, the owned values and all ghost
  /// values; ghost values of `base_field` are not used. Values are double, int, char or
  /// GlobalIndex.
  template <typename Value>
  void fill(const std::vector<Value>& base_field, std::vector<Value>& wide_field) const;
  void fill(const FaceField<dim>& base_field, FaceField<dim>& wide_field) const;

  const HaloExchange<dim>& exchange() const { return exchange_; }

 private:
  int n_owned_cells_ = 0;
  int n_stored_cells_ = 0;  ///< stored cells of the wide grid
  HaloExchange<dim> exchange_;
};

}  // namespace lockstep
