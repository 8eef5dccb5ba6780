#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Residuals of Eq. 16, and what they are measured against: per block the largest norm of the
/// right-hand side and of the terms of its rows, and no less than what round-off makes of fluxes or
/// elastic forces that cancel.
struct BlockResidual {
  BlockVector vector;              ///< (rhs_1 - A p̂ + B V_S, -solid rhs + B^T p̂ + C V_S)
  double pressure = 0, solid = 0;  ///< 2-norms
  double pressure_scale = 0, solid_scale = 0;  ///< same units

  /// 0 where everything vanishes; NaN if the residual is.
  double relative_pressure() const { return pressure == 0 ? 0 : pressure / pressure_scale; }
  double relative_solid() const { return solid == 0 ? 0 : solid / solid_scale; }
  double norm() const { return pressure + solid; }
};

/// Row 2 alone.
struct SolidResidual {
  RCP<Vector> vector;  ///< -solid rhs + B^T p̂ + C V_S
  double scale = 0;    ///< as in BlockResidual
};

/// Residual of row 2 in a system with solid. Collective.
SolidResidual solid_row_residual(const BlockSystem& system, const BlockVector& rhs,
                                 const BlockVector& solution);
/// Collective.
BlockResidual block_residual(const BlockSystem& system, const BlockVector& rhs,
                             const BlockVector& solution);
/// Computes the residual in the vectors of an earlier residual of a system with the same maps, if
/// it has any.
void find_block_residual(const BlockSystem& system, const BlockVector& rhs,
                         const BlockVector& solution, BlockResidual& result);

/// " (name norm, name norm)", of the blocks of a group in a vector, over `scale`; empty for a group
/// of fewer than two. Collective.
std::string by_name(const BlockGroup& group, const Vector& vector, double scale);

}  // namespace lockstep
