#pragma once
#include <algorithm>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A regular wave of linear theory that a side of the domain sends into a tank: at the side the
/// water rises with a sin(omega t), a = height / 2, and moves as below a wave that goes inwards,
/// less the mean flow of that wave, so that the tank neither fills nor empties.
template <int dim>
struct InflowWave {
  double height = 0;                   ///< from trough to crest [m]
  double period = 0;                   ///< [s]
  double depth = 0;                    ///< depth of the still water [m]
  double level = 0;                    ///< level of the still water, along `up` from the origin [m]
  double gravity = 0;                  ///< [m/s^2]
  Point<dim> up = Point<dim>::Zero();  ///< against gravity; along an axis
  Point<dim> inward = Point<dim>::Zero();  ///< normal of the side
  double number = 0;                       ///< k, of omega^2 = g k tanh(k depth) [1/m]
  double ramp_time = 0;  ///< the height grows linearly from 0 during this time [s]; 0: at once

  double frequency() const { return 2 * M_PI / period; }  ///< omega [1/s]
  double speed() const { return frequency() / number; }   ///< speed of a crest [m/s]

  /// The part of the height that has grown.
  double share(double time) const {
    return ramp_time > 0 ? std::clamp(time / ramp_time, 0.0, 1.0) : 1;
  }

  /// Velocity at a point of the side [m/s]. Above the still water it is that at its level.
  Point<dim> velocity_at(const Point<dim>& x, double time) const;
  /// The mean over a box that reaches over some height.
  Point<dim> mean_velocity(const Box<dim>& box, double time) const;

 private:
  /// Velocity from cosh(k (z + depth)) / sinh(k depth) along the side and the same with sinh
  /// upwards [m/s].
  Point<dim> velocity(double along, double up_part, double time) const;
};

/// k > 0 of omega^2 = g k tanh(k depth) [1/m].
double wave_number(double frequency, double gravity, double depth);

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
