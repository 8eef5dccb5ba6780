#pragma once
#include <memory>
#include <string>
#include <vector>

namespace lockstep {

/// A wave of permanent form on still water of constant depth, over a flat bottom.
struct WaterWave {
  double height = 0;   ///< from trough to crest, of a solitary wave above the still water [m]
  double period = 0;   ///< 0: a solitary wave [s]
  double depth = 0;    ///< depth of the still water [m]
  double gravity = 0;  ///< [m/s^2]
};

/// Velocity of the water below a wave [m/s].
struct WaveMotion {
  double along = 0, upward = 0;  ///< in the direction of the wave, against gravity
};

/// The motion of the water at one place, as a theory of waves has it. Periodic waves carry no
/// water: a mean flow against them takes back what they carry along between trough and crest.
class WaveTheory {
 public:
  virtual ~WaveTheory() = default;
  /// Motion at z above the still water [m], between the bottom and `top`. `share`: the part of the
  /// height that the wave has by now.
  virtual WaveMotion motion(double z, double time, double share) const = 0;
  /// The height up to which `motion` holds [m]: the surface, of linear theory the still water.
  virtual double top(double time, double share) const = 0;
  virtual double speed() const = 0;  ///< speed of a crest [m/s]
  /// From crest to crest; where a solitary wave is higher than a hundredth of its height [m].
  virtual double length() const = 0;
};

/// Names of the theories: "Airy", "Stokes 2", "Stokes 5" and "solitary".
const std::vector<std::string>& wave_theories();
/// Makes the wave. Throws InputError, naming `where`, for one that breaks, or that is too long for
/// the expansion of Stokes.
///
/// Stokes' waves to the first, second and fifth order of their steepness (Fenton 1985; the first is
/// Airy's): at the start the surface rises through about its mean. The solitary wave of third order
/// (Grimshaw 1971): at the start it is yet to come.
std::unique_ptr<WaveTheory> make_wave(const std::string& theory, const WaterWave& wave,
                                      const std::string& where);

/// k > 0 of omega^2 = g k tanh(k depth) [1/m].
double wave_number(double frequency, double gravity, double depth);

}  // namespace lockstep
