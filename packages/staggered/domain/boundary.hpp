#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "grid/tile_lattice.hpp"
#include "parameters/parameter_list.hpp"
#include "staggered/domain/inflow_shape.hpp"
#include "staggered/domain/inflow_wave.hpp"

namespace lockstep {

enum class SideType {
  wall,       ///< closed, the fluid sticks to it
  slip_wall,  ///< closed, without friction
  open,       ///< p = 0 at the face
  inflow,     ///< prescribed velocity
  periodic
};

/// One side of the domain.
template <int dim>
struct BoundarySide {
  SideType type = SideType::wall;
  Point<dim> velocity =
      Point<dim>::Zero();   ///< velocity of the wall (tangential only) or the inflow [m/s]
  double ramp_time = 0;     ///< the velocity grows linearly from 0 during this time [s]; 0: at once
  double end_time = 1e300;  ///< after it the velocity is 0 [s]
  InflowShape<dim> shape;
  std::optional<InflowWave<dim>> wave;  ///< instead of `velocity`
  double smoke = 0;                     ///< carried by the inflow [1]
  double temperature = 0;               ///< carried by the inflow [K]

  bool closed() const { return type == SideType::wall || type == SideType::slip_wall; }
  /// True if fluid may come in or leave at a given velocity, or a wall move.
  bool moves() const { return wave || velocity != Point<dim>::Zero(); }
  bool prescribed() const { return closed() || type == SideType::inflow; }
  /// The part of `velocity` at a time.
  double ramp(double time) const {
    if (time > end_time)
      return 0;
    return ramp_time > 0 && time < ramp_time ? std::max(time, 0.0) / ramp_time
                                             : 1;  // time may be < 0
  }
  /// True if the velocity jumps in [begin, end); at `end_time` itself it has not jumped yet.
  bool jumps(double begin, double end) const {
    return velocity != Point<dim>::Zero() && begin <= end_time && end_time < end &&
           ramp(end_time) > 0;
  }
  /// At `x` on this side, which is normal to `axis`.
  Point<dim> velocity_at(int axis, const Point<dim>& x, double time) const {
    if (wave)
      return wave->velocity_at(x, time, ramp(time));
    return velocity * (ramp(time) * (type == SideType::inflow ? shape.factor(axis, x) : 1));
  }
  /// The mean over a face of this side.
  Point<dim> mean_velocity(int axis, const Box<dim>& face, double time) const {
    if (wave)
      return wave->mean_velocity(face, time, ramp(time));
    return velocity * (ramp(time) * (type == SideType::inflow ? shape.mean_factor(axis, face) : 1));
  }
};

/// The sides of the domain: [axis][0 lower, 1 upper].
template <int dim>
struct Boundary {
  std::array<std::array<BoundarySide<dim>, 2>, dim> sides;

  const BoundarySide<dim>& side(int axis, int end) const { return sides[axis][end]; }
  bool periodic(int axis) const { return sides[axis][0].type == SideType::periodic; }
};

/// "x lower", as the scene names it.
std::string side_name(int axis, int end);

/// The cells and sides of a scene's "Domain" list.
template <int dim>
struct DomainDescription {
  GridDescription<dim> grid;
  Boundary<dim> boundary;
};

/// Adds the waves of a validated list "Domain" to its boundary; `fluid` is the list "Fluid". Throws
/// InputError.
template <int dim>
void read_waves(const ParameterList& fluid, const ParameterList& domain,
                DomainDescription<dim>& description);

/// Schema of the "Domain" list.
template <int dim>
ParameterList domain_parameters();
/// Throws InputError if the cells are not cubes, or too small to be told apart so far from the
/// origin, if only one side of an axis is periodic, or if a
/// wall moves through itself.
template <int dim>
DomainDescription<dim> read_domain(const ParameterList& list);

/// Sets the storage that the sides need: faces at the upper end of open and inflow sides.
template <int dim>
void set_grid_flags(const Boundary<dim>& boundary, GridDescription<dim>& grid);

}  // namespace lockstep
