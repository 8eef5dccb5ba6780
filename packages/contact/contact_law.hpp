#pragma once
#include <optional>
#include <set>
#include <vector>

#include "contact/bodies/solid_motion.hpp"
#include "contact/gauss_seidel_contact.hpp"

namespace lockstep {

/// Overlap that is left alone, and gap up to which solids count as touching [h]. Chosen so that a
/// resting pile is quiet and overlaps stay small beside a cell; no page varies it.
constexpr double usual_slop = 0.05;

/// Requirements of a contact in one resolution: its gap as a linear function of velocities, the
/// least normal velocity, friction, and what is kept between surfaces. Local.
template <int dim>
class ContactLaw {
 public:
  /// The shapes and the options must outlive this; `spacing` h [m], dt [s].
  ContactLaw(const ContactShapes<dim>& shapes, const GaussSeidelOptions& options, double spacing,
             ContactPhase phase, double dt);

  /// Normal velocity of `contact.solid` relative to the other; positive: they part [m/s].
  double normal_velocity(const SolidMotion<dim>& motion, const Contact<dim>& contact) const;
  /// Least normal velocity [m/s] for a motion; `before`: that of the beginning of the step.
  /// `bouncing`: the contacts that bounce by an earlier decision, by `bounce_key`; null: none is
  /// kept.
  double target(const Contact<dim>& contact, const SolidMotion<dim>& motion,
                const SolidMotion<dim>& before, const std::set<std::size_t>* bouncing) const;
  /// Names a contact within a step.
  std::size_t bounce_key(const Contact<dim>& contact) const;
  double friction(const Contact<dim>& contact) const;  ///< Coulomb's coefficient [1]
  /// Lets the impulse act where turning takes the place in contact, and finds its `bend`: the gap
  /// there as a linear function of the velocities near `motion`, that of the beginning of the step,
  /// since what nothing holds yet may turn in any way. Along its chord a wheel would land on a
  /// point ahead of it, which brakes it. Of what is not rigid the bend is that of its drift.
  void follow_turns(const SolidMotion<dim>& motion, Contact<dim>& contact) const;
  /// Gap that surfaces of solids which are not both rigid keep between them [m].
  double clearance_between(int solid, int other) const;
  /// True if one of both solids is not rigid; a wall is.
  bool any_bends(int solid, int other) const;
  /// True if it does not move by impulses: a wall or a prescribed solid.
  bool is_given(int solid) const { return solid < 0 || shapes_.solids()[solid].prescribed; }
  /// Half thickness of the skin of each solid [m].
  const std::vector<double>& half_thickness() const { return half_thickness_; }

 private:
  /// Returns the place to which the turning of a rigid solid takes a point of it against the normal
  /// within the step: the end of its arc, or the lowest point on the way. Other solids do not turn.
  Point<dim> turned_place(const SolidMotion<dim>& motion, int solid, const Point<dim>& x,
                          const Point<dim>& normal) const;
  /// True of a shell that bends; a wall is not.
  bool is_cloth(int solid) const;
  /// Returns how much the gap opens by the drift of both sides [m].
  double bend_of_drift(const Contact<dim>& contact) const;
  /// Geometric mean of a property of both sides.
  double mean(const Contact<dim>& contact, double SolidDescription::*property,
              const std::optional<double>& of_walls) const;
  double slop(const Contact<dim>& contact) const;  ///< overlap that is left alone [m]

  const ContactShapes<dim>& shapes_;
  const GaussSeidelOptions& options_;
  double spacing_;
  ContactPhase phase_;
  double dt_;
  std::vector<double> half_thickness_;
};

/// Hash of a place, the same for equal places.
template <int dim>
std::size_t hash_of(const Point<dim>& place);

}  // namespace lockstep
