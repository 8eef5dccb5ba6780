#pragma once
#include "interfaces/plug_ins.hpp"

namespace lockstep {

/// All plug-ins that ship with Lockstep. A driver with its own adds them to what this returns.
PlugIns shipped_plug_ins();

}  // namespace lockstep
