#pragma once
#include <array>
#include <vector>

#include "geometry/mesh_names.hpp"

namespace lockstep {

/// Simplices of one kind in a mesh file: with dim corners a surface, with one more a volume.
template <int dim, int n_corners>
struct Simplices {
  std::vector<Point<dim>> vertices;
  std::vector<std::array<int, n_corners>> simplices;
  MeshNames names;
};

/// "segments", "triangles" or "tetrahedra".
constexpr const char* simplex_name(int n_corners) {
  return n_corners == 2 ? "segments" : n_corners == 3 ? "triangles" : "tetrahedra";
}

}  // namespace lockstep
