#pragma once
#include <memory>
#include <vector>

#include "interfaces/fluid.hpp"
#include "mac/domain/mac_domain.hpp"

namespace lockstep {

/// The frozen geometry of one instant with the numbering of the pressures.
template <int dim>
struct MacGeometry {
  MacState<dim> state;
  RCP<const Map> pressure_map;
  /// Pressure unknown of each owned cell and its neighbours, or no_index.
  std::vector<GlobalIndex> unknown;
  /// Open fractions of free and prescribed faces; empty unless some face is partly open.
  std::array<CellField, dim> partial;
  /// Cells so near to a surface that a link from their faces may meet it; empty without surface.
  std::vector<char> near;
  /// Owned faces with open fraction < 1 and fluid on at least one side, and their control volumes;
  /// behind them volumes at prescribed sides (add_covered_sides).
  std::vector<FaceId> coupled;
  std::vector<ControlVolume<dim>> volumes;
  std::vector<FaceId> prescribed;  ///< owned faces of walls and inflows
  std::vector<FaceId> open_sides;  ///< owned free faces of open sides

  /// The part of a face through which free fluid flows.
  double open_fraction(int axis, int cell) const {
    if (state.faces[axis][cell] != FaceState::free)
      return 0;
    return partial[axis].empty() ? 1 : partial[axis][cell];
  }
  /// The part of the face of an inflow that no solid covers.
  double open_part_of_prescribed(int axis, int cell) const {
    return partial[axis].empty() ? 1 : partial[axis][cell];
  }
  void set_partial(int axis, int cell, double fraction) {
    if (partial[axis].empty())
      partial[axis].assign(state.cells.size(), 1.0);
    partial[axis][cell] = fraction;
  }
  bool near_surface(int cell) const { return !near.empty() && near[cell] != 0; }
};

/// Judges cells by their centres, asks `rule` about faces near the surface, numbers the pressures.
/// `surface` may be null or empty. Collective.
template <int dim>
MacGeometry<dim> make_geometry(const MacDomain<dim>& domain, double density,
                               const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                               const OpenFractionRule<dim>& rule);

/// The control volume of a face that is not prescribed; its cells must be stored. `open_fraction`
/// and `seen_by_fluid` are left at 1 and true.
template <int dim>
ControlVolume<dim> control_volume(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                  double density, int axis, int cell);

}  // namespace lockstep
