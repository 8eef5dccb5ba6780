#pragma once
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Turns a scene as written (read with FormulaPolicy::kept, after `include_scenes`) into one of
/// plain parameters: takes the `--set` assignments that concern "Constants", "Defaults" and
/// "Copies" out of `settings`, gives solids their defaults, makes their copies, and puts numbers in
/// the place of all formulas. The lists "Constants", "Defaults" and "Copies" are gone then.
/// `solid_types`: all that a solid's "Type" may be. Throws InputError. Local.
void expand_scene(Document& document, std::vector<std::string>& settings,
                  const std::vector<TypedSchema>& solid_types);

/// Returns the dimension, 2 or 3. Throws InputError if the scene says neither.
int scene_dimension(const Document& document);

/// Adds to the schema of a scene, for the reference only, what `expand_scene` takes away.
void declare_scene_language(ParameterList& scene, int dimension);

/// Returns the schema of a scene as it is written from that of one of plain parameters: with
/// "Include" and "Constants", with "Defaults" for solids of each type and "Copies" in every solid,
/// which may override what the solid says.
ParameterList written_scene(ParameterList scene, int dimension);

}  // namespace lockstep
