#include "mac/pressure/carried_pressure.hpp"

#include <gtest/gtest.h>

#include "mac_cases.hpp"

namespace lockstep::test {
namespace {

/// A ball in fluid whose pressure is `at_rest` . x + `of_ball` . x, and what becomes of it as the
/// ball moves.
template <int dim>
struct Ball {
  explicit Ball(const Point<dim>& way_of_ball) : way(way_of_ball) {
    Solids<dim> first, then;
    first.add(ball_surface<dim>(radius, h), center, true);
    then.add(ball_surface<dim>(radius, h), center + way, true);
    before = first.snapshot();
    after = then.snapshot();
    const TiledGrid<dim>& grid = fluid->domain().grid;
    cells.assign(grid.n_stored_cells(), CellState::outside);
    pressure.assign(grid.n_stored_cells(), 0.0);
    grid.for_each_stored_cell([&](int cell) {
      const bool is_solid = before->inside(grid.center(cell)) >= 0;
      cells[cell] = is_solid ? CellState::solid : CellState::fluid;
      pressure[cell] = is_solid ? 1e3 : (at_rest + of_ball).dot(grid.center(cell));
    });
  }
  void carry() {
    const auto velocity = [this](const SurfacePoint<dim>&) { return Point<dim>(way / step); };
    carry_pressure<dim>(fluid->domain(), {before, after, velocity}, {at_rest, inertia, 0}, cells,
                        pressure);
  }
  /// Distance of the box around the ball in its new place [m].
  double distance(const Point<dim>& x) const { return after->own_bounds(0).exteriorDistance(x); }

  static constexpr int n = 32;
  static constexpr double h = 1. / n, radius = 0.13, step = 0.1;
  double inertia = 1e3;  ///< much: nothing is bounded
  Point<dim> way, center = Point<dim>::Constant(0.51);
  Point<dim> at_rest = Point<dim>::LinSpaced(2, -3), of_ball = Point<dim>::LinSpaced(-5, 4);
  std::unique_ptr<MacFluid<dim>> fluid = Case<dim>(cube<dim>(n), h).make();
  std::shared_ptr<const SurfaceSnapshot<dim>> before, after;
  std::vector<CellState> cells;
  CellField pressure;
};

/// A linear pressure is carried exactly, by a way that falls off with the distance from the ball;
/// what the ball leaves has a pressure, and what is far off has its own.
template <int dim>
void expect_carried() {
  Ball<dim> ball(Point<dim>::LinSpaced(0.6, -0.8) * Ball<dim>::h);
  ball.carry();
  const TiledGrid<dim>& grid = ball.fluid->domain().grid;
  const double reach = ball.after->own_bounds(0).sizes().maxCoeff();
  int n_near = 0, n_far = 0;
  grid.for_each_owned_cell([&](int cell) {
    const Point<dim> x = grid.center(cell);
    const double part = std::max(0.0, 1 - ball.distance(x) / reach);
    const double expected = ball.at_rest.dot(x) + ball.of_ball.dot(x - part * ball.way);
    const double from_surface = (x - ball.center).norm() - ball.radius;
    if (from_surface > 4 * ball.h) {
      EXPECT_NEAR(ball.pressure[cell], expected, 1e-12) << x.transpose();
      n_near += part > 0;
      n_far += part == 0;
    } else if (std::abs(from_surface) < ball.h) {
      EXPECT_NEAR(ball.pressure[cell], expected, 6 * ball.h * ball.of_ball.norm());
      EXPECT_EQ(ball.cells[cell], CellState::fluid);
    }
  });
  EXPECT_GT(sum_all(world(), static_cast<GlobalIndex>(n_near)), 100);
  EXPECT_GT(sum_all(world(), static_cast<GlobalIndex>(n_far)), 100);
}
TEST(CarriedPressure, GoesAlongWithABall2D) {
  expect_carried<2>();
}
TEST(CarriedPressure, GoesAlongWithABall3D) {
  expect_carried<3>();
}

TEST(CarriedPressure, FluidAtRestIsLeftAlone) {
  Ball<2> ball(Point<2>(0.7, 0.4) * Ball<2>::h);
  ball.at_rest += ball.of_ball;
  ball.carry();
  const TiledGrid<2>& grid = ball.fluid->domain().grid;
  grid.for_each_owned_cell([&](int cell) {
    const Point<2> x = grid.center(cell);
    if (ball.cells[cell] == CellState::fluid) {
      EXPECT_NEAR(ball.pressure[cell], ball.at_rest.dot(x), 1e-12) << x.transpose();
    }
  });
}

TEST(CarriedPressure, NoPressureChangesByMoreThanMotionMakes) {
  Ball<2> ball(Point<2>(0.6, -0.8) * Ball<2>::h);
  ball.inertia = 0.2;
  const CellField before = ball.pressure;
  const std::vector<CellState> cells = ball.cells;
  ball.carry();
  const double speed = Ball<2>::h / Ball<2>::step, most = 0.2 * speed * speed;
  double largest = 0;
  ball.fluid->domain().grid.for_each_owned_cell([&](int cell) {
    if (cells[cell] == CellState::fluid)
      largest = std::max(largest, std::abs(ball.pressure[cell] - before[cell]));
  });
  EXPECT_NEAR(max_all(world(), largest), most, 1e-12);
  EXPECT_LT(most, 0.2 * ball.of_ball.norm() * Ball<2>::h);
}

TEST(CarriedPressure, NothingGoesAlongWithABallThatStays) {
  Ball<2> ball(Point<2>(0, 0));
  const CellField pressure = ball.pressure;
  const std::vector<CellState> cells = ball.cells;
  ball.carry();
  EXPECT_EQ(ball.pressure, pressure);
  EXPECT_EQ(ball.cells, cells);
}

}  // namespace
}  // namespace lockstep::test
