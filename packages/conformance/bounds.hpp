#pragma once

namespace lockstep {

/// Round-off of sums over the small systems of the suites, relative to their terms [1].
inline constexpr double round_off = 1e-11;
inline constexpr double dt = 1e-2;  ///< [s], of impulses

}  // namespace lockstep
