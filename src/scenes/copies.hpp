#pragma once
#include "parameters/expression.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Declares the list "Copies" in the schema of a solid.
void declare_copies(ParameterList& solid, int dimension);

/// Replaces every solid that has a list "Copies" by its copies "NAME 1", "NAME 2", ... at the
/// places that the list gives, and evaluates all formulas of all solids: those of a copy know its
/// number as `copy`, beside `constants`. Throws InputError.
void make_copies(Document& document, int dimension, const Variables& constants);

}  // namespace lockstep
