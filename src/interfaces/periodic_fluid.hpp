#pragma once
#include <array>

namespace lockstep {

/// Side of a fluid (`side_of`) that comes in again where it has left. Of solids, those that
/// `RepeatedSolids` repeats do.
template <int dim>
class PeriodicFluid {
 public:
  virtual ~PeriodicFluid() = default;
  /// Axes along which it does. The same on every rank. Local.
  virtual std::array<bool, dim> periodic_axes() const = 0;
};

}  // namespace lockstep
