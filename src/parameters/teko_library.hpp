#pragma once
#include <string>
#include <vector>

#include "parameters/source.hpp"

namespace lockstep {

/// The parameters that a Teko preconditioner factory reads, besides "Type". A name that ends in "
/// #" stands for the name followed by a block number: "Inverse Type 1".
struct TekoFactory {
  std::string type;
  std::vector<std::string> parameters;
};

/// Checks what Teko does not: it takes its defaults silently where a parameter of a factory is
/// misspelt, and says only "Error!" where a type is. `library` is the list "Inverse Factory
/// Library" at `path` of the document, `own` the factories the program has registered itself.
/// Parameters are checked for `own` and for block Jacobi, block Gauss-Seidel, SIMPLE, LSC and block
/// LU; other factories and the solvers of Stratimikos keep their parameters to themselves. Throws
/// InputError for an unknown type, an unknown parameter, and an "Inverse ... Type" that names
/// nothing.
void check_teko_library(const ParameterList& library, const Source& source, const std::string& path,
                        const std::vector<TekoFactory>& own = {});

}  // namespace lockstep
