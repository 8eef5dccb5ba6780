#pragma once
#include <vector>

#include "staggered/state/mac_geometry.hpp"
#include "transport/transport.hpp"

namespace lockstep {

/// Mass that has carried the velocity of an owned face, over the volume of its dual cell [kg/m^3].
struct CarriedMass {
  int axis = 0, cell = 0;
  double density = 0;
  /// Mass that came from much denser faces, a part of it, and the velocity that it brought [m/s].
  double from_denser = 0, velocity_of_denser = 0;
};

/// Advects the velocity of two phases near their interface, with one flux for mass and momentum:
///   rho' = rho - dt div F,   u' = (rho u - dt div (F u)) / rho',   F = rho u_ADV,
/// so that a heavy fluid hands no velocity that it has not got to a light one beside it, and takes
/// none from there. rho is upwind, u of second order where it is monotone (minmod); in as many
/// parts of a step as keep each below half a cell. Faces beside surfaces of solids and at the sides
/// of the domain keep the velocities that rays bring (`correct_flooded`).
template <int dim>
class InterfaceTransport {
 public:
  /// Finds the faces near the interface at t^n, which has the geometry's densities: those that the
  /// fluid there reaches within the step, and two cells more. `distance`: phi [m]; `advection`:
  /// u_ADV; both with valid halos. The references must outlive this. Collective.
  InterfaceTransport(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                     const CellField& distance, const FaceField<dim>& advection, double dt);

  /// `result` := `velocity` advected over dt, on those faces alone; halos are not set. Returns rho'
  /// of each, and rho of the faces nearby that keep the velocities of rays. Collective.
  std::vector<CarriedMass> advect(const FaceField<dim>& velocity, FaceField<dim>& result) const;

 private:
  struct Face {
    int axis = 0, cell = 0;
    bool is_taken = false;  ///< else it is only a neighbour of those that are
  };
  struct Fields {
    FaceField<dim> density, velocity;
  };
  /// Mass and momentum that a step's part brings to the dual cell of a face, over its volume.
  struct Change {
    double mass = 0, momentum = 0;
    double mass_of_denser = 0, momentum_of_denser = 0;  ///< by inflow from much denser faces alone
  };

  void find_faces(const CellField& distance, double displacement);
  bool is_regular(int axis, int cell) const;
  bool has_velocity(int axis, int face) const {
    return face >= 0 && geometry_.state.faces[axis][face] != FaceState::inactive;
  }
  /// u_ADV through the face of a dual cell that looks towards an end of `across` [m/s].
  double speed_through(const Face& face, int across, int end) const;
  void add_flux(const Fields& fields, const Face& face, int across, int end, Change& change) const;

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  FaceField<dim> advection_;  ///< all ghosts set
  double dt_;
  int n_parts_ = 1;
  std::vector<Face> faces_;                 ///< owned
  std::vector<CarriedMass> beside_solids_;  ///< at t^n
};

/// Corrects the velocities of faces that are much denser with the interface of t^{n+1}, which
/// `geometry` has, than what carried them. A gas that blows over the liquid, or escapes from a film
/// between it and a body at many times the speed of both, would else hand its velocity to liquid at
/// a thousand times the mass. Such a face takes the velocity of the liquid that has come in; one
/// that none has come into becomes invalid.
template <int dim>
void correct_flooded(const MacGeometry<dim>& geometry, const std::vector<CarriedMass>& carried,
                     FaceField<dim>& velocity, InvalidSamples<dim>& invalid);

}  // namespace lockstep
