#pragma once
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"
#include "staggered/domain/wave_theory.hpp"

namespace lockstep {

/// A wave that a side of the domain sends into a tank: at the side the water moves as below a wave
/// that goes inwards and carries no water. A wave that comes back makes the surface higher where
/// the water goes in than where it goes out, if energy goes in; the `stream` takes back what that
/// brings, so that the tank neither fills nor empties.
template <int dim>
struct InflowWave {
  std::shared_ptr<const WaveTheory> theory;
  double depth = 0;                    ///< depth of the still water [m]
  double level = 0;                    ///< level of the still water, along `up` from the origin [m]
  Point<dim> up = Point<dim>::Zero();  ///< against gravity; along an axis
  Point<dim> inward = Point<dim>::Zero();  ///< normal of the side
  double ramp_time = 0;  ///< the height grows linearly from 0 during this time [s]; 0: at once
  double period = 0;     ///< [s]; 0: a solitary wave
  /// Velocity inwards, alike at all heights, that is added to the wave's [m/s]: it makes what comes
  /// in below the surface that is there, waves that come back included, `flow`.
  double stream = 0;

  /// Velocity at a point of the side [m/s]. Above the wave it is that at its surface.
  Point<dim> velocity_at(const Point<dim>& x, double time) const;
  /// The mean over a box that reaches over some height.
  Point<dim> mean_velocity(const Box<dim>& box, double time) const;
  /// Volume that the wave brings in a time, by the width of the side [m^2/s]; its mean over a
  /// period is 0.
  double flow(double time) const;

 private:
  /// The part of the height that has grown.
  double share(double time) const {
    return ramp_time > 0 ? std::clamp(time / ramp_time, 0.0, 1.0) : 1;
  }
  Point<dim> velocity(const WaveMotion& motion) const {
    return (motion.along + stream) * inward + motion.upward * up;
  }
  /// Integral of the velocity inwards over the height, without the stream [m^2/s].
  double flow_below_top(double time, double share) const;
};

/// Declares the list "Wave" of a side.
void declare_inflow_wave(ParameterList& side);
/// Reads the wave of a validated side normal to `axis`, at its upper end if `end` is 1; none if it
/// has no "Wave". `fluid`: the validated list. Throws InputError, naming `where`, for a side that
/// is no inflow, a fluid without a surface, gravity that is not along an axis of the side, and
/// waves that cannot be.
template <int dim>
std::optional<InflowWave<dim>> read_inflow_wave(const ParameterList& side,
                                                const ParameterList& fluid, const Box<dim>& domain,
                                                int axis, int end, const std::string& where);

}  // namespace lockstep
