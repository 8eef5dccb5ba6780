#pragma once
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Crossings of a surface with itself.
template <int dim>
struct SelfCrossing {
  int n_pairs = 0;                        ///< pairs of simplices that cross
  int first = -1, second = -1;            ///< simplices of the first pair
  Point<dim> place = Point<dim>::Zero();  ///< where they cross [m]
};

/// Pairs of simplices of which one passes through the inside of the other. What only touches,
/// within 1e-12 of the size of the mesh, and what lies in one plane does not count.
template <int dim>
SelfCrossing<dim> find_self_crossing(const SurfaceMesh<dim>& mesh);

}  // namespace lockstep
