#pragma once
#include <functional>

#include "interfaces/plug_ins.hpp"

namespace lockstep {

/// The whole of the program `simulate`, its options included, with the plug-ins that
/// `make_plug_ins` returns and those of the libraries that `--plug-in` or a scene names. Starts and
/// ends MPI. Returns the exit code: 0 done, 2 bad input, 3 a solve failed, 4 input or output
/// failed, 128 + its number stopped by a signal after a step and its checkpoint.
int simulate_main(int argc, char** argv, const std::function<PlugIns()>& make_plug_ins);

}  // namespace lockstep
