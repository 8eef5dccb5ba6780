#pragma once
#include <vector>

#include "parameters/parameter_list.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Gives every solid what the list "Defaults" says and the solid itself does not, then removes
/// that list. A list in it that bears the name of one of the `types` ("rigid body") holds for
/// solids of that type only, of which there may be none, and goes before the rest. A sublist whose
/// "Type" or "Shape" is another one than the solid's does not apply. Throws InputError.
void apply_defaults(Document& document, const std::vector<TypedSchema>& types);

}  // namespace lockstep
