#pragma once

namespace lockstep {

/// What sums over the small systems of the suites are off by, relative to their terms.
inline constexpr double round_off = 1e-11;
inline constexpr double dt = 1e-2;  ///< [s], of impulses

}  // namespace lockstep
