#pragma once
#include <memory>
#include <vector>

#include "articulated/articulation.hpp"
#include "interfaces/energy.hpp"

namespace lockstep {

/// The rates of all joints as unknowns: a solid model without surface and without mass, which the
/// bodies lend them (P^T M P). Behind them stand the twists of prescribed bodies that joints tie
/// others to, as given dofs. All live on rank 0; values are replicated.
template <int dim>
class JointRates : public SolidModel<dim>, public AuditedSolids<dim> {
 public:
  JointRates(std::shared_ptr<Articulation<dim>> articulation, const Communicator& comm,
             double start_time);

  std::string name() const override { return "joints"; }
  const AuditedSolids<dim>* audit() const override { return this; }
  const std::vector<SolidDescription>& solids() const override { return none_; }
  const SurfaceMesh<dim>& surface() const override { return surface_; }
  void velocity_row(const SurfacePoint<dim>&, const Point<dim>&,
                    VelocityRow<dim>& row) const override {
    row.clear();
  }
  Point<dim> effective_velocity(const SurfacePoint<dim>&, const Point<dim>&) const override {
    return Point<dim>::Zero();
  }
  RCP<const Map> dof_map() const override { return map_; }
  RCP<const LinearOperator> mass() const override { return mass_; }
  RCP<const LinearOperator> implicit_force(double dt) const override;
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  void take_kicks() override { articulation_->take_kicks(); }
  void begin_step(double time, double dt) override { articulation_->begin_step(time, dt); }
  Momentum<dim> external_impulse(double, double) const override { return {}; }
  std::optional<SolidWork> solid_work(double time, double dt, const Vector& velocity,
                                      const Vector& mean) const override;
  std::vector<Momentum<dim>> momentum_of_each(const Vector&) const override { return {}; }
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<double> locked_velocities(double begin, double end) const override;
  RCP<const Vector> velocity() const override;
  void set_velocity(const Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  std::vector<SolidState<dim>> states() const override { return {}; }
  StepBound largest_stable_step() const override;

  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

 private:
  Eigen::VectorXd gather(const Vector& velocity) const;
  std::vector<double> state() const;
  void set_state(const std::vector<double>& values);

  std::shared_ptr<Articulation<dim>> articulation_;
  Communicator comm_;
  std::vector<SolidDescription> none_;
  SurfaceMesh<dim> surface_;
  RCP<const Map> map_;
  RCP<const LinearOperator> mass_;
  double time_;  ///< time of the present positions [s]
};

}  // namespace lockstep
