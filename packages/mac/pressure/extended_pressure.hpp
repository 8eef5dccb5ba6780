#pragma once
#include "mac/domain/mac_domain.hpp"

namespace lockstep {

/// A pressure of the last step on the cells that hold fluid now: those that had none take the mean
/// of their neighbours, front after front, on top of the pressure of a fluid at rest.
/// `before` tells which cells had one, `gradient` is that of the fluid at rest (rho g, times dt for
/// p̂). Ghost values count and are set. Collective.
template <int dim>
CellField extended_pressure(const MacDomain<dim>& domain, const std::vector<CellState>& now,
                            const std::vector<CellState>& before, CellField pressure,
                            const Point<dim>& gradient);

}  // namespace lockstep
