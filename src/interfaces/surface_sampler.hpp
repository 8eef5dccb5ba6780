#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// A side interface of fluids that can be asked anywhere how far it is to the liquid's surface. The
/// observer "gauge" wants it; a fluid without it runs all the same.
template <int dim>
class SurfaceSampler {
 public:
  virtual ~SurfaceSampler() = default;
  /// From each point [m] to the free surface at the end of the last step, negative in the liquid
  /// [m], linear between the centres of cells, cut off a few cells away; 1e300 where nothing is
  /// stored. The same on all ranks. Of a fluid that has a surface (LiquidFluid). Collective; all
  /// ranks ask for the same points.
  virtual std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const = 0;
};

}  // namespace lockstep
