#pragma once
#include <memory>

#include "mac/parts/mac_audit.hpp"
#include "mac/parts/mac_gas.hpp"
#include "mac/parts/mac_liquid.hpp"
#include "mac/parts/mac_output.hpp"
#include "mac/parts/mac_tiles.hpp"
#include "mac/parts/mac_viscosity.hpp"
#include "mac/transport/interface_transport.hpp"

namespace lockstep {

/// A fluid of one phase or two on a staggered Cartesian grid of tiles. Every cell whose centre is
/// not inside a closed solid is fluid, or air where it is above a free surface.
///
/// The time of walls and inflows that ramp up is that of the last `add_forces`, time + dt.
template <int dim>
class MacFluid : public FluidDiscretization<dim> {
 public:
  using typename FluidDiscretization<dim>::Surface;

  /// Collective. Validated lists "Fluid" and "Domain" of a scene.
  MacFluid(const ParameterList& fluid, const ParameterList& domain, const Communicator& comm,
           const InterfaceRegistry<dim>* interfaces = nullptr);

  std::string name() const override { return "mac"; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;

  const AuditedFluid<dim>* audit() const override { return &audit_; }
  EnergyFluid<dim>* energy() const override { return energy_.get(); }
  GasFluid<dim>* gas() override { return gas_.get(); }
  const LiquidFluid<dim>* liquid() const override { return liquid_.get(); }
  const FluidOutput<dim>* output() const override { return &output_; }
  ViscousFluid<dim>* viscosity() override { return viscosity_.acts() ? &viscosity_ : nullptr; }

  void divergence(Vector& rhs) const override;
  void project(const Vector& scaled_pressure) override;
  std::vector<double> coupled_velocity() const override;
  /// Partly open volumes keep their own velocity.
  void set_coupled_velocity(const std::vector<double>& velocity) override;

  bool begin_step(double time, double dt, const std::function<double()>& solid_speed) override;
  void begin_prediction() override { flow_.prediction = flow_.velocity; }
  void take_kicks() override { flow_.take_kicks(); }
  bool begin_advection_velocity(double dt) override;
  ForceImpulse<dim> add_forces(double time, double dt) override;
  void advect(double time, double dt, const MovingSurface<dim>& surface) override;
  void populate_uncovered(const MovingSurface<dim>& surface) override;
  RCP<Vector> last_scaled_pressure() const override;
  void correct_pressure(const Vector& inflow) override;
  void accept() override;

  double smallest_length() const override { return flow_.domain.spacing(); }
  double largest_speed() const override { return flow_.largest_speed(); }
  StepBound largest_stable_step() const override {
    return liquid_ ? liquid_->largest_stable_step() : StepBound{};
  }
  bool geometry_changes() const override { return liquid_ != nullptr; }
  Point<dim> gravity() const override { return flow_.parameters.forces.gravity; }
  double density(const Point<dim>&) const override { return flow_.parameters.density; }
  Box<dim> bounds() const override { return flow_.domain.bounds(); }
  std::array<std::array<bool, 2>, dim> closed_sides() const override;
  Point<dim> wall_velocity(int axis, int end, double time) const override;
  std::array<bool, dim> periodic_axes() const override;
  std::vector<PrescribedFlux> side_fluxes(double time) const override;

  const MacDomain<dim>& domain() const { return flow_.domain; }
  const MacGeometry<dim>& geometry() const { return flow_.geometry; }
  /// u* on stored faces.
  const FaceField<dim>& prediction() const { return flow_.prediction; }
  const Scalars<dim>& scalars() const { return flow_.scalars; }
  /// Sets u* on owned faces that are free to f(face centre). Collective.
  void set_prediction(const std::function<Point<dim>(const Point<dim>&)>& velocity);

 private:
  const FluidGeometry<dim>& freeze(const Surface& surface,
                                   const OpenFractionRule<dim>& rule) override;
  /// True if a prescribed velocity jumped in the step that ends now.
  bool jumped() const;
  Momentum<dim> push_sources(double time);
  /// u* += dt f; the change of momentum of free faces, of this rank.
  Momentum<dim> damp(double time, double dt);
  Momentum<dim> push_faces(const ForceField<dim>& force, double dt);
  /// Surface tension, and the viscous solve of its implicit part. Collective.
  void push_surface(double dt);
  TransportSetting<dim> transport_setting(double time, double dt, const MovingSurface<dim>& surface,
                                          const FaceField<dim>& advection);
  void advect_scalars(double time, Transport<dim>& transport);

  MacFlow<dim> flow_;
  MacTiles<dim> tiles_;
  MacAudit<dim> audit_;
  MacViscosity<dim> viscosity_;
  MacOutput<dim> output_;
  std::unique_ptr<MacEnergy<dim>> energy_;
  std::unique_ptr<MacLiquid<dim>> liquid_;  ///< null: no free surface
  std::unique_ptr<MacGas<dim>> gas_;        ///< null: none is ever trapped
  bool has_begun_ = false;                  ///< with a geometry: sinks may empty it later
  InvalidSamples<dim> invalid_;             ///< samples without a value after the last transport
  std::vector<CarriedMass> carried_;        ///< by it, near the interface of two phases
};

}  // namespace lockstep
