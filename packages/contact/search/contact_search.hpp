#pragma once
#include <vector>

#include "contact/bodies/solid_motion.hpp"

namespace lockstep {

/// Two surface points that touch or may touch within the step.
template <int dim>
struct Contact {
  int solid = -1;                     ///< the one that `normal` points to
  int other = -1;                     ///< a solid, or ~side for a wall (see `HalfSpace`)
  SurfacePoint<dim> point;            ///< on `solid`
  SurfacePoint<dim> other_point;      ///< on `other`; meaningless for a wall
  Point<dim> x = Point<dim>::Zero();  ///< where the impulse acts on both [m]
  /// The points meet later: each side is pushed at its own point, not at x.
  bool impact = false;
  Point<dim> normal = Point<dim>::Zero();  ///< unit, out of `other`
  double gap = 0;                          ///< along the normal, negative in an overlap [m]
  /// Distance that the turning of rigid solids adds to the gap within the step, beside dt times the
  /// normal velocity at x [m].
  double bend = 0;
  Point<dim> wall_velocity = Point<dim>::Zero();  ///< if `other` is a wall [m/s]

  const Point<dim>& place() const { return impact ? point.position : x; }
  const Point<dim>& other_place() const { return impact ? other_point.position : x; }
};

/// A wall of the domain; solids stay where sign * (x[axis] - coordinate) >= 0.
struct HalfSpace {
  int side = 0;  ///< 2 axis + (0 lower, 1 upper)
  int axis = 0;
  double sign = 1, coordinate = 0;
  Point<3> velocity = Point<3>::Zero();  ///< along itself, in the first dim components [m/s]
};

/// Distances and motions that the search for contacts covers.
struct ContactReach {
  double near = 0;                     ///< gaps up to this are contacts whatever the motion [m]
  double depth = 0;                    ///< deepest overlap that is recognised [m]
  std::vector<double> half_thickness;  ///< half thickness of each solid's skin [m]
  double dt = 0;                       ///< duration of the motion that is followed [s]
  bool swept = true;   ///< surfaces that the motion over dt meets beyond `near` count too
  bool unheld = true;  ///< nothing has acted on the motion: see `touching_side`
  /// Of a solid against itself, leave out what may neither overlap nor be violated by the motion:
  /// most of a sheet that is flat, whose parts lie side by side.
  bool violated_only = false;
};

/// All contacts of solids with each other and with walls. Two rigid ones: vertices against surfaces
/// both ways, sharp edges against sharp edges, and what fast vertices meet on their way. Others,
/// and themselves: see `add_surface_contacts`. Two prescribed solids have none. Shells are
/// two-sided, of finite thickness. Local; the same on all ranks.
template <int dim>
std::vector<Contact<dim>> find_contacts(const ContactShapes<dim>& shapes,
                                        const SolidMotion<dim>& motion,
                                        const std::vector<HalfSpace>& walls,
                                        const ContactReach& reach);

}  // namespace lockstep
