#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "grid/halo_exchange.hpp"
#include "grid/wide_halo.hpp"

namespace lockstep {

/// Brings the samples that rays of many cells' length reach onto the rank that traces them: through
/// the ghost tiles of the grid if they suffice, else through a wider grid, built when first needed.
/// Keep one as long as the grid has the same tiles; it must not outlive the grid.
template <int dim>
class RayHalo {
 public:
  explicit RayHalo(const TiledGrid<dim>& grid) : grid_(grid) {}

  /// Makes `fetch` serve samples within `reach` cells of owned ones from now on; the same `reach`
  /// on all ranks. May replace `sample_grid()`. Collective.
  void require(int reach);
  /// The grid whose cell ids fetched fields have. Ids of owned cells are those of the base grid.
  const TiledGrid<dim>& sample_grid() const { return wide_ ? *wide_ : grid_; }
  /// Returns the field with all samples within reach; ghost values of `field` are not used.
  /// Collective. Where tiles do not exist it has one more behind the others, all of whose samples
  /// are `beyond`, the value there (SampleLattice). Returns `field` itself where nothing has to be
  /// brought, else `storage`.
  template <typename Value>
  const std::vector<Value>& fetch(const std::vector<Value>& field, std::vector<Value>& storage,
                                  Value beyond) const;
  /// Forgets the tiles, after those of the grid have changed.
  void forget();

 private:
  const TiledGrid<dim>& grid_;
  std::optional<HaloExchange<dim>> exchange_;  ///< on the base grid
  int wide_tiles_ = 0;
  std::unique_ptr<TiledGrid<dim>> wide_;
  std::unique_ptr<WideHalo<dim>> wide_halo_;
};

}  // namespace lockstep
