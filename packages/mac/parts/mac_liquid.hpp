#pragma once
#include <string>
#include <vector>

#include "interfaces/liquid.hpp"
#include "mac/parts/mac_drops.hpp"

namespace lockstep {

/// The liquid of a fluid that has a free surface: what others see of it, and what a step does with
/// it.
template <int dim>
class MacLiquid : public LiquidFluid<dim> {
 public:
  /// `flow` has a liquid.
  explicit MacLiquid(MacFlow<dim>& flow) : flow_(flow), liquid_(*flow.liquid) {}

  double surface_distance(const Point<dim>& x) const override { return liquid_.distance(x); }
  std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const override;
  bool in_solid(const Point<dim>& x) const override {
    const auto& surface = flow_.geometry.state.surface;
    return surface && surface->inside(flow_.domain.grid.wrap(x)) >= 0;
  }
  std::vector<WaterLevel> levels_at_solids() const override;
  double gas_density() const override { return liquid_.gas_density(); }
  LiquidReport report() const override { return liquid_.report(); }
  bool traps_gas() const override { return liquid_.gas() != nullptr; }
  bool has_drops() const override { return liquid_.drops() != nullptr; }
  std::vector<SurfaceImpulse<dim>> impulses_on_solids() const override {
    return impulses_of_drops(flow_);
  }
  Momentum<dim> surface_impulse() const override { return flow_.surface_impulse; }
  std::vector<std::string> watch_names() const override { return liquid_.watch_names(); }

  /// Moves the liquid along u_ADV, which is extended into the air as u^n is. Collective.
  void move(double time, double dt, const MovingSurface<dim>& surface, FaceField<dim>& advection);
  /// By surface tension over dt, at the faces' centres. Collective.
  void push_surface(double dt);
  /// Bounds the last step's pressure in cells beside the air. Collective.
  void bound_pressure(CellField& pressure) const;
  StepBound largest_stable_step() const;  ///< Local.

 private:
  MacFlow<dim>& flow_;
  Liquid<dim>& liquid_;
};

}  // namespace lockstep
