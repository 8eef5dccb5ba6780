#pragma once
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The list as XML that `read_parameters` reads back to the same values, doubles bit for bit;
/// docstrings included. Throws OutputError for a value that XML cannot hold.
std::string to_xml(const ParameterList& list);

/// One line for every parameter of a validated list that was chosen by the user:
/// `Fluid/Density = 998 (default 1000)`; without the bracket where there is no default.
std::vector<std::string> differences_from_default(const ParameterList& list,
                                                  const ParameterList& valid);

}  // namespace lockstep
