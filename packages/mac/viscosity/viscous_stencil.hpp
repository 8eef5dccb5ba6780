#pragma once
#include "interfaces/viscosity.hpp"
#include "mac/viscosity/viscosity_field.hpp"

namespace lockstep {

struct ViscosityParameters {
  double viscosity = 0;  ///< dynamic, mu; the larger one of two phases [Pa s]
  double smallest_coupling_fraction =
      0.2;               ///< part of h [1]: a link to a surface is never taken shorter
  bool has_air = false;  ///< above a free surface: the form is that of the symmetric stress there
  PhaseViscosities phases = {};
};

/// Implicit surface tension: sigma dt times the surface Laplacian.
struct ImplicitTension {
  double strength = 0;                  ///< sigma dt [N s/m]; 0: none
  const CellField* distance = nullptr;  ///< phi on all stored cells [m]
};

/// A side of the domain pulls on a free velocity.
struct SideCoupling {
  int row = 0;             ///< local
  int axis = 0, end = 0;   ///< the side
  double coefficient = 0;  ///< [kg/s]
};

/// The end of a strip of coupled free velocities, where the couple of their links does not cancel.
/// The couple of a link between neighbours at distance h across their direction is h mu area / h
/// (u_upper - u_lower), so that of a whole strip is the difference of its ends.
struct CoupleEnd {
  int row = 0;             ///< local
  int across = 0;          ///< axis along which the velocities stand side by side
  double coefficient = 0;  ///< [kg/s], negative at the lower end
};

/// A free velocity pulls on another, or on itself: with -coefficient times itself.
struct CrossPull {
  int row = 0;  ///< local
  FaceId from;
  double coefficient = 0;  ///< [kg/s]
};

/// A prescribed velocity pulls likewise, in part from outside of the fluid.
struct InflowPull : CrossPull {
  double from_outside = 0;  ///< part of the coefficient [kg/s]
};

/// All viscous couplings of free velocities.
template <int dim>
struct ViscousStencil {
  RCP<const Map> map;
  std::vector<FaceId> faces;  ///< faces of the local rows
  RCP<const CrsMatrix> stiffness;
  RCP<Vector> mass;
  std::vector<ViscousCouplingTerm<dim>> links;
  std::vector<SideCoupling> sides;
  std::vector<CoupleEnd> couples;
  std::vector<CrossPull> cross_pulls;    ///< at right angles, of air and of sides
  std::vector<InflowPull> inflow_pulls;  ///< at right angles
  std::vector<CrossPull> tension_pulls;  ///< all that implicit surface tension does
  double viscosity = 0;                  ///< [Pa s]
};

/// Collective.
template <int dim>
ViscousStencil<dim> find_viscous_stencil(const MacDomain<dim>& domain,
                                         const MacGeometry<dim>& geometry,
                                         const ViscosityParameters& parameters,
                                         const ImplicitTension& tension = {});

}  // namespace lockstep
