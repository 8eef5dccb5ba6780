#pragma once
#include <memory>

#include "interfaces/viscosity.hpp"
#include "mac/state/mac_flow.hpp"

namespace lockstep {

/// The viscous solve of a fluid. Implicit surface tension wants it, too.
template <int dim>
class MacViscosity : public ViscousFluid<dim> {
 public:
  explicit MacViscosity(MacFlow<dim>& flow) : flow_(flow) {}

  /// False: there is never anything to solve.
  bool acts() const {
    return flow_.parameters.viscosity.viscosity > 0 || flow_.tension_is_implicit();
  }
  bool wants_present_pressure() const override { return flow_.tension_is_implicit(); }
  std::unique_ptr<ViscousSystem<dim>> viscous_system() const override {
    return viscosity_ ? viscosity_->system(flow_.prediction, flow_.time) : nullptr;
  }
  Momentum<dim> accept_viscous(const Vector& solution, const Vector& velocity, double dt) override;

  void forget() { viscosity_.reset(); }  ///< the geometry is about to change
  void renew();                          ///< for the frozen geometry. Collective.
  void renew_tension(double dt);         ///< for forces over dt. Collective.

 private:
  MacFlow<dim>& flow_;
  std::unique_ptr<Viscosity<dim>> viscosity_;
};

}  // namespace lockstep
