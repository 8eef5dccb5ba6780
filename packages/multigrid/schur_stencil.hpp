#pragma once
#include <optional>
#include <vector>

#include "interfaces/strategy.hpp"
#include "linear/stencil_operator.hpp"

namespace lockstep {

/// A + B C^-1 B^T of a system with soft solids, as well as a stencil can have it, for
/// preconditioners. Two parts of B C^-1 B^T fit on a stencil:
///
/// - Sheets are faces that give way (through_sheets.hpp).
/// - Volumes, and whatever else has fluid on one side, yield to the pressure beside them. A cell
///   takes, as a reaction, what flows into it where the pressure is 1 everywhere: its entry of
///   B C^-1 B^T 1, the row lumped into the diagonal. That is right for an even pressure, whatever
///   the solid's elasticity and mass, and too much for an uneven one.
///
/// `solid_inverse` is C^-1, roughly; `empty_rows` are the local rows that A leaves empty, left
/// alone here. Nothing if there are no soft solids, or neither part amounts to anything.
/// Collective.
std::optional<FaceCoefficients> schur_stencil(const BlockSystem& system,
                                              const LinearOperator& solid_inverse,
                                              const std::vector<int>& empty_rows);

}  // namespace lockstep
