#pragma once

namespace lockstep {

/// Content of a cell, judged at its centre.
enum class CellState : char {
  outside,  ///< beyond the domain
  fluid,    ///< carries a pressure
  solid,    ///< centre inside a closed solid
  empty  ///< its pressure is known: air above a free surface, p = 0, or fluid at rest at the rim of
         ///< the stored tiles
};

}  // namespace lockstep
