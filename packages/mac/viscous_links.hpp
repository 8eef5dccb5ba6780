#pragma once
#include "mac/mac_geometry.hpp"

namespace lockstep {

struct ViscosityParameters {
  double viscosity = 0;                 ///< dynamic, mu [Pa s]
  double smallest_link_fraction = 0.2;  ///< of h: a link to a surface is never taken shorter
};

/// A side of the domain pulls on a free velocity.
struct SideLink {
  int row = 0;             ///< local
  int axis = 0, end = 0;   ///< the side
  double coefficient = 0;  ///< [kg/s]
};

/// Everything that free velocities are viscously tied to.
template <int dim>
struct ViscousLinks {
  RCP<const Map> map;
  std::vector<FaceId> faces;  ///< of the local rows
  RCP<const CrsMatrix> stiffness;
  RCP<Vector> mass;
  std::vector<ViscousLink<dim>> links;
  std::vector<SideLink> sides;
};

/// Collective.
template <int dim>
ViscousLinks<dim> find_viscous_links(const MacDomain<dim>& domain,
                                     const MacGeometry<dim>& geometry, double density,
                                     const ViscosityParameters& parameters);

/// Coefficient of the link between a free face and the next one along `across`, or 0 if that is not a
/// free one in sight [kg/s].
template <int dim>
double joined_coefficient(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                          const FaceId& face, int across, int end, double viscosity);

}  // namespace lockstep
