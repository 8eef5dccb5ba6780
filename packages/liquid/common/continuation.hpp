#pragma once
#include <memory>
#include <vector>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Cells into solids over which phi is continued.
inline constexpr int depth_in_solids = 4;

/// A cell of a layer in a solid.
struct LayerCell {
  int cell;
  unsigned char from;  ///< bit 2 axis + side: there is a neighbour of an earlier layer
};

/// Extrapolates phi linearly into solids over some cells: layer by layer, a cell takes the mean of
/// the extrapolations from those of its neighbours along the axes, seen from the fluid, that are
/// nearest to the interface. Farther ones, deep under an overhang, say how far the interface is in
/// sight, not how far its plane is. A cell in a solid thinner than it takes only those of the side
/// whose fluid reaches into it.
template <int dim>
class Continuation {
 public:
  explicit Continuation(int n_layers) : n_layers_(n_layers) {}

  /// |phi| <= cut_off [m]. All stored cells are set on return, and must be before. Layers are found
  /// once for all calls with the same surface of solids. Collective.
  void into_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids, double cut_off,
                   CellField& phi);

  /// Forgets the layers when tiles have come or gone.
  void forget_layers() { surface_ = nullptr; }

 private:
  void find_layers(const MacDomain<dim>& domain, const SolidCells<dim>& solids);
  /// `direction`: 2 axis + side.
  double led_to(const TiledGrid<dim>& grid, const SolidCells<dim>& solids, const CellField& phi,
                int other, int direction, int layer) const;

  int n_layers_;
  std::shared_ptr<const SurfaceSnapshot<dim>> surface_;  ///< whose layers these are
  std::vector<std::vector<LayerCell>> layers_;           ///< owned cells
  std::vector<char> layer_of_;  ///< layer of stored cells: 0 in the fluid, 1 in the first layer
};

}  // namespace lockstep
