#pragma once
#include <functional>

#include "base/communicator.hpp"
#include "conformance/violations.hpp"
#include "interfaces/plug_in.hpp"

namespace lockstep {

/// Saves the plug-in in a checkpoint, calls `change`, and loads that checkpoint again. What `save`
/// or `load` throw is noted. The file lies in a new folder beside other temporary files, so all
/// ranks must see one disk; nothing is left of it. Collective.
void load_what_was_saved(PlugIn& plug_in, const Communicator& comm,
                         const std::function<void()>& change, Violations& found);

}  // namespace lockstep
