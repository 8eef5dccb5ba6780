#pragma once
#include "liquid/common/interface_model.hpp"
#include "mac_cases.hpp"

namespace lockstep::test {

/// A liquid whose surface is where a test says.
template <int dim>
class FixedInterface : public InterfaceModel<dim> {
 public:
  using typename InterfaceModel<dim>::Surface;

  explicit FixedInterface(const MacDomain<dim>& domain) : domain_(domain) {}
  std::string name() const override { return "fixed"; }
  void initialise(const SignedDistance<dim>& distance, const Surface&) override {
    const TiledGrid<dim>& grid = domain_.grid;
    distance_.assign(grid.n_stored_cells(), 1e9);
    grid.for_each_stored_cell(
        [&](int cell) { distance_[cell] = steepness * distance(grid.center(cell)); });
  }
  static inline double steepness = 1;  ///< steepness of phi; it is no distance if not 1
  void advance(const InterfaceStep<dim>&) override {}
  const CellField& distance() const override { return distance_; }
  int band(double) const override { return 4; }
  LiquidLedger ledger() const override {
    LiquidLedger ledger;
    ledger.volume = 1;
    return ledger;
  }

 private:
  const MacDomain<dim>& domain_;
  CellField distance_;
};

template <int dim>
InterfaceRegistry<dim> fixed_interfaces() {
  InterfaceRegistry<dim> interfaces("interface model");
  interfaces.add(
      "fixed", "Does not move.", [] { return ParameterList(); },
      [](const ParameterList&, const MacDomain<dim>& domain) {
        return std::make_unique<FixedInterface<dim>>(domain);
      });
  return interfaces;
}

/// A fluid with a list "Free Surface" that the scene's fluid already has.
template <int dim>
std::unique_ptr<MacFluid<dim>> make_liquid(
    Case<dim>& scene, const InterfaceRegistry<dim>& interfaces = fixed_interfaces<dim>()) {
  validate(scene.fluid, mac_parameters<dim>(&interfaces), Source{"test", {}}, "Fluid");
  validate(scene.domain, domain_parameters<dim>(), Source{"test", {}}, "Domain");
  return std::make_unique<MacFluid<dim>>(scene.fluid, scene.domain, world(), &interfaces);
}

/// The pressure that takes the divergence from u*, which it changes.
template <int dim>
RCP<Vector> solve_and_project(MacFluid<dim>& fluid) {
  const auto rhs = make_vector(fluid.pressure_map()), pressure = make_vector(fluid.pressure_map());
  fluid.divergence(*rhs);
  const auto multiply = [&](const Vector& x, Vector& y) { apply(*fluid.pressure_block(), x, y); };
  conjugate_gradients(multiply, *rhs, *pressure, 1e-14);
  fluid.project(*pressure);
  return pressure;
}

template <int dim>
ParameterArray<double> components(const Point<dim>& x) {
  return ParameterArray<double>(x.data(), x.data() + dim);
}

/// All below a height, measured against gravity.
template <int dim>
void add_level(Case<dim>& scene, double height) {
  ParameterList& level = scene.fluid.sublist("Free Surface").sublist("Liquid").sublist("water");
  level.set("Type", "level").set("Height", height);
}
template <int dim>
void add_ball(Case<dim>& scene, const Point<dim>& center, double radius) {
  ParameterList& ball = scene.fluid.sublist("Free Surface").sublist("Liquid").sublist("blob");
  ball.set("Type", "ball").set("Radius", radius);
  ball.set("Center", ParameterArray<double>(center.data(), center.data() + dim));
}

}  // namespace lockstep::test
