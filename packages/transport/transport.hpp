#pragma once
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "geometry/moving_surface.hpp"
#include "transport/grid_state.hpp"
#include "transport/nearby_surface.hpp"
#include "transport/ray_halo.hpp"

namespace lockstep {

template <int dim>
struct TransportFrame;

enum class AdvectionScheme {
  semi_lagrangian,  ///< first order in time, unconditionally stable
  maccormack,       ///< second order (Selle et al. 2008), clamped; semi-Lagrangian near surfaces
  cubic             ///< semi-Lagrangian with cubics, third order in space; with lines near surfaces
};

/// Boundary condition for rays that leave the domain through a side. Where nothing flows in, the
/// ray slides along the side: walls let nothing pass, open sides have zero gradient.
template <int dim>
struct TransportSide {
  bool inflow = false;
  bool closed = false;  ///< no velocity through it
  std::function<Point<dim>(const Point<dim>&)>
      velocity;  ///< velocity of the inflow, at a point of the side
};

/// A scalar on each side of the domain, at a point of it: [axis][0 lower, 1 upper].
template <int dim>
using SideValues = std::array<std::array<std::function<double(const Point<dim>&)>, 2>, dim>;

/// Input of transport at t^n. The referenced objects must outlive the Transport.
template <int dim>
struct TransportSetting {
  const TiledGrid<dim>& grid;
  const GridState<dim>& state;               ///< geometry at t^n
  const MovingSurface<dim>& surface;         ///< null or empty snapshots: no solids
  const FaceField<dim>& advection_velocity;  ///< u_ADV on all faces that are not inactive [m/s]
  RayHalo<dim>& halo;                        ///< ray halo of `grid`
  KeptSurface<dim>& kept;                    ///< for calls on `grid` alone
  std::array<std::array<TransportSide<dim>, 2>, dim> sides;  ///< [axis][0 lower, 1 upper]
  double dt = 0;                                             ///< [s]
  double kinematic_viscosity = 0;                            ///< [m^2/s]
  int stencil_reach = 1;  ///< reach of the stencils: 2 for cubics
};

/// Samples without a meaningful value after transport, by cell id (1: invalid): inactive or inside
/// a solid at t^n, on a surface, or passed by one. `populate_uncovered_*` populates those that hold
/// fluid at t^{n+1}. Owned samples only; ghost entries are 0. Empty vectors: all are valid.
template <int dim>
struct InvalidSamples {
  std::array<std::vector<char>, dim> faces;
  std::vector<char> cells;
};

/// Advects fields over one step along u_ADV (F3), without anything passing through a surface: a ray
/// from a sample back to where its fluid came from stops at the first surface it meets, and the
/// value there is interpolated from samples that are visible from that point. A hidden sample of a
/// velocity takes its normal part from the surface that hides it, and its tangential part from the
/// visible samples, less friction.
///
/// Constant fields stay exactly constant. A scalar never leaves the range of the field and the
/// inflow values, a velocity grows no longer than the fastest of field, surfaces and inflows. In
/// tiles that do not exist fluid is at rest. Results do not depend on the number of ranks.
template <int dim>
class Transport {
 public:
  /// Brings u_ADV and the sample states within reach of the rays and finds the tiles near surfaces.
  /// Throws SolveError if u_ADV is not finite or advects over more than a million cells.
  /// Collective.
  explicit Transport(const TransportSetting<dim>& setting);
  ~Transport();

  /// Advects the velocity: `result` = u advected over dt. Prescribed and inactive faces keep their
  /// u. Ghost values of u are not used, those of `result` not set. `result` may not be `u`.
  /// Collective.
  void advect_faces(AdvectionScheme scheme, const FaceField<dim>& u, FaceField<dim>& result);
  /// Advects a cell-centred scalar, given its value on inflow sides and, `beyond`, in tiles that do
  /// not exist. Cells without fluid keep their s. `tiles`: a flag for each owned tile, 0 where
  /// `result` stays as it is (not with maccormack); null: all are advected. Collective.
  void advect_scalar(AdvectionScheme scheme, const CellField& s,
                     const SideValues<dim>& inflow_values, CellField& result,
                     const std::vector<char>* tiles = nullptr, double beyond = 0);

  /// Advects the signed distance to a free surface [m], semi-Lagrangian, cut off at `cut_off`, on
  /// all tiles with a flag. Beyond inflow sides is no liquid. Collective.
  void advect_distance(const CellField& distance, double cut_off, const std::vector<char>& tiles,
                       CellField& result);

  /// Samples to which the calls so far could not give a value: faces after `advect_faces`, cells
  /// after `advect_scalar` (the same for every scalar).
  const InvalidSamples<dim>& invalid() const;
  /// The largest displacement along an axis over all ranks, in cells.
  double largest_displacement() const;
  /// Returns the frame, for callers that advect something else along the same rays.
  TransportFrame<dim>& frame();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace lockstep
