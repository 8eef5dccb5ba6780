#pragma once
#include <string>

namespace lockstep {

/// Fate of a parameter or a column that is no more, as the end of a sentence that begins with its
/// name: "is called \"Thickness\" now". `path` is the list that the parameter was found in, of a
/// column "history.csv". Empty for a name that never was one there. All such names stand in this
/// room, whatever plug-in had them, so that an old file is refused by one sentence.
std::string fate_of(const std::string& path, const std::string& name);

}  // namespace lockstep
