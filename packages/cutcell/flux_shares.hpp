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
/// cut cells").
template <int dim>
struct FluxShare {
  double weight = 0;
  SurfacePoint<dim> point;  ///< names the solid, and carries the weights of its vertices
  int solid = -1;
  Point<dim> center = Point<dim>::Zero();  ///< [m]
};

/// Measure of a face's closed part.
enum class FaceWeights {
  areas,   ///< its own area inside the solids (Ng, Min and Gibou 2009)
  volumes  ///< the volume of its dual cell inside them (Batty et al. 2007)
};

/// The flat box of a face [m].
template <int dim>
Box<dim> face_of(const ControlVolume<dim>& volume);

/// Returns the solids of which a thin part lies between the two pressure points, in ascending
/// order: shells, and closed solids that the segment enters and leaves again, unless both points
/// see the same open place of the face (a tip). No face fraction sees those: they would leak. Faces
/// that they block are mixed faces.
template <int dim>
std::vector<int> thin_between(const ControlVolume<dim>& volume,
                              const SurfaceSnapshot<dim>& surface);

/// Open part of a face: one minus the parts inside closed solids, rounded to a millionth, and
/// closed altogether below `smallest`. A thin part between the pressure points
/// closes it as well. Local.
template <int dim>
double open_fraction_of(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                        double smallest, FaceWeights weights = FaceWeights::areas);

/// Centroid of the open part of a partly open face: both together balance about the centre of the
/// face, whatever was rounded.
template <int dim>
Point<dim> open_center_of(const ControlVolume<dim>& volume,
                          const std::vector<FluxShare<dim>>& shares);

/// Shares of solids in one face with open_fraction < 1.
template <int dim>
struct FaceShares {
  std::vector<FluxShare<dim>> all;  ///< shares of the closed part; weights sum to one
  /// Shares of thin parts between the pressure points, as in the mixed-face coupling.
  std::vector<SurfaceShare<dim>> of_thin;
  double thin_part =
      0;  ///< part of the face whose fluid moves with the thin parts and is lumped on them [1]
};
template <int dim>
FaceShares<dim> face_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                            FaceWeights weights = FaceWeights::areas);

}  // namespace lockstep
