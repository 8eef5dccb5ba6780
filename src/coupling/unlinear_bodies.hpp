#pragma once
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// The dofs of each solid that may have implicit forces, apart from those of all others: what is to
/// be judged solid by solid, lest it depend on what others do. Solids are numbered as in
/// `SolidSystem::solids`; those of models without such forces have none of these dofs. For the
/// present dofs and masses.
template <int dim>
class UnlinearBodies {
 public:
  /// Collective.
  explicit UnlinearBodies(const SolidSystem<dim>& solids);

  /// The product of two stacked vectors over the dofs of each solid. Collective.
  std::vector<double> dot(const Vector& one, const Vector& other) const;
  /// Velocities in the frame of each solid's centre of mass; as they are where some of a solid's
  /// nodes are held or carried, for these are the frame. Zero in all other rows. Collective.
  RCP<Vector> without_translations(const Vector& velocity) const;
  /// One of these numbers for each row, times that row; rows of no such solid stay.
  void scale(const std::vector<double>& by_solid, Vector& stacked) const;

 private:
  const SolidSystem<dim>& solids_;
  std::vector<int> solid_of_row_;  ///< -1: none
  std::vector<int> axis_of_row_;
  std::vector<double> mass_;  ///< by solid; 0 of one that is held
};

}  // namespace lockstep
