#pragma once
#include <functional>
#include <vector>

#include "interfaces/energy.hpp"
#include "interfaces/fluid_sides.hpp"
#include "mac/state/mac_flow.hpp"

namespace lockstep {

/// Returns the angular momentum that partly open faces of this rank add, because their fluid moves
/// beside their centres, where all other forces are taken to act.
template <int dim>
AngularVector<dim> moment_of_shifts(const MacGeometry<dim>& geometry,
                                    const std::function<double(int axis, int cell)>& velocity);

/// Momentum and energy of u*. Momentum of free faces counts M = rho V alpha, half of it at open
/// sides. With periodic sides, angular momentum is not conserved: a torque has no common origin
/// there.
template <int dim>
class MacAudit : public AuditedFluid<dim> {
 public:
  explicit MacAudit(const MacFlow<dim>& flow) : flow_(flow) {}

  Momentum<dim> momentum() const override;
  double kinetic_energy() const override;
  Momentum<dim> boundary_pressure_impulse(const Vector& scaled_pressure) const override;

 private:
  const MacFlow<dim>& flow_;
};

/// Keeps u* between what acts on it, while somebody asks for works.
template <int dim>
class MacEnergy : public EnergyFluid<dim> {
 public:
  explicit MacEnergy(const MacFlow<dim>& flow) : flow_(flow) {}

  void begin_works() override { stages_ = {flow_.prediction}; }
  void end_work() override { stages_.push_back(flow_.prediction); }
  std::vector<double> works() override;

 private:
  const MacFlow<dim>& flow_;
  std::vector<FaceField<dim>> stages_;
};

}  // namespace lockstep
