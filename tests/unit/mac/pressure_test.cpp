#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <cmath>

#include "mac/pressure/extended_pressure.hpp"
#include "mac_cases.hpp"

namespace lockstep::test {
namespace {

/// Row of A for a cell, as {column: value} on the rank that has it.
double entry(const MacFluid<2>& fluid, const Index<2>& row, const Index<2>& column) {
  const auto matrix = assembled(fluid.pressure_block());
  const auto& grid = fluid.domain().grid;
  const auto unit = make_vector(fluid.pressure_map());
  const auto result = make_vector(fluid.pressure_map());
  const int from = grid.cell(column), to = grid.cell(row);
  if (from >= 0 && grid.owned(from))
    unit->replaceGlobalValue(fluid.geometry().unknown[from], 1.0);
  matrix->apply(*unit, *result);
  double mine = 0;
  if (to >= 0 && grid.owned(to))
    mine = result->getData()[fluid.pressure_map()->getLocalElement(fluid.geometry().unknown[to])];
  return sum_all(grid.comm(), mine);
}

TEST(Pressure, FourByFourByHand) {
  Case<2> scene({4, 4}, 0.25);
  scene.fluid.set("Density", 2.0);
  scene.side("y upper", "open");
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  // V / (rho h^2) = 1/2 for every inner face, 1 for the open ones at distance h/2.
  EXPECT_DOUBLE_EQ(entry(*fluid, {0, 0}, {0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(entry(*fluid, {1, 0}, {1, 0}), 1.5);
  EXPECT_DOUBLE_EQ(entry(*fluid, {1, 1}, {1, 1}), 2.0);
  EXPECT_DOUBLE_EQ(entry(*fluid, {0, 3}, {0, 3}), 2.0);
  EXPECT_DOUBLE_EQ(entry(*fluid, {1, 3}, {1, 3}), 2.5);
  EXPECT_DOUBLE_EQ(entry(*fluid, {1, 1}, {1, 2}), -0.5);
  EXPECT_DOUBLE_EQ(entry(*fluid, {1, 1}, {2, 2}), 0.0);
  EXPECT_EQ(fluid->regions().n_regions, 1);
  EXPECT_TRUE(fluid->regions().has_dirichlet[0]);
  EXPECT_DOUBLE_EQ(fluid->fluid_volume(), 1.0);
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> ball_and_plate(double h) {
  Solids<dim> solids;
  Point<dim> ball = Point<dim>::Constant(0.62), plate = Point<dim>::Constant(0.3);
  Point<dim> size = Point<dim>::Constant(0.45);
  solids.add(ball_surface<dim>(0.171, h), ball, true);
  solids.add(plate_surface<dim>(size, 0, h), plate, false);
  return solids.snapshot();
}

template <int dim>
void expect_symmetric_without_row_sums() {
  Case<dim> scene(cube<dim>(20), 0.05);
  const auto fluid = scene.make();
  fluid->set_geometry(ball_and_plate<dim>(0.05), BlockedFaces<dim>());
  const auto x = pressure_vector<dim>(*fluid, wavy<dim>);
  Vector without_matrix(x->getMap());
  apply(*fluid->pressure_block(), *x, without_matrix);
  const auto matrix = assembled(fluid->pressure_block());
  const auto y = pressure_vector<dim>(
      *fluid, [](const Point<dim>& p) { return wavy<dim>(Point<dim>(3 * p)) - 0.2; });
  Vector ax(x->getMap()), ay(x->getMap()), one(x->getMap()), a_one(x->getMap());
  one.putScalar(1);
  matrix->apply(*x, ax);
  matrix->apply(*y, ay);
  matrix->apply(one, a_one);
  without_matrix.update(-1, ax, 1);
  EXPECT_LT(without_matrix.normInf(), 1e-15 * matrix->getFrobeniusNorm() * x->normInf());
  EXPECT_NEAR(y->dot(ax), x->dot(ay), 1e-12 * std::abs(x->dot(ax)));
  EXPECT_GT(x->dot(ax), 0);
  EXPECT_LT(a_one.normInf(), 1e-15);
}
TEST(Pressure, SymmetricWithoutRowSums2D) {
  expect_symmetric_without_row_sums<2>();
}
TEST(Pressure, SymmetricWithoutRowSums3D) {
  expect_symmetric_without_row_sums<3>();
}

/// The gain of the free faces and of the coupled ones is the impulse of the sides.
template <int dim>
void expect_impulses_telescope() {
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Density", 3.0);
  scene.side("x lower", "inflow", Point<dim>::Unit(0)).side("x upper", "open");
  scene.side("y lower", "open").side("y upper", "inflow", Point<dim>(-Point<dim>::Unit(1)));
  const auto fluid = scene.make();
  fluid->set_geometry(ball_and_plate<dim>(0.05), BlockedFaces<dim>());
  const auto pressure = pressure_vector<dim>(*fluid, wavy<dim>);
  fluid->begin_prediction();
  const Momentum<dim> before = fluid->audit()->momentum();
  fluid->project(*pressure);
  Momentum<dim> gained = fluid->audit()->momentum() - before;
  Momentum<dim> coupled;
  for (const ControlVolume<dim>& volume : fluid->coupled_volumes()) {
    double jump = 0;
    for (int end = 0; end < 2; ++end)
      if (volume.sides[end].unknown != no_index)
        jump += (end == 0 ? -1 : 1) * wavy<dim>(volume.sides[end].center);
    coupled.add(volume.center, volume.direction, -volume.area * jump);
  }
  EXPECT_GT(fluid->domain().grid.comm()->getSize() + fluid->coupled_volumes().size(), 1u);
  gained += sum_over_ranks(coupled, fluid->domain().grid.comm());
  const Momentum<dim> given = fluid->audit()->boundary_pressure_impulse(*pressure);
  EXPECT_LT((gained.linear - given.linear).norm(), 1e-13) << given.linear.transpose();
  EXPECT_LT((gained.angular - given.angular).norm(), 1e-13) << given.angular.transpose();
  EXPECT_GT(given.linear.norm(), 0.1);
}
TEST(Pressure, ImpulsesTelescope2D) {
  expect_impulses_telescope<2>();
}
TEST(Pressure, ImpulsesTelescope3D) {
  expect_impulses_telescope<3>();
}

/// Largest error of A p = V f for p = cos(pi x) cos(pi y), with x open: sin(pi x) cos(pi y).
double poisson_error(int n, bool open) {
  const double h = 1.0 / n;
  Case<2> scene({n, n}, h);
  scene.fluid.set("Density", 2.0);
  if (open)
    scene.side("x lower", "open").side("x upper", "open");
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const auto exact = pressure_vector<2>(*fluid, [open](const Point<2>& x) {
    return (open ? std::sin(M_PI * x[0]) : std::cos(M_PI * x[0])) * std::cos(M_PI * x[1]);
  });
  Vector rhs(*exact, Teuchos::Copy), solution(exact->getMap());
  rhs.scale(h * h * 2 * M_PI * M_PI / 2.0);
  const auto matrix = assembled(fluid->pressure_block());
  conjugate_gradients([&](const Vector& x, Vector& y) { matrix->apply(x, y); }, rhs, solution,
                      1e-11);
  solution.update(-1, *exact, 1);
  return solution.normInf();
}
TEST(Pressure, PoissonIsOfOrderTwo) {
  for (const bool open : {false, true}) {
    const double coarse = poisson_error(16, open), fine = poisson_error(32, open);
    EXPECT_LT(fine, 2e-3);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15) << "open " << open;
  }
}

TEST(Pressure, DivergenceCountsInflowAndSkipsCoupledFaces) {
  Case<2> scene({4, 4}, 0.25);
  scene.side("x lower", "inflow", Point<2>(2, 0)).side("x upper", "open");
  const auto fluid = scene.make();
  // A plate across the channel between the second and third column.
  Solids<2> solids;
  solids.add(plate_surface<2>(Point<2>(0, 2), 0, 0.25), Point<2>(0.5, 0.5), false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  fluid->begin_prediction();
  const auto rhs = make_vector(fluid->pressure_map());
  fluid->divergence(*rhs);
  const auto expected =
      pressure_vector<2>(*fluid, [](const Point<2>& x) { return x[0] < 0.25 ? 2 * 0.25 : 0.0; });
  rhs->update(-1, *expected, 1);
  EXPECT_LT(rhs->normInf(), 1e-15);
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(fluid->coupled_volumes().size())), 4);
  EXPECT_EQ(fluid->regions().n_regions, 2);
}

/// A fluid at rest: cells two layers deep get its pressure back.
TEST(Pressure, IsCarriedOnToCellsThatSolidsLeft) {
  Case<2> scene({12, 12}, 0.25);
  const auto fluid = scene.make();
  const MacDomain<2>& domain = fluid->domain();
  const Point<2> gradient(2, -3);
  const int n = domain.grid.n_stored_cells();
  std::vector<CellState> now(n, CellState::outside), before = now;
  CellField pressure(n, 0.0);
  domain.grid.for_each_stored_cell([&](int cell) {
    const Point<2> x = domain.grid.center(cell);
    now[cell] = CellState::fluid;
    const bool was_solid = (x - Point<2>(1.5, 1.5)).cwiseAbs().maxCoeff() < 0.7;  // 5 x 5 or more
    before[cell] = was_solid ? CellState::solid : CellState::fluid;
    pressure[cell] = was_solid ? 1e3 : 7 + gradient.dot(x);
  });
  const CellField result = extended_pressure<2>(domain, now, before, pressure, gradient);
  // In a gas of a tenth of the density the gradient is that of a liquid ten times as heavy.
  const std::vector<float> lightness(now.size(), 10);
  const CellField in_gas =
      extended_pressure<2>(domain, now, before, pressure, 10 * gradient, lightness);
  int n_new = 0;
  domain.grid.for_each_owned_cell([&](int cell) {
    n_new += before[cell] == CellState::solid;
    EXPECT_NEAR(result[cell], 7 + gradient.dot(domain.grid.center(cell)), 1e-12);
    EXPECT_NEAR(in_gas[cell], result[cell], 1e-12);
  });
  EXPECT_GE(sum_all(world(), static_cast<GlobalIndex>(n_new)), 25);
}

}  // namespace
}  // namespace lockstep::test
