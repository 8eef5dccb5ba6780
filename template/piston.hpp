#pragma once
#include <array>
#include <vector>

#include "interfaces/solid_sides.hpp"

/// A solid of your own: a thin plate across a channel that slides along x and is pushed by a
/// constant force. One unknown, its velocity, on rank 0. Masses and forces are those of a metre of
/// depth, as in column_fluid.hpp.
class Piston : public lockstep::SolidModel<2>, public lockstep::AuditedSolids<2> {
 public:
  struct Options {
    double position = 0.7;  ///< along x [m]
    double width = 0.5;     ///< width of the channel, from y = 0 [m]
    double mass = 100;      ///< [kg/m]
    double force = 50;      ///< along x [N/m]
  };
  Piston(const Options& options, const lockstep::Communicator& comm);

  std::string name() const override { return "piston"; }
  const lockstep::AuditedSolids<2>* audit() const override { return this; }
  void save(lockstep::CheckpointWriter& checkpoint) const override;
  void load(const lockstep::CheckpointReader& checkpoint) override;
  const std::vector<lockstep::SolidDescription>& solids() const override { return solids_; }
  const lockstep::SurfaceMesh<2>& surface() const override { return surface_; }
  void velocity_row(const lockstep::SurfacePoint<2>& point, const lockstep::Point<2>& x,
                    lockstep::VelocityRow<2>& row) const override;
  lockstep::Point<2> effective_velocity(const lockstep::SurfacePoint<2>&,
                                        const lockstep::Point<2>&) const override {
    return {last_velocity_, 0};
  }

  lockstep::RCP<const lockstep::Map> dof_map() const override { return map_; }
  lockstep::RCP<const lockstep::LinearOperator> mass() const override { return mass_; }
  void explicit_momentum(double time, double dt, lockstep::Vector& momentum) const override;
  lockstep::Momentum<2> external_impulse(double time, double dt) const override;
  std::vector<lockstep::Momentum<2>> momentum_of_each(
      const lockstep::Vector& generalized_momentum) const override;

  lockstep::RCP<const lockstep::Vector> velocity() const override;
  void set_velocity(const lockstep::Vector& velocity) override;
  void move(const lockstep::Vector& velocity, double time, double dt) override;
  std::vector<lockstep::SolidState<2>> states() const override;

 private:
  /// The one entry of a vector on `map_`, on every rank. Collective.
  double only_entry(const lockstep::Vector& vector) const;
  lockstep::Point<2> center() const { return {position_, options_.width / 2}; }
  /// The surface, at the present position.
  void place();
  /// Position [m], velocity and that of the last `move` [m/s].
  std::array<double, 3> state() const { return {position_, velocity_, last_velocity_}; }
  void set_state(const std::array<double, 3>& state);

  Options options_;
  lockstep::Communicator comm_;
  double position_, velocity_ = 0, last_velocity_ = 0;
  std::vector<lockstep::SolidDescription> solids_;
  lockstep::SurfaceMesh<2> surface_;
  lockstep::RCP<const lockstep::Map> map_;
  lockstep::RCP<const lockstep::LinearOperator> mass_;
};
