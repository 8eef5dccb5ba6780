#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Removes from the folder of a run that begins anew the tables that an earlier one there has
/// written, by its used-parameters.xml, and that `scene` has not: joints.csv and those of
/// observers. Without that file, or if it cannot be read, nothing. Throws OutputError. Collective.
void remove_earlier_tables(const Communicator& comm, const std::string& directory,
                           const ParameterList& scene);

}  // namespace lockstep
