#pragma once
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Opening of an inflow side of the domain.
template <int dim>
struct InflowOpening {
  Box<dim> box;  ///< along the side's axis everything [m]

  /// True for a point of the side normal to `axis` that lies in the opening.
  bool contains(int axis, const Point<dim>& x) const;
  /// The share of a face that is open: the flow through the faces is that through the opening,
  /// wherever that ends. `open` becomes that part of the face.
  double share(int axis, const Box<dim>& face, Box<dim>& open) const;
};

/// Declares the "Opening" of a side.
template <int dim>
void declare_inflow_opening(ParameterList& side);
/// `domain` limits the opening; `where` names the side in messages. Throws InputError.
template <int dim>
InflowOpening<dim> read_inflow_opening(const ParameterList& side, const Box<dim>& domain, int axis,
                                       const std::string& where);

}  // namespace lockstep
