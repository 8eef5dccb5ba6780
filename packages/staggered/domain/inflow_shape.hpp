#pragma once
#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Opening of a side of the domain, and profile of the inflow through it.
template <int dim>
struct InflowShape {
  Box<dim> opening;        ///< along the side's axis everything [m]
  bool parabolic = false;  ///< else uniform over the opening

  /// Velocity at `x` on the side normal to `axis`, over the mean one.
  double factor(int axis, const Point<dim>& x) const;
  /// Mean of `factor` over a face, whose part outside of the opening counts as zero: the flow
  /// through the faces is that through the opening, wherever that ends.
  double mean_factor(int axis, const Box<dim>& face) const;
};

/// Declares "Profile" and "Opening" of a side.
template <int dim>
void declare_inflow_shape(ParameterList& side);
/// `domain` limits the opening; `where` names the side in messages. Throws InputError.
template <int dim>
InflowShape<dim> read_inflow_shape(const ParameterList& side, const Box<dim>& domain, int axis,
                                   const std::string& where);

}  // namespace lockstep
