#pragma once
#include <vector>

#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// A facet of a simplex: an edge in 3D (its vertices in ascending order), a vertex in 2D (twice).
struct Facet {
  int first = 0, second = 0;
  /// Direction of traversal, +1 or -1: two neighbours of like orientation have opposite ones.
  int direction = 0;
  int simplex = 0;
};

/// The facets of all simplices, those of one place together.
template <int dim>
std::vector<Facet> sorted_facets(const SurfaceMesh<dim>& mesh);

/// Calls f(first, number) for each run of facets at one place.
template <typename Function>
void for_each_place(const std::vector<Facet>& facets, const Function& f) {
  for (std::size_t i = 0, n = 0; i < facets.size(); i += n) {
    for (n = 1; i + n < facets.size() && facets[i + n].first == facets[i].first &&
                facets[i + n].second == facets[i].second;)
      ++n;
    f(static_cast<int>(i), static_cast<int>(n));
  }
}

/// Simplices joined by facets of exactly two of them.
template <int dim>
struct SurfacePart {
  std::vector<int> simplices;
  bool closed = false;  ///< all its facets join two simplices
  double volume = 0;    ///< volume of a closed part, negative if it faces inwards [m^dim]
  int depth = 0;        ///< number of other closed parts that enclose a closed one
  /// A part inside an odd number of others bounds a hole, and faces into it.
  bool faces_right() const { return (depth % 2 == 0) == (volume > 0); }
};
/// `volume` and `depth` mean something where neighbours agree in orientation.
template <int dim>
std::vector<SurfacePart<dim>> surface_parts(const SurfaceMesh<dim>& mesh);

/// Turns simplices so that neighbours agree, where that is possible, each part like its first
/// simplex; then closed parts so that they face out of the solid.
template <int dim>
void orient_surface(SurfaceMesh<dim>& mesh);

}  // namespace lockstep
