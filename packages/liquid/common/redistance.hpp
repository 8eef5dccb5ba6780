#pragma once
#include <vector>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Treatment of phi beside the surface.
enum class NearCells {
  scale,  ///< it becomes a distance, as the slope there has it
  keep    ///< it is one already
};

/// Redistances phi without moving its zero: cells with a visible neighbour of the other sign become
/// |phi| / |grad phi| (after Russo & Smereka 2000), the others follow in the order of their
/// distance (fast marching, first order), across ranks until nothing changes. No value crosses a
/// surface of solids.
///
/// Changes the fluid cells of the flagged owned tiles, which hold all |phi| < cut_off there can be;
/// the farther ones become +-cut_off [m]. Sets the halo of width 1, which must be set before.
/// Collective.
template <int dim>
void redistance(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                const std::vector<char>& tiles, double cut_off, CellField& phi,
                NearCells near_cells = NearCells::scale);

}  // namespace lockstep
