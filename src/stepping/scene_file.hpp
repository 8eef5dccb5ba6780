#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Makes a document that was read into a complete, validated scene: merges the solver file it names
/// (Solver/File, relative to the scene), applies the `--set` assignments, fills in defaults; a
/// Solver/Tolerance that is not given is that of the strategy. Throws InputError with all
/// mistakes of the scene. Collective.
void complete_scene(Document& document, const std::vector<std::string>& settings,
                    const ParameterList& valid, const Communicator& comm);

/// Runs the body of a driver; turns a Failure (or any exception) into one message from rank 0 and
/// an exit code. A failure of one rank alone ends all.
int run_and_report(const Communicator& comm, const std::function<int()>& body);

}  // namespace lockstep
