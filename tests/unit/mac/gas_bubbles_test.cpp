#include "liquid/gas/gas_bubbles.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

/// A box that sticks out of the upper end of a periodic x moves on: its walls pass over cells at
/// that end and, beyond it, at the lower one. What is said of who follows whom is forgotten there
/// and nowhere else.
template <int dim>
void expect_forgotten(double left_before, double right_before, double shift) {
  const int n = 16;
  const double h = 1.0 / n;
  DomainDescription<dim> description;
  description.grid.spacing = h;
  description.grid.n_cells.fill(n);
  for (auto& side : description.boundary.sides[0])
    side.type = SideType::periodic;
  set_grid_flags(description.boundary, description.grid);
  const MacDomain<dim> domain(description, world());
  GasParameters<dim> parameters;
  parameters.kind = TrappedAir::ideal_gas;
  GasBubbles<dim> gas(domain, parameters, -Point<dim>::Unit(1));
  const CellField phi(domain.grid.n_stored_cells(), h);
  gas.find(find_solid_cells<dim>(domain, nullptr), phi);
  gas.settle(phi);

  const double width = right_before - left_before, low = 0.26, high = 0.74;
  Point<dim> size = Point<dim>::Constant(high - low), middle = Point<dim>::Constant(0.5);
  size[0] = width;
  middle[0] = left_before + 0.5 * width;
  const auto at = [&](double x) {
    return Solids<dim>()
        .add(box_surface<dim>(size, h), middle + x * Point<dim>::Unit(0), true)
        .snapshot();
  };
  MovingSurface<dim> surface;
  surface.before = at(0);
  surface.after = at(shift);
  gas.pass_over(surface);

  const CellField& number = *gas.fields()[0].components[0];
  double n_forgotten = 0;
  domain.grid.for_each_owned_cell([&](int cell) {
    const Point<dim> x = domain.grid.center(cell);
    bool beside = true;
    for (int a = 1; a < dim; ++a)
      beside = beside && x[a] > low && x[a] < high;
    const auto passed = [&](double wall) {
      return (x[0] > wall && x[0] < wall + shift) || (x[0] + 1 > wall && x[0] + 1 < wall + shift);
    };
    const bool expected = beside && (passed(left_before) || passed(right_before));
    EXPECT_EQ(number[cell], expected ? 0 : -1) << x.transpose();
    n_forgotten += number[cell] == 0;
  });
  // One layer of cells a wall, 8 cells across.
  EXPECT_EQ(sum_all(world(), n_forgotten), 2 * std::pow(8, dim - 1));
}

TEST(GasBubbles, SurfacesPassOverCellsBeyondAPeriodicSide) {
  expect_forgotten<2>(0.83, 1.02, 0.04);
  expect_forgotten<3>(0.83, 1.02, 0.04);
}

/// A projection finds the pressure in a bubble that it is given with the others, and none of an
/// earlier one.
TEST(GasBubbles, ProjectWithTheirOwnPressureOrNone) {
  Case<2> scene({16, 16}, 1.0 / 16);
  ParameterList& surface = scene.fluid.sublist("Free Surface");
  surface.set("Trapped Air", "ideal gas");
  surface.sublist("Interface").set("Type", "fixed");
  const auto add_box = [&](const std::string& name, const ParameterArray<double>& lower,
                           const ParameterArray<double>& upper) {
    surface.sublist("Liquid")
        .sublist(name)
        .set("Type", "box")
        .set("Lower", lower)
        .set("Upper", upper);
  };
  add_box("below", numbers({-1, -1}), numbers({2, 0.4}));
  add_box("above", numbers({-1, 0.7}), numbers({2, 2}));
  add_box("left", numbers({-1, -1}), numbers({0.3, 2}));
  add_box("right", numbers({0.7, -1}), numbers({2, 2}));
  scene.fluid.set("Gravity", numbers({0, -9.8}));
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  ASSERT_EQ(fluid->gas()->gas_bubbles().size(), 1U);
  const Vector no_pressure(fluid->pressure_map());
  const double pressure = 3, opens = pressure * fluid->gas()->gas_conductance()[0];
  EXPECT_GT(opens, 0);
  fluid->gas()->project(no_pressure, {pressure});
  EXPECT_NEAR(fluid->gas()->gas_rates()[0], opens, 1e-14 * opens);
  fluid->project(no_pressure);
  EXPECT_NEAR(fluid->gas()->gas_rates()[0], opens, 1e-14 * opens);
  fluid->gas()->project(no_pressure, {-pressure});
  EXPECT_NEAR(fluid->gas()->gas_rates()[0], 0, 1e-14 * opens);
}

}  // namespace
}  // namespace lockstep::test
