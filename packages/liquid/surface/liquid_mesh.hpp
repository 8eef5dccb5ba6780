#pragma once
#include "geometry/surface_mesh.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// The surface of the liquid, normals out of it: the part of this rank, closed with those of the
/// others. A vertex in each dual cube that the surface passes, at the mean of where its edges do
/// (surface nets); a segment or two triangles across each link between a wet cell and a dry one.
/// The surface continues into solids, so that no gap is seen beside them, and runs along the sides
/// of the domain that the liquid touches. `distance` is phi on all stored cells. Local.
template <int dim>
SurfaceMesh<dim> liquid_mesh(const MacDomain<dim>& domain, const CellField& distance);

}  // namespace lockstep
