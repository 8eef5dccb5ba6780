#pragma once
#include <vector>

#include "cutcell/flux_shares.hpp"
#include "faces/face_coupling.hpp"

namespace lockstep {

/// The flow of a place on the surface of a soft body into one pressure: its velocity times `area`.
template <int dim>
struct SurfaceFlow {
  SurfacePoint<dim> point;
  Point<dim> area = Point<dim>::Zero();  ///< [m^(dim-1)], out of the body
  PressureSide<dim> pressure;
};

/// The flows of all soft bodies, in the order of cells. In a cell they are the pieces of surface
/// there: a piece of a simplex pushes at its centroid, which is exact, as velocities are linear on
/// it. A simplex in the plane between two cells counts in the one that it faces.
///
/// The sum of the areas of a body in a cell must be what it closes of the faces of the cell, or
/// momentum is lost: by what open fractions are rounded, by faces closed altogether, where bodies
/// overlap. So the pieces share, by size, what is missing; where there are none, as beside contact
/// patches, the face's shares push. `shares` are those of the fluid's coupled volumes. Local: the
/// flows of all ranks together are those of the cells.
template <int dim>
std::vector<SurfaceFlow<dim>> surface_flows(const FluidDiscretization<dim>& fluid,
                                            const SurfaceSnapshot<dim>& surface,
                                            const std::vector<FaceShares<dim>>& shares);

}  // namespace lockstep
