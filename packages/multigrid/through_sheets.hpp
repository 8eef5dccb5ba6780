#pragma once
#include <optional>
#include <vector>

#include "interfaces/strategy.hpp"
#include "linear/stencil_operator.hpp"

namespace lockstep {

/// A with what the elimination of soft sheets adds to it: A + B C^-1 B^T as a stencil again, for
/// preconditioners.
///
/// To A alone a sheet is a wall; to A + B C^-1 B^T it is a face that gives way like any other, for
/// its mass is little more than that of the fluid lumped on it. A pressure jump s across the faces
/// of a node moves it by s sum_f b_f / m, and that moves fluid through each of them: the
/// coefficient b_f sum_g b_g / m. It leaves out the forces inside the sheet, and is therefore never
/// too small for an even jump.
///
/// Counts the nodes that are soft in one direction at least, and whose rows of B^T cancel along the
/// lattice, as those of sheets do: fluid on both sides, no periodic seam, and no cell of
/// `empty_rows`, the local rows that A leaves empty. Nothing if no face of any rank opens.
/// Collective.
std::optional<FaceCoefficients> conducting_through_sheets(const BlockSystem& system,
                                                          const std::vector<int>& empty_rows);

}  // namespace lockstep
