#pragma once
#include "liquid/common/interface_model.hpp"

namespace lockstep {

/// Tells over which cells' centres surfaces of solids pass in a step.
template <int dim>
class SweptCells {
 public:
  /// `domain` and `step` must outlive this. Local.
  SweptCells(const MacDomain<dim>& domain, const InterfaceStep<dim>& step);

  /// The point of a surface that passes over the centre, or touches it before or after; none: the
  /// centre stays on its side. Local.
  std::optional<SurfacePoint<dim>> operator()(int cell) const;
  /// Largest motion of a surface in the step [m].
  double motion() const { return motion_; }

 private:
  const TiledGrid<dim>& grid_;
  const InterfaceStep<dim>& step_;
  double motion_;
  std::shared_ptr<const NearbySurface<dim>> near_;  ///< the surface before the step
};

}  // namespace lockstep
