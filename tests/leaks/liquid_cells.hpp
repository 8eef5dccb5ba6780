#pragma once
#include "liquid/fractions/volume_of_fluid.hpp"
#include "liquid/particles/level_set.hpp"

namespace lockstep::test {

/// Stored cells (1) with liquid, owned and of the halo of width 1.
struct LiquidCells {
  std::vector<char> seen;    ///< not solid; wet, or a drop that the grid does not show is in sight
  std::vector<char> hidden;  ///< owned: such a drop is in a gap that no centre of a cell sees
};

/// The liquid of an interface among solids. Collective.
template <int dim>
LiquidCells cells_with_liquid(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                              KeptSurface<dim>& kept, const LevelSet<dim>& interface);
template <int dim>
LiquidCells cells_with_liquid(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                              KeptSurface<dim>& kept, const VolumeOfFluid<dim>& interface);

}  // namespace lockstep::test
