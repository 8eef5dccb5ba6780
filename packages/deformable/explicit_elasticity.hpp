#pragma once
#include <optional>
#include <vector>

#include "deformable/element_forces.hpp"
#include "deformable/sub_steps.hpp"
#include "interfaces/step_bound.hpp"

namespace lockstep {

/// Bounds of the step by explicit forces, and elastic forces of bodies whose elasticity is explicit
/// at steps longer than their own stable one: means over sub-steps.
template <int dim>
class ExplicitElasticity {
 public:
  using Nodes = std::vector<Point<dim>>;
  /// Both must outlive it.
  ExplicitElasticity(const BodyNodes<dim>& nodes, const ElementForces<dim>& forces)
      : nodes_(nodes), forces_(forces), elastic_step_(nodes.bodies.size(), 1e300) {}

  /// A step of dt [s]; `holds_others`: other nodes are held than before.
  void begin_step(double dt, bool holds_others);
  /// Bounds the step at the present positions. Collective.
  void update_largest_stable_step();
  const StepBound& largest_stable_step() const { return largest_stable_step_; }
  /// Elastic forces for the present step on the owned nodes [N]; computed once for the same forces.
  /// Collective.
  const Nodes& averaged_forces() const;

 private:
  SubSteps steps_of(int body) const {
    return sub_steps_for(step_, elastic_step_[body], nodes_.bodies[body].most_sub_steps);
  }
  /// Averages the elastic forces of bodies with these sub-steps.
  void average_forces(const std::vector<int>& bodies, const SubSteps& steps, Nodes& force) const;
  void check_finite(const Nodes& averaged) const;
  /// The local nodes of a body: owned ones, ghosts.
  std::array<std::array<int, 2>, 2> nodes_of(int body) const;

  const BodyNodes<dim>& nodes_;
  const ElementForces<dim>& forces_;
  std::vector<double> elastic_step_;  ///< stable for each body without sub-steps [s]
  StepBound largest_stable_step_;
  double step_ = 0;                        ///< the present one [s]
  mutable std::optional<Nodes> averaged_;  ///< none: not asked for yet
  mutable unsigned averaged_number_ = 0;   ///< number of the forces it was made of
};

}  // namespace lockstep
