#pragma once
#include <array>

#include "base/types.hpp"

namespace lockstep {

/// The part of a box in which phi < 0, if phi is linear on the d! simplices along its diagonal,
/// each a path of edges from the lowest corner to the highest. Bit a of a corner's number: upper
/// along axis a. Exact up to round-off and continuous in phi.
template <int dim>
double wet_fraction(const std::array<double, 1 << dim>& phi);

}  // namespace lockstep
