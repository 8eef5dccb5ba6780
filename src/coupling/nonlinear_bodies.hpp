#pragma once
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// The dofs of each solid that may have implicit forces: norms and scales of a nonlinear iteration
/// are taken solid by solid, so that no solid's convergence depends on the others. Solids are
/// numbered as in `SolidSystem::solids`; those of models without such forces have none of these
/// dofs. For the present dofs and masses.
template <int dim>
class NonlinearBodies {
 public:
  /// Collective.
  explicit NonlinearBodies(const SolidSystem<dim>& solids);

  /// The product of two stacked vectors over the dofs of each solid. Collective.
  std::vector<double> dot(const Vector& one, const Vector& other) const;
  /// Returns velocities in the frame of each solid's centre of mass, unchanged where some of a
  /// solid's nodes are held or carried, for these are the frame. Zero in all other rows.
  /// Collective.
  RCP<Vector> without_translations(const Vector& velocity) const;
  /// Multiplies the rows of each solid by its number; rows of no such solid stay.
  void scale(const std::vector<double>& by_solid, Vector& stacked) const;

 private:
  const SolidSystem<dim>& solids_;
  std::vector<int> solid_of_row_;  ///< -1: none
  std::vector<int> axis_of_row_;
  std::vector<double> mass_;  ///< by solid; 0 of one that is held
};

}  // namespace lockstep
