#pragma once
#include <vector>

#include "studies/study.hpp"

namespace lockstep {

/// One series for every choice of one option per factor, the last factor varying fastest: its name
/// is "option, option", its assignments and constants are those of the options in turn, its scene
/// and ladder those of the last option that has its own. `plain` is what an option without them
/// has. Empty without factors.
std::vector<Series> series_product(const std::vector<std::vector<Series>>& factors,
                                   const Series& plain);

}  // namespace lockstep
