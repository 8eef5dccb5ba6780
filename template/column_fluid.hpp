#pragma once
#include <vector>

#include "interfaces/fluid_sides.hpp"

/// A fluid of your own: a straight channel along x, one cell wide, open (p = 0) at both ends. Its
/// incompressible velocity is uniform between solids, so nothing is carried along by advection.
/// Pressures are distributed over the ranks; the few velocities are kept on every rank. Of the side
/// interfaces it has one, so that its runs audit their momentum. As always in 2D here, masses and
/// forces are those of a metre of depth: kg/m, N/m.
class ColumnFluid : public lockstep::FluidDiscretization<2>, public lockstep::AuditedFluid<2> {
 public:
  struct Options {
    int n_cells = 20;
    double length = 2;      ///< along x, from 0 [m]
    double width = 0.5;     ///< across, from y = 0 [m]
    double density = 1000;  ///< [kg/m^3]
    double gravity = 0;     ///< along x [m/s^2]
  };
  ColumnFluid(const Options& options, const lockstep::Communicator& comm);

  std::string name() const override { return "column"; }
  const lockstep::AuditedFluid<2>* audit() const override { return this; }
  void save(lockstep::CheckpointWriter& checkpoint) const override;
  void load(const lockstep::CheckpointReader& checkpoint) override;
  const std::vector<double>& predicted() const { return predicted_; }  ///< u* at the faces [m/s]

  void divergence(lockstep::Vector& rhs) const override;
  void project(const lockstep::Vector& scaled_pressure) override;
  std::vector<double> coupled_velocity() const override;
  void set_coupled_velocity(const std::vector<double>& velocity) override;

  void begin_prediction() override { predicted_ = velocity_; }
  lockstep::ForceImpulse<2> add_forces(double time, double dt) override;
  void advect(double, double, const lockstep::MovingSurface<2>&) override {
    predicted_ = velocity_;
  }
  void accept() override { velocity_ = predicted_; }

  double smallest_length() const override { return h_; }
  double largest_speed() const override;
  lockstep::Point<2> gravity() const override { return {options_.gravity, 0}; }
  lockstep::Momentum<2> momentum() const override;
  double kinetic_energy() const override;
  lockstep::Momentum<2> boundary_pressure_impulse(const lockstep::Vector&) const override {
    return {};  // the open ends have p = 0, and the pressure on the long walls cancels
  }

 private:
  const lockstep::FluidGeometry<2>& freeze(const Surface& surface,
                                           const lockstep::OpenFractionRule<2>& rule) override;
  bool is_free(int face) const { return coupled_at_[face] == 0; }
  lockstep::ControlVolume<2> control_volume(int face) const;
  double mass(int face) const;

  Options options_;
  double h_;
  lockstep::Communicator comm_;
  std::vector<double> velocity_, predicted_;  ///< velocities of all faces, 0 at x = 0
  std::vector<char> coupled_at_;              ///< per face
  lockstep::FluidGeometry<2>
      frozen_;  ///< geometry with the coupled volumes whose lower cell is here
};
