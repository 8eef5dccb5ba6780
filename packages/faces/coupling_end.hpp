#pragma once
#include "coupling/solid_system.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

/// Puts together what the shares of a viscous link's end say of it, but for the rows of dofs.
template <int dim>
class CouplingEnd {
 public:
  CouplingEnd(const SolidSystem<dim>& solids, int direction, EndVelocity<dim>& row)
      : solids_(solids), direction_(direction), row_(row) {}

  /// A share of a solid, whose velocity is taken at x; nodes are pulled at `pulled`, where the
  /// surface is. Returns whether the solid is dynamic.
  bool add(double weight, const SurfacePoint<dim>& point, int solid, const Point<dim>& x,
           const Point<dim>& pulled);
  void add_entry(GlobalIndex dof, double weight) {
    row_.dofs.push_back(dof);
    row_.weights.push_back(weight);
  }
  /// After all shares: the link pulls at the mean of the dynamic ones.
  void finish();

 private:
  const SolidSystem<dim>& solids_;
  int direction_;
  EndVelocity<dim>& row_;
  Point<dim> pulled_ = Point<dim>::Zero();
  double dynamic_share_ = 0, largest_share_ = 0;
};

}  // namespace lockstep
