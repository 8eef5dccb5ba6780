#pragma once
#include <limits>

/// Bounds of round-off: distance of a number from that of exact arithmetic, over the scale of the
/// terms that it is made of. A double carries `epsilon` = 2.2e-16; n operations on terms of one
/// size are off by some sqrt(n) to n epsilon. Tolerances of round-off are one of these three times
/// a scale; a number that is a choice (how much is worth another iteration, say) is none of them
/// and stands where it is made, with its reason.
namespace lockstep::rounding {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A few operations on terms of one size: a polynomial's value, a step of Newton's method that has
/// converged. 1.4e-14.
inline constexpr double few = 64 * epsilon;
/// Sums over a mesh, eigenvalues, determinants of coordinates, products of small matrices. 9.1e-13.
inline constexpr double sums = 4096 * epsilon;
/// Bound of values to which cancellation or many steps cost half of the digits: directions made of
/// small differences, places and distances that two ways of reckoning should make the
/// same. 9.3e-10.
inline constexpr double differences = 4194304 * epsilon;

}  // namespace lockstep::rounding
