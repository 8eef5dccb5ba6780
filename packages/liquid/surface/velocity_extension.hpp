#pragma once
#include <functional>
#include <vector>

#include "staggered/state/mac_geometry.hpp"
#include "transport/nearby_surface.hpp"

namespace lockstep {

/// Band over which velocities are extended, and the distance that orders the faces within it.
struct ExtensionRange {
  const CellField& distance;  ///< distance of cells' centres from the liquid, negative inside [m]
  double known = 0;           ///< value at which `distance` is cut off [m]
  double band = 0;            ///< distance up to which velocities are extended [m]
};

/// Extends velocities into the air above a free surface, over the faces of a narrow band, so that
/// the surface and the fluid behind it can move up there. A face takes the mean of its neighbours
/// along the axes that are nearer to the fluid than itself and that it sees, weighted with how much
/// nearer they are: the velocity is extended along the normal of the surface. It is never extended
/// through a surface of a solid, nor into a solid. Beside the fluid the extension is linear, in so
/// far as the velocity's slope is steady over three faces (minmod): else the surface of a wave of
/// number k would lag by kh/4. Faces that a solid or a closed side shuts move as these do.
///
/// Since only nearer neighbours count, the values depend neither on an order nor on the ranks.
template <int dim>
class VelocityExtension {
 public:
  /// Finds the faces and marks them `extended` in `state`: those without fluid on either side and
  /// with an air cell that has a distance below the band on one. Where the distance is cut off it
  /// goes on from cell to cell, by no more than it may grow. `near` as in MacGeometry, the surface
  /// at the same instant. The domain, `near` and the surface must outlive this object. Collective.
  VelocityExtension(const MacDomain<dim>& domain, const ExtensionRange& range,
                    const std::vector<char>& near, const NearbySurface<dim>& surface,
                    GridState<dim>& state);

  /// Sets the velocity of those faces, ghosts included. `on_surface`: of a surface point; `time`:
  /// of the sides. Collective.
  void extend(double time, const std::function<Point<dim>(const SurfacePoint<dim>&)>& on_surface,
              FaceField<dim>& velocity) const;

 private:
  struct Source {
    int face = -1;
    int side = -1;  ///< side of the source on which the fluid's own next two are, if they are known
    double weight = 0;  ///< difference of distances to the fluid [cells], or `least_weight`
  };
  struct Face {
    int cell = 0;
    int first_source = 0, n_sources = 0;  ///< none: shut, or alone
  };
  struct Faces {
    std::vector<Face> all;  ///< owned, each behind its sources on this rank
    std::vector<Source> sources;
  };
  /// The distance where it is cut off at `known`.
  void go_on(double known, double band, const GridState<dim>& state);
  bool is_hidden(int cell, int axis, int side) const;
  void find_faces(double band, GridState<dim>& state);
  void sort_faces(int axis, const GridState<dim>& state);
  void find_sources(int axis, const GridState<dim>& state);
  /// `rank`: of owned faces that are extended.
  void find_sources_of(Face& face, int axis, const CellField& rank, const GridState<dim>& state);
  /// True if the fluid goes on steadily beyond a source.
  bool goes_on(int axis, int source, int side, const GridState<dim>& state) const;
  /// Smallest where fluid is nearest, a whole number.
  double rank_of_face(int axis, int cell, const GridState<dim>& state) const;
  bool is_shut(int axis, int cell, const FaceCells& cells, const GridState<dim>& state) const;
  double mean_of_sources(int axis, const Face& face, const CellField& velocity) const;
  template <typename Set>
  void extend_across_ranks(int axis, const Set& set, CellField& velocity) const;
  /// Extrapolated velocity of a face beyond a source [m/s].
  double carried_on(const Source& source, const CellField& velocity) const;
  /// Velocity of a face that no fluid reaches [m/s].
  double given(int axis, int cell, double time,
               const std::function<Point<dim>(const SurfacePoint<dim>&)>& on_surface) const;

  const MacDomain<dim>& domain_;
  CellField distance_;
  const std::vector<char>& near_;
  const NearbySurface<dim>& surface_;
  std::array<Faces, dim> faces_;
  std::array<std::vector<char>, dim>
      known_;  ///< faces of the fluid's own velocity, also on other ranks
};

}  // namespace lockstep
