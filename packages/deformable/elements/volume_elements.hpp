#pragma once
#include "deformable/elements/element_group.hpp"
#include "deformable/materials/material.hpp"
#include "deformable/mesh/volume_mesh.hpp"

namespace lockstep {

/// Linear in Green's strain rate: second Piola stress 2 shear E' + bulk tr(E') [Pa s]. Objective,
/// so that a rotating body is not slowed down, and well defined for inverted elements.
struct StrainRateDamping {
  double shear = 0, bulk = 0;
  bool active() const { return shear != 0 || bulk != 0; }
};

/// Linear finite elements (constant strain) of a volume mesh at rest.
template <int dim>
std::unique_ptr<ElementGroup<dim>> volume_elements(const VolumeMesh<dim>& rest,
                                                   std::shared_ptr<const Material<dim>> material,
                                                   const StrainRateDamping& damping);

/// The nearest symmetric positive semidefinite matrix: negative eigenvalues become zero. Returns
/// true if there were any (beyond round-off).
template <int n>
bool clamp_eigenvalues(Eigen::Matrix<double, n, n>& matrix);

}  // namespace lockstep
