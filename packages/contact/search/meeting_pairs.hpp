#pragma once
#include <array>
#include <functional>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Pairs i < j of boxes that meet, of those that are wanted, in ascending order; empty boxes meet
/// nothing. By a sweep along axis 0. Local.
template <int dim>
std::vector<std::array<int, 2>> meeting_pairs(const std::vector<Box<dim>>& boxes,
                                              const std::function<bool(int, int)>& is_wanted);

}  // namespace lockstep
