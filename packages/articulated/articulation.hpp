#pragma once
#include <memory>
#include <vector>

#include "articulated/free_motion.hpp"
#include "articulated/mechanism.hpp"
#include "interfaces/constraint.hpp"

namespace lockstep {

struct ArticulationOptions {
  /// Half of the joints' impulse acts where a step begins, half where it ends; false: all of it
  /// where it ends.
  bool two_halves = true;
  bool fully_implicit = false;  ///< springs and dampers, not of the middle of the step
  double largest_turn = 0.2;    ///< largest turn of a jointed body in a step [rad]
};

/// The joints of a scene, the bodies that they connect, and their coordinates. Replicated on all
/// ranks.
template <int dim>
class Articulation {
 public:
  /// `first_dof`: where the dofs of the joints begin in the stack of all solids, rates first, then
  /// the twists of prescribed bodies.
  Articulation(std::vector<JointedBody<dim>> bodies, std::vector<Joint<dim>> joints,
               const ArticulationOptions& options, GlobalIndex first_dof);

  const std::vector<JointedBody<dim>>& bodies() const { return bodies_; }
  const std::vector<Joint<dim>>& joints() const { return joints_; }
  std::vector<Joint<dim>>& joints() { return joints_; }
  const std::vector<Mechanism>& mechanisms() const { return mechanisms_; }
  const ArticulationOptions& options() const { return options_; }
  const RateDofs& dofs() const { return dofs_; }
  int n_rates() const { return n_rates_; }
  int n_dofs() const { return n_dofs_; }  ///< with those of prescribed bodies

  /// Present poses, by body.
  std::vector<BodyPose<dim>> poses() const;
  /// Poses of prescribed bodies at a time; those of other bodies are not meant to be read.
  std::vector<BodyPose<dim>> prescribed_poses(double time) const;
  /// Mean twist of a prescribed body between two times; at equal times the twist then.
  TwistVector<dim> prescribed_twist(int body, double begin, double end) const;
  std::vector<MotionBasis<dim>> motion_bases() const;
  /// The fastest turning jointed body [rad/s].
  double fastest_turn() const;
  /// Steps are two kicks and a drift from now on.
  void take_kicks() { takes_kicks_ = true; }
  /// Begins a step: keeps the coordinates of joints, and finds those that given joints will have.
  void begin_step(double time, double dt);
  /// q after a move in which the rates times dt were `change`.
  void update_coordinates(const Eigen::VectorXd& change);
  /// Rates of all joints; those of one; whether they are given.
  Eigen::VectorXd& rates() { return rates_; }
  const Eigen::VectorXd& rates() const { return rates_; }
  Eigen::VectorXd rates_of(const Joint<dim>& joint) const;
  const std::vector<char>& given() const { return given_; }
  bool any_acts() const;  ///< springs and dampers
  /// Springs and dampers of the present step or kick, by rate: torque = constant - slope rate. In
  /// the paper's step springs are taken at its middle; dampers are implicit before the bodies move,
  /// and half so after it. Fully implicit ones are taken at its end.
  ControlLaw control() const;
  /// True after the bodies went to their places of the end of the step.
  bool has_moved() const { return has_moved_; }
  bool takes_kicks() const { return takes_kicks_; }

 private:
  void set_gains();

  std::vector<JointedBody<dim>> bodies_;
  std::vector<Joint<dim>> joints_;
  ArticulationOptions options_;
  std::vector<Mechanism> mechanisms_;
  RateDofs dofs_;
  int n_rates_ = 0, n_dofs_ = 0;
  Eigen::VectorXd rates_;
  std::vector<char> given_;  ///< by rate
  bool takes_kicks_ = false, has_moved_ = false;
  double begin_ = 0, dt_ = 0;  ///< begin and length of the present step [s]
};

/// The ties between the bodies of an articulation.
template <int dim>
class JointConstraints : public ConstraintModel {
 public:
  JointConstraints(std::shared_ptr<Articulation<dim>> articulation, const Communicator& comm);

  std::string name() const override { return "joints"; }
  std::vector<Combination> combinations() const override;
  ClosedMotion close(double time, double dt, const Vector& correction, const Vector& solved,
                     Vector& velocity) override;
  std::vector<JointLimit> limits(double dt, const std::vector<double>& velocity) const override;
  std::vector<GivenMotion> given_motions() const override;
  std::string limited() const override;
  bool has_implicit_forces() const override { return articulation_->any_acts(); }
  int largest_block() const override;
  void take_note(const JointImpulses& impulses, double time, double dt) override;
  std::vector<JointState> states(double time) const override;
  std::string note() const override;
  void set_target(const std::string& joint, double time, const std::vector<double>& q,
                  const std::vector<double>& rate) override;

 private:
  /// All bodies in S1, by body.
  struct StepMotions {
    std::vector<BodyMass<dim>> masses;
    std::vector<BodyMotion<dim>> solved, motions;  ///< before contact; after it, then as they go
    std::vector<TwistVector<dim>> corrections, later, constraint_error;  ///< see ClosedMotion
  };
  /// Free motions of a mechanism, by its own numbers (LoneMechanism).
  struct FoundFreeMotions {
    FreeMotion<dim> free, pushed;  ///< without contact; with what it did
  };
  std::vector<TwistVector<dim>> gather_twists(const Vector& velocity) const;
  Eigen::VectorXd gather_rates(const Vector& velocity) const;
  void set_twists(const std::vector<TwistVector<dim>>& twists, Vector& velocity) const;
  void set_rates(const Mechanism& mechanism, const std::vector<Eigen::VectorXd>& coordinates,
                 double dt, Vector& velocity) const;
  std::optional<FreeMotionSteps> free_motion_steps(const Mechanism& mechanism, double turn,
                                                   bool touched) const;
  std::optional<FoundFreeMotions> free_motions(const Mechanism& mechanism,
                                               const ClosingProblem<dim>& problem,
                                               const std::vector<BodyMotion<dim>>& solved,
                                               const std::vector<BodyMotion<dim>>& motions) const;
  StepMotions motions_of(const Vector& correction, const Vector& solved,
                         const Vector& velocity) const;
  void take(const Mechanism& mechanism, const FoundFreeMotions& found, StepMotions& step) const;
  RCP<Vector> marks_at_end(const RCP<const Map>& map) const;
  void follow(const ClosingProblem<dim>& problem, const Eigen::VectorXd& change,
              std::vector<BodyMotion<dim>>& motions) const;
  RCP<Vector> constraint_error(const std::vector<TwistVector<dim>>& change,
                               const RCP<const Map>& map) const;

  std::shared_ptr<Articulation<dim>> articulation_;
  Communicator comm_;
  Eigen::VectorXd impulse_, limit_impulse_;  ///< by rate, of the last step
  std::vector<char> limited_;                ///< likewise: by the largest torque
  double dt_ = 0;                            ///< length of the last step [s]; 0: there was none
  std::vector<char> two_halves_;             ///< by joint, likewise
};

}  // namespace lockstep
