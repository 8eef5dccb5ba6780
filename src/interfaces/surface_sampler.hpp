#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// A side interface of fluids whose distance to the free surface can be sampled at any point. The
/// observer "gauge" needs it; a fluid without it runs all the same.
template <int dim>
class SurfaceSampler {
 public:
  virtual ~SurfaceSampler() = default;
  /// Returns the signed distance from each point [m] to the free surface at the end of the last
  /// step, negative in the liquid [m]: linear between the centres of cells, cut off at the edge of
  /// the narrow band; 1e300 where nothing is stored. The same on all ranks. The fluid must have a
  /// free surface (LiquidFluid). Collective; all ranks ask for the same points.
  virtual std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const = 0;
};

}  // namespace lockstep
