#pragma once
#include <array>
#include <vector>

#include "motion/motion_script.hpp"
#include "motion/rotation.hpp"

namespace lockstep {

/// Nodes of a body that a script moves, or that are let go at some time.
template <int dim>
struct NodeHold {
  std::vector<int> nodes;
  std::array<bool, dim> axes{};  ///< axes of space along which they are held
  /// Displacement and turn of the held nodes; the start of the run is where the nodes are. Empty:
  /// at rest.
  MotionScript<dim> script;
  Point<dim> origin = Point<dim>::Zero();  ///< centre of turns [m]
  double release_time = 1e300;             ///< [s]
};

/// The held dofs (dim * node + axis) of this rank's nodes: which are held in the present step, and
/// how fast they move.
template <int dim>
class HeldNodes {
 public:
  HeldNodes() = default;
  explicit HeldNodes(double start_time) : start_time_(start_time) {}

  double start_time() const { return start_time_; }
  /// The number of the hold, for `hold`.
  int add(const NodeHold<dim>& hold);
  /// Holds a node along an axis; `at` is where it starts [m]. Number -1: at rest for ever. Nodes
  /// ascend.
  void hold(int node, int axis, const Point<dim>& at, int number);
  /// Lets go of the nodes that are released by the time at which a step begins [s]. Returns true if
  /// other dofs are held than before, on all ranks.
  bool begin_step(double time);

  /// Held in the present step, ascending.
  std::vector<int> dofs() const;
  /// Mean velocity of each held dof between two times, at equal times the velocity then [m/s].
  std::vector<double> velocities(double begin, double end) const;

 private:
  struct Dof {
    int dof = 0, hold = -1;
    Point<dim> start;
  };
  /// Place to which a hold has taken its nodes.
  struct Pose {
    Point<dim> displacement, velocity;
    Eigen::Matrix<double, dim, dim> rotation;
    AngularVector<dim> angular_velocity;
  };
  std::vector<Pose> poses(double time) const;
  bool is_held(const Dof& dof) const { return dof.hold < 0 || !released_[dof.hold]; }

  double start_time_ = 0;
  std::vector<NodeHold<dim>> holds_;
  std::vector<char> released_;
  std::vector<Dof> dofs_;
};

}  // namespace lockstep
