#pragma once
#include <vector>

#include "cutcell/closed_parts.hpp"
#include "faces/surface_shares.hpp"
#include "interfaces/fluid.hpp"

namespace lockstep {

/// One solid's share of the closed part of a face; the shares of a face sum to one. A rigid body
/// moves its share with the velocity of its rigid motion at `center`, the centroid of its part of
/// the face: as a rigid motion is free of divergence, what flows through the closed faces of a cell
/// is then exactly what the surface inside the cell pushes out (docs/method.md, "The flux through
/// cut cells"). A soft body's share says how much it closes, and how fast the face moves; what it
/// pushes is that of its surface in the cells (cutcell/surface_flows.hpp).
template <int dim>
struct FluxShare {
  double weight = 0;
  SurfacePoint<dim> point;  ///< names the solid, and carries the weights of its vertices
  int solid = -1;
  Point<dim> center = Point<dim>::Zero();  ///< [m]
  bool at_surface = false;                 ///< the surface in the cells pushes, not the face
};

/// Measure of a face's closed part.
enum class FaceWeights {
  areas,   ///< its own area inside the solids (Ng, Min and Gibou 2009)
  volumes  ///< the volume of its dual cell inside them (Batty et al. 2007)
};

struct FluxOptions {
  /// Faces less open than this are closed: their flux then belongs to the solid in both
  /// neighbours, so that nothing is lost, and every pressure has a face of at least this size.
  double smallest_open_fraction = 1e-4;
  bool correct_buoyancy = true;  ///< see HydrostaticLoads
  FaceWeights weights = FaceWeights::areas;
};

/// The flat box of a face [m].
template <int dim>
Box<dim> face_of(const ControlVolume<dim>& volume);

/// Open part of a face: one minus the parts inside closed solids, rounded to a millionth, and
/// closed altogether below the smallest. A shell between the pressure points closes it as well, and
/// so does a wall that parts its cells (`parted`). By volumes a face is open beside thick solids
/// although its area is closed; walls thinner than two cells are not tight then. Local.
template <int dim>
double open_fraction_of(const ControlVolume<dim>& volume, bool parted,
                        const SurfaceSnapshot<dim>& surface, const FluxOptions& options);

/// Centroid of the open part of a partly open face: both together balance about the centre of the
/// face, whatever was rounded.
template <int dim>
Point<dim> open_center_of(const ControlVolume<dim>& volume,
                          const std::vector<FluxShare<dim>>& shares);

/// Shares of solids in one face with open_fraction < 1.
template <int dim>
struct FaceShares {
  std::vector<FluxShare<dim>> all;  ///< shares of the closed part; weights sum to one
  /// Shares in a face that is closed although its area is open: of the shells between the pressure
  /// points, or else of the solids in its dual cell, as in the mixed-face coupling.
  std::vector<SurfaceShare<dim>> of_thin;
  double thin_part = 0;  ///< open part of the area of such a face, whose fluid they carry [1]
};
/// A face beside a cell of a closed solid has that of all closed ones alone, so that rows of B sum
/// to zero.
template <int dim>
FaceShares<dim> face_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                            const FluxOptions& options);

}  // namespace lockstep
