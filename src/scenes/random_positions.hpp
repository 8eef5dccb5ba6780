#pragma once
#include <vector>

#include "parameters/strict_values.hpp"

namespace lockstep {

/// A place that others must stay away from.
struct OccupiedPlace {
  std::vector<double> position;  ///< [m], a component an axis
  double radius;                 ///< [m]
};

/// Places, one for each of `radii`, in the box from `lower` to `upper`, drawn one after the other
/// from an even distribution; one that is nearer to another, or to one of `occupied`, than the sum
/// of their radii is drawn again. The same `seed` gives the same places everywhere. Throws
/// InputError, beginning with `where`, if a place is not found in ten thousand draws.
std::vector<std::vector<double>> random_positions(const std::vector<double>& radii,
                                                  const std::vector<double>& lower,
                                                  const std::vector<double>& upper,
                                                  const std::vector<OccupiedPlace>& occupied,
                                                  int seed, const std::string& where);

}  // namespace lockstep
