#pragma once
#include <limits>

#include "interfaces/fluid.hpp"

namespace lockstep {

/// A capability of fluids: to tell in which box they can be. What of a solid lies beyond an open
/// side or a wall displaces nothing.
template <int dim>
class BoundedFluid {
 public:
  virtual ~BoundedFluid() = default;
  virtual Box<dim> bounds() const = 0;  ///< [m]; the same on every rank. Local.
};

/// All of space for fluids without bounds. Local.
template <int dim>
Box<dim> bounds_of(const FluidDiscretization<dim>& fluid) {
  if (const auto* bounded = dynamic_cast<const BoundedFluid<dim>*>(&fluid))
    return bounded->bounds();
  const Point<dim> far = Point<dim>::Constant(std::numeric_limits<double>::max());
  return Box<dim>(-far, far);
}

}  // namespace lockstep
