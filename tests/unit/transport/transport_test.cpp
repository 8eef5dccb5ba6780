#include "transport/transport.hpp"

#include "transport_cases.hpp"

namespace lockstep::test {
namespace {

const double two_pi = 2 * std::acos(-1.0);

/// Different in every component, no symmetry, largest component 1.
template <int dim>
Point<dim> swirl(const Point<dim>& x) {
  Point<dim> u;
  for (int a = 0; a < dim; ++a)
    u[a] = std::sin(two_pi * x[(a + 1) % dim] + a) * std::cos(two_pi * x[a] + 0.3);
  return u;
}

template <int dim>
void expect_constant(bool periodic, double cfl) {
  FullTank<dim> tank(cube<dim>(16, periodic), world());
  tank.set_velocity(swirl<dim>);
  for (const AdvectionScheme scheme : all_schemes) {
    Transport<dim> transport(tank.setting(cfl * tank.grid.spacing()));
    const CellField s = tank.cells([](const Point<dim>&) { return 0.1; });
    CellField carried;
    transport.advect_scalar(scheme, s, {}, carried);
    tank.grid.for_each_owned_cell([&](int c) { ASSERT_EQ(carried[c], 0.1); });
    FaceField<dim> u, moved;
    for (int a = 0; a < dim; ++a)
      u[a] = tank.faces(a, [a](const Point<dim>&) { return 0.3 + a; });
    transport.advect_faces(scheme, u, moved);
    for (int a = 0; a < dim; ++a)
      tank.grid.for_each_owned_face(a, [&](int c) { ASSERT_EQ(moved[a][c], 0.3 + a); });
  }
}

/// Values that are the same all over each side.
SideValues<2> side_values(double x_lower, double x_upper, double y_lower, double y_upper) {
  const auto all_over = [](double value) { return [value](const Point<2>&) { return value; }; };
  return {{{all_over(x_lower), all_over(x_upper)}, {all_over(y_lower), all_over(y_upper)}}};
}

TEST(Transport, KeepsConstantsExactly) {
  for (const double cfl : {0.7, 5.0, 50.0}) {
    expect_constant<2>(true, cfl);
    expect_constant<2>(false, cfl);
    expect_constant<3>(true, cfl);
    expect_constant<3>(false, cfl);
  }
}

/// Mean error at time 1/4 in the flow (1, sin(2 pi x)): paths are x = x0 + t, y = y0 + (cos(2 pi
/// x0) - cos(2 pi x)) / (2 pi).
double error_in_shear(AdvectionScheme scheme, int n) {
  FullTank<2> tank(cube<2>(n, true), world());
  tank.set_velocity([](const Point<2>& x) { return Point<2>(1, std::sin(two_pi * x[0])); });
  const auto start = [](double x, double y) { return std::sin(two_pi * x) * std::cos(two_pi * y); };
  const double end_time = 0.25;
  const int n_steps = 3 * n / 8;
  CellField s = tank.cells([&](const Point<2>&x) { return start(x[0], x[1]); }), next;
  Transport<2> transport(tank.setting(end_time / n_steps));
  for (int i = 0; i < n_steps; ++i) {
    transport.advect_scalar(scheme, s, {}, next);
    s.swap(next);
  }
  double error = 0;
  tank.grid.for_each_owned_cell([&](int c) {
    const Point<2> x = tank.grid.center(c);
    const double x0 = x[0] - end_time;
    const double y0 = x[1] - (std::cos(two_pi * x0) - std::cos(two_pi * x[0])) / two_pi;
    error += std::abs(s[c] - start(x0, y0)) / (n * n);
  });
  return sum_all(tank.grid.comm(), error);
}

TEST(Transport, SemiLagrangianIsFirstOrderAndMacCormackSecond) {
  const auto order = [](AdvectionScheme scheme) {
    return std::log2(error_in_shear(scheme, 48) / error_in_shear(scheme, 96));
  };
  EXPECT_NEAR(order(AdvectionScheme::semi_lagrangian), 1, 0.15);
  EXPECT_NEAR(order(AdvectionScheme::maccormack), 2, 0.2);
}

/// Mean error of a wave carried once through the box by a uniform stream, a third of a cell a step.
double error_in_stream(AdvectionScheme scheme, int n) {
  FullTank<2> tank(cube<2>(n, true), world());
  tank.set_velocity([](const Point<2>&) { return Point<2>(1, 0.5); });
  const auto wave = [](const Point<2>& x) {
    return std::sin(two_pi * x[0]) * std::cos(two_pi * x[1] + 0.2);
  };
  const CellField start = tank.cells(wave);
  CellField s = start, next;
  Transport<2> transport(tank.setting(2. / (6 * n)));
  for (int i = 0; i < 6 * n; ++i) {
    transport.advect_scalar(scheme, s, {}, next);
    s.swap(next);
  }
  double error = 0;
  tank.grid.for_each_owned_cell([&](int c) { error += std::abs(s[c] - start[c]) / (n * n); });
  return sum_all(tank.grid.comm(), error);
}

TEST(Transport, CubicsDampLeast) {
  const double cubic = error_in_stream(AdvectionScheme::cubic, 32);
  EXPECT_LT(cubic, 0.1 * error_in_stream(AdvectionScheme::maccormack, 32));
  EXPECT_NEAR(std::log2(error_in_stream(AdvectionScheme::cubic, 16) / cubic), 3, 0.2);
  // In the shear what the midpoint rule makes of the rays is left, of second order.
  EXPECT_LT(error_in_shear(AdvectionScheme::cubic, 48),
            0.5 * error_in_shear(AdvectionScheme::maccormack, 48));
}

/// Fields beside a side are advected by parabolas of samples inside: exact where the field is one.
TEST(Transport, CubicsKeepParabolasBesideSides) {
  GridDescription<2> description = cube<2>(16, false);
  FullTank<2> tank(description, world());
  tank.set_velocity([](const Point<2>&) { return Point<2>(0, 1); });
  const auto parabola = [](const Point<2>& x) { return x[0] * x[0] + x[1] * (2 - x[1]); };
  for (const double cfl : {0.4, 7.7}) {  // by rows, and one by one
    const double dt = cfl / 16;
    Transport<2> transport(tank.setting(dt));
    CellField carried;
    transport.advect_scalar(AdvectionScheme::cubic, tank.cells(parabola), {}, carried);
    tank.grid.for_each_owned_cell([&](int c) {
      const Point<2> x = tank.grid.center(c);
      const double from = std::max(x[1] - dt, 0.5 / 16);
      const double expected = parabola({x[0], from});
      ASSERT_NEAR(carried[c], expected, 1e-13) << x.transpose();
    });
  }
}

/// Carries a scalar and the velocity itself and compares with the same on a grid of one rank.
template <int dim>
void expect_same_as_alone(bool periodic, double cfl) {
  FullTank<dim> tank(cube<dim>(dim == 2 ? 64 : 24, periodic), world());
  FullTank<dim> serial(tank.grid.description(), alone());
  tank.set_velocity(swirl<dim>);
  serial.set_velocity(swirl<dim>);
  const auto f = [](const Point<dim>& x) { return std::sin(7 * x[0]) + x[1] * x[dim - 1]; };
  const double dt = cfl * tank.grid.spacing();
  for (const AdvectionScheme scheme : all_schemes) {
    Transport<dim> transport(tank.setting(dt)), expected(serial.setting(dt));
    CellField s, s_alone;
    transport.advect_scalar(scheme, tank.cells(f), {}, s);
    expected.advect_scalar(scheme, serial.cells(f), {}, s_alone);
    const auto other = [&](int c) { return serial.grid.cell_of_global_id(tank.grid.global_id(c)); };
    tank.grid.for_each_owned_cell([&](int c) { ASSERT_NEAR(s[c], s_alone[other(c)], 1e-14); });
    FaceField<dim> u, u_alone;
    transport.advect_faces(scheme, tank.velocity, u);
    expected.advect_faces(scheme, serial.velocity, u_alone);
    for (int a = 0; a < dim; ++a)
      tank.grid.for_each_owned_face(
          a, [&](int c) { ASSERT_NEAR(u[a][c], u_alone[a][other(c)], 1e-14); });
  }
}

TEST(Transport, DoesNotDependOnTheNumberOfRanks) {
  for (const double cfl : {1.3, 5.0, 30.0})
    for (const bool periodic : {true, false}) {
      expect_same_as_alone<2>(periodic, cfl);
      expect_same_as_alone<3>(periodic, cfl);
    }
}

/// Neither stale samples beyond the halo nor a halo that an earlier step made wider change a bit: a
/// run that goes on from a checkpoint has neither.
template <int dim>
void expect_no_history(double cfl) {
  const int n = dim == 2 ? 17 : 9;  // the last tile has one cell along each axis
  FullTank<dim> tank(cube<dim>(n, true), world()), used(tank.grid.description(), world());
  tank.set_velocity(swirl<dim>);
  used.set_velocity(swirl<dim>);
  used.ray_halo.require(n);
  const auto spoil = [&](CellField field) {
    for (int c = 0; c < used.grid.n_stored_cells(); ++c)
      if (c >= used.grid.n_owned_cells() || !used.grid.in_domain(c))
        field[c] = 3 * std::sin(1 + 7 * c);
    return field;
  };
  for (CellField& component : used.velocity)
    component = spoil(component);
  const double dt = cfl * tank.grid.spacing();
  for (const AdvectionScheme scheme : all_schemes) {
    Transport<dim> clean(tank.setting(dt)), spoilt(used.setting(dt));
    FaceField<dim> u, other;
    clean.advect_faces(scheme, tank.velocity, u);
    spoilt.advect_faces(scheme, used.velocity, other);
    for (int a = 0; a < dim; ++a)
      tank.grid.for_each_owned_face(a, [&](int c) { ASSERT_EQ(u[a][c], other[a][c]); });
    const CellField start = tank.cells([](const Point<dim>& x) { return std::sin(7 * x[0]); });
    CellField s, s_other;
    clean.advect_scalar(scheme, start, {}, s);
    spoilt.advect_scalar(scheme, spoil(start), {}, s_other);
    tank.grid.for_each_owned_cell([&](int c) { ASSERT_EQ(s[c], s_other[c]); });
  }
}

TEST(Transport, DoesNotDependOnEarlierSteps) {
  for (const double cfl : {0.4, 1.3, 4.5, 8.0}) {
    expect_no_history<2>(cfl);
    expect_no_history<3>(cfl);
  }
}

/// 16 x 16 cells, open along x, periodic along y.
GridDescription<2> duct() {
  GridDescription<2> description = cube<2>(16, false);
  description.periodic[1] = true;
  description.store_upper_face = {true, false};
  return description;
}

/// Fluid at (1, 4) enters where fluid at (1, 0) flows.
void let_in(FullTank<2>& tank) {
  tank.sides[0][0] = {true, false, [](const Point<2>&) { return Point<2>(1, 4); }};
  tank.set_velocity([](const Point<2>&) { return Point<2>(1, 0); });
}

TEST(Transport, InflowEntersAndLeavesThroughTheOpenSide) {
  FullTank<2> tank(duct(), world());
  let_in(tank);
  CellField s = tank.cells([](const Point<2>&) { return 0; }), next;
  FaceField<2> u = tank.velocity, u_next;
  Transport<2> transport(tank.setting(1.0 / 16));
  const SideValues<2> inflow_values = side_values(3, -1, -1, -1);
  for (int step = 1; step <= 4; ++step) {
    transport.advect_scalar(AdvectionScheme::semi_lagrangian, s, inflow_values, next);
    s.swap(next);
    transport.advect_faces(AdvectionScheme::semi_lagrangian, u, u_next);
    u.swap(u_next);
  }
  // One cell a step: after four steps the inflow fills the first four columns.
  tank.grid.for_each_owned_cell([&](int c) {
    const bool reached = tank.grid.coordinates(c)[0] < 4;
    EXPECT_DOUBLE_EQ(s[c], reached ? 3 : 0);
    EXPECT_DOUBLE_EQ(u[1][c], reached ? 4 : 0);
    EXPECT_DOUBLE_EQ(u[0][c], 1);
  });
}

TEST(Transport, SlowInflowEnters) {
  // A quarter of a cell a step ends between the side and the first samples, half a cell inside.
  FullTank<2> tank(duct(), world());
  let_in(tank);
  for (const AdvectionScheme scheme : all_schemes) {
    CellField s = tank.cells([](const Point<2>&) { return 0; }), next;
    FaceField<2> u = tank.velocity, u_next;
    Transport<2> transport(tank.setting(0.25 / 16));
    for (int step = 0; step < 40; ++step) {
      transport.advect_scalar(scheme, s, side_values(3, -1, -1, -1), next);
      s.swap(next);
      transport.advect_faces(scheme, u, u_next);
      u.swap(u_next);
    }
    std::array<double, 2> entered{};  // a row's sum, over the value of the inflow: cells
    tank.grid.for_each_owned_cell([&](int c) {
      entered[0] += s[c] / 3 / 16;
      entered[1] += u[1][c] / 4 / 16;
      EXPECT_LE(s[c], 3 + 1e-12);
      EXPECT_GE(s[c], -1e-12);
    });
    sum_over_ranks(world(), entered);
    EXPECT_NEAR(entered[0], 10, 0.6);
    EXPECT_NEAR(entered[1], 10, 0.6);
  }
}

TEST(Transport, RangeHoldsBehindWallsAtAnyStep) {
  GridDescription<3> description = cube<3>(12, false);
  description.store_upper_face.fill(false);  // walls: the upper faces are zero
  for (const double cfl : {0.9, 20.0}) {
    FullTank<3> tank(description, world());
    tank.set_velocity([](const Point<3>& x) {
      return Point<3>(x[0] == 0 ? 0 : 1, x[1] == 0 ? 0 : -0.5, x[2] == 0 ? 0 : 0.25);
    });
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < tank.grid.n_stored_cells(); ++c)
        if (tank.grid.in_domain(c) && tank.grid.coordinates(c)[a] == 0)
          tank.state.faces[a][c] = FaceState::prescribed;
    for (const AdvectionScheme scheme : all_schemes) {
      Transport<3> transport(tank.setting(cfl / 12));
      EXPECT_NEAR(transport.largest_displacement(), cfl, 1e-12);
      FaceField<3> u;
      transport.advect_faces(scheme, tank.velocity, u);
      const double low[] = {0, -0.5, 0}, high[] = {1, 0, 0.25};
      for (int a = 0; a < 3; ++a)
        tank.grid.for_each_owned_face(a, [&](int c) {
          EXPECT_GE(u[a][c], low[a] - 1e-15);
          EXPECT_LE(u[a][c], high[a] + 1e-15);
          if (tank.grid.coordinates(c)[a] == 0) {
            EXPECT_EQ(u[a][c], 0);
          }
        });
    }
  }
}

TEST(Transport, RefusesAVelocityThatIsNotANumber) {
  FullTank<2> tank(cube<2>(16, true), world());
  if (is_root(tank.grid.comm()))
    tank.velocity[0][0] = std::nan("");
  EXPECT_THROW(Transport<2>(tank.setting(0.1)), SolveError);
}

}  // namespace
}  // namespace lockstep::test
