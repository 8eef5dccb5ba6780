#pragma once
#include <string>

#include "deformable/mesh/simplices.hpp"

namespace lockstep {

/// The simplices with so many corners of a Gmsh file, ASCII of version 2.2 or 4.1. Other simplices
/// in it are skipped, vertices that none uses are dropped. Throws InputError naming
/// file and line for anything else, elements of higher order included. Every rank reads.
template <int dim, int n_corners>
Simplices<dim, n_corners> read_gmsh(const std::string& file);

}  // namespace lockstep
