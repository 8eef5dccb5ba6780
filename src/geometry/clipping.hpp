#pragma once
#include <array>

#include "base/types.hpp"

namespace lockstep {

/// The part of a simplex inside a box.
template <int dim>
struct ClippedSimplex {
  double measure = 0;  ///< length (2D) or area (3D) of the part inside [m, m^2]
  Barycentric<dim> barycentric = Barycentric<dim>::Zero();  ///< centroid of the part; zero if empty
  Point<dim> centroid = Point<dim>::Zero();
};

/// Exact Sutherland-Hodgman clipping of a segment or triangle to an axis-parallel box. The box is
/// closed: a simplex that lies in a side shared by two boxes is counted by both. Degenerate
/// simplices have measure zero.
template <int dim>
ClippedSimplex<dim> clip_to_box(const std::array<Point<dim>, dim>& corners, const Box<dim>& box);

}  // namespace lockstep
