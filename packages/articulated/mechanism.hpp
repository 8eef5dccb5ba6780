#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "articulated/joint_control.hpp"
#include "articulated/joint_kind.hpp"
#include "articulated/joint_limits.hpp"
#include "interfaces/solid_sides.hpp"

namespace lockstep {

template <int dim>
constexpr int n_twist = dim + n_rotations<dim>;
/// Velocity of a body's reference point, then its angular velocity.
template <int dim>
using TwistVector = Eigen::Matrix<double, n_twist<dim>, 1>;

/// A solid that joints connect.
template <int dim>
struct JointedBody {
  std::string name;
  const JointableSolids<dim>* model = nullptr;
  int solid = -1;                    ///< its number there
  GlobalIndex first_dof = no_index;  ///< in the stack of all solids; no_index: prescribed
  double mass = 0;                   ///< [kg]
  double fluid_mass =
      0;  ///< mass of fluid that the body has to push, about; 0 if no fluid sees it [kg]
  bool carries_nodes = false;  ///< true if it carries nodes of deformable solids
  bool prescribed() const { return first_dof == no_index; }
  /// About what resists its motion [kg].
  double weight() const { return mass + fluid_mass; }
};

template <int dim>
struct BodyPose {
  Point<dim> position = Point<dim>::Zero();  ///< position of the reference point [m]
  Axes<dim> rotation = Axes<dim>::Identity();
};

constexpr int space = -1;  ///< in the place of a body

/// Frame of a joint on a body, in the body's coordinates.
template <int dim>
struct JointSide {
  int body = space;
  Point<dim> point = Point<dim>::Zero();
  Axes<dim> axes = Axes<dim>::Identity();
};

template <int dim>
struct Joint {
  std::string name;
  std::string type;  ///< name of the kind in scenes
  std::shared_ptr<const JointKind<dim>> kind;
  std::array<JointSide<dim>, 2> sides;
  JointControl control;
  JointLimits limits;
  int first_rate = -1;   ///< among those of all joints; -1: it closes a loop and has none
  Eigen::VectorXd q;     ///< present coordinates
  TargetValue at_begin;  ///< coordinates and rates at the begin of the step
  TargetValue at_kick;   ///< coordinates and rates where the present kick acts
  TargetValue goal;      ///< where given coordinates are at the step's end

  bool wants_rates() const { return control.any() || limits.any(); }
};

/// Place of a joint and of its two sides in space.
template <int dim>
struct JointPlace {
  Point<dim> point;        ///< point of the second side
  Axes<dim> axes;          ///< axes of the first side
  RelativePose<dim> pose;  ///< pose of the second side against the first
};

/// Bodies that joints connect, as a tree and joints that close loops in it.
struct Mechanism {
  int root = space;           ///< a dynamic body that no joint ties to the ground; else space
  std::vector<int> bodies;    ///< dynamic ones from the root outward, the root first
  std::vector<int> carriers;  ///< the joint that carries each of them; -1 for the root
  std::vector<int> loops;     ///< joints that close loops
  std::vector<int> grounds;   ///< prescribed bodies
  std::vector<int> joints;    ///< all
};

/// Spanning trees: rooted in space and in prescribed bodies if a joint leads there, else in the
/// body of the most weight, of equal ones the first of the scene: whichever body a joint names
/// first. Joints that want rates are in the tree before others; the tree's joints get the numbers
/// of their rates.
template <int dim>
std::vector<Mechanism> find_mechanisms(const std::vector<JointedBody<dim>>& bodies,
                                       std::vector<Joint<dim>>& joints);

/// The joints of the loop that one of `loops` closes, itself the first.
template <int dim>
std::vector<int> loop_of(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints,
                         int closing);

/// Pose of a side's body; that of space stands still.
template <int dim>
BodyPose<dim> pose_of(const std::vector<BodyPose<dim>>& poses, int body) {
  return body == space ? BodyPose<dim>() : poses[body];
}
template <int dim>
JointPlace<dim> place_of(const Joint<dim>& joint, const std::vector<BodyPose<dim>>& poses);

/// Covector by which the row of a screw between the sides reads the twist of the body of one of
/// them.
template <int dim>
TwistVector<dim> row_on_side(const Screw<dim>& row, const JointPlace<dim>& place, int side,
                             const Point<dim>& reference);

/// Twists of a mechanism's bodies as combinations of the dofs that are left: of the root, of
/// prescribed bodies, and of the joints' rates.
template <int dim>
struct MotionBasis {
  std::vector<GlobalIndex> columns;  ///< dofs, in the stack of all solids
  std::vector<Eigen::Matrix<double, n_twist<dim>, Eigen::Dynamic>> twists;  ///< by body of the
                                                                            ///< mechanism
  /// Rates that loops make combinations of others: the number of the column, then a row over all
  /// columns, zero at those that depend on others.
  std::vector<std::pair<int, Eigen::RowVectorXd>> dependent;
};

/// Numbers of the dofs of joints and prescribed bodies in the stack.
struct RateDofs {
  GlobalIndex first_rate = 0;              ///< first rate of all joints
  std::vector<GlobalIndex> first_of_body;  ///< first dof of the twist of prescribed bodies
};

/// `given`: 1 for joint rates that are given, which loops cannot make combinations.
template <int dim>
MotionBasis<dim> motion_basis(const Mechanism& mechanism,
                              const std::vector<JointedBody<dim>>& bodies,
                              const std::vector<Joint<dim>>& joints,
                              const std::vector<BodyPose<dim>>& poses, const RateDofs& dofs,
                              const std::vector<char>& given);

}  // namespace lockstep
