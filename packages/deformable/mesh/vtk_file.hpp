#pragma once
#include <string>

#include "deformable/mesh/simplices.hpp"

namespace lockstep {

/// The simplices with so many corners of a legacy VTK file: ASCII, an unstructured grid, version 1
/// to 5. Other simplices in it are skipped, vertices that none uses are dropped; data
/// are not read. Throws InputError naming file and line for anything else. Every rank reads.
template <int dim, int n_corners>
Simplices<dim, n_corners> read_vtk(const std::string& file);

}  // namespace lockstep
