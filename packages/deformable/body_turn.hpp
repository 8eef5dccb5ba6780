#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "deformable/body_nodes.hpp"
#include "interfaces/solid.hpp"
#include "motion/rotation.hpp"

namespace lockstep {

/// Rotation of free bodies as a whole within a step.
///
/// A node at r from the centre of mass of a body that turns at omega moves along an arc, to R r
/// with R = exp(dt omega). Its velocity omega x r at the begin of the arc, which the fluid sees,
/// would take it to r + dt omega x r, off the circle by half the square of the turn, and strain the
/// body by as much. `drift` is the rest of the way. Volumes of second order that nothing holds
/// turn; all others go straight on.
template <int dim>
class BodyTurn {
 public:
  /// Both must outlive it; `states` are those of the bodies.
  BodyTurn(const BodyNodes<dim>& nodes, const std::vector<SolidState<dim>>& states)
      : nodes_(nodes), states_(states) {}

  /// A step of dt begins, from the present positions and velocities; `is_free`: bodies that nothing
  /// holds. The same on all ranks.
  void begin(double dt, const std::vector<char>& is_free);
  /// Takes the rotation that the velocities of local nodes in S1 have led to. Collective.
  void find_rotation(const std::vector<Point<dim>>& velocity);
  /// The step has ended: nothing turns.
  void end() { turns_.clear(); }
  /// True on all ranks or on none.
  bool any() const { return !turns_.empty(); }
  double dt() const { return dt_; }
  /// True if this body turns; the same on all ranks.
  bool is_turning(int body) const { return any() && turns_[body].is_turning; }

  // All that follows is of a local node, and zero where its body does not turn.

  /// Velocity of the rigid motion at the begin of the step [m/s].
  Point<dim> rigid_velocity(int node) const;
  /// Way of the rotation beside dt omega x r, over dt: x^{n+1} = x^n + dt (V + drift) [m/s].
  Point<dim> drift(int node) const;
  /// Drift of another step, after this one [m/s]; zero of bodies that turn by more than half a
  /// radian in a step, which nothing foresees.
  Point<dim> next_drift(int node) const;
  /// Way from the middle of the chord to that of the arc [m].
  Point<dim> rise_of_arc(int node) const;
  /// Velocity of the rotation at the end of the step less its mean [m/s].
  Point<dim> change_to_end(int node) const;

 private:
  struct Turn {
    bool is_turning = false;
    Point<dim> velocity = Point<dim>::Zero();              ///< velocity of the centre of mass [m/s]
    AngularVector<dim> rate = AngularVector<dim>::Zero();  ///< omega [rad/s]
    Orientation<dim> half = Orientation<dim>::Identity();  ///< R of half the step
    Orientation<dim> whole = Orientation<dim>::Identity();
  };
  void set_rate(const AngularVector<dim>& rate, Turn& turn) const;
  const Turn* turn_at(int node) const;
  /// f(turn, arm) of a node, zero where its body does not turn.
  template <typename Function>
  Point<dim> if_turning(int node, const Function& f) const;

  const BodyNodes<dim>& nodes_;
  const std::vector<SolidState<dim>>& states_;
  std::vector<Point<dim>> arms_;  ///< r at the begin, of local nodes [m]
  std::vector<Turn> turns_;
  double dt_ = 0;
};

}  // namespace lockstep
