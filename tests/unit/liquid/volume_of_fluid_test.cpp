// The fraction of each cell that is liquid, and the planes it stands for.
#include <gtest/gtest.h>

#include <random>

#include "base/errors.hpp"
#include "bath.hpp"
#include "geometry/generators.hpp"
#include "liquid/fractions/cell_plane.hpp"
#include "liquid/fractions/volume_of_fluid.hpp"

namespace lockstep::test {
namespace {

const std::string model_name = "volume of fluid";

template <int dim>
void expect_planes() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 300; ++i) {
    Point<dim> normal;
    for (int a = 0; a < dim; ++a)
      normal[a] = std::pow(uniform(random), i % 4 * 2 + 1);  // some of them nearly along an axis
    const double fraction = 0.5 + 0.5 * uniform(random);
    const CellPlane<dim> plane = plane_of_fraction<dim>(normal, fraction);
    EXPECT_NEAR(plane.normal.template lpNorm<1>(), 1, 1e-14);
    EXPECT_NEAR(fraction_below(plane), fraction, 1e-9) << normal.transpose();
    // The slabs on both sides of a cut are the whole, and each is what samples find.
    const int axis = i % dim;
    const double width = 0.5 + 0.5 * uniform(random);
    const double low = liquid_in_slab(plane, axis, 0, width);
    // Slopes of less than 1e-6 count as none.
    EXPECT_NEAR(low + liquid_in_slab(plane, axis, 1, 1 - width), fraction, 1e-6);
    int n_wet = 0;
    constexpr int n = 4000;
    for (int k = 0; k < n; ++k) {
      Point<dim> x;
      for (int a = 0; a < dim; ++a)
        x[a] = (0.5 + 0.5 * uniform(random)) * (a == axis ? width : 1);
      n_wet += plane.normal.dot(x) < plane.constant;
    }
    EXPECT_NEAR(low, width * n_wet / n, 0.04 * width);
  }
}

TEST(CellPlane, CutsOffItsFraction) {
  expect_planes<2>();
  expect_planes<3>();
}

/// phi of a tilted plane is its distance.
template <int dim>
void expect_plane_is_found() {
  Bath<dim> bath(open_cube<dim>(20));
  auto model = bath.make(model_name);
  Point<dim> normal = Point<dim>::Constant(0.3);
  normal[dim - 1] = 1;
  normal.normalize();
  const SignedDistance<dim> plane = [&](const Point<dim>& x) { return normal.dot(x) - 0.537; };
  model->initialise(plane, nullptr);
  bath.domain.grid.for_each_owned_cell([&](int c) {
    const Point<dim> x = bath.domain.grid.center(c);
    if (std::abs(plane(x)) < 0.05 && (x - Point<dim>::Constant(0.5)).cwiseAbs().maxCoeff() < 0.4) {
      EXPECT_NEAR(model->distance()[c], plane(x), 1e-3) << x.transpose();
    }
  });
}

TEST(VolumeOfFluid, ShowsTheDistanceToAPlane) {
  expect_plane_is_found<2>();
  expect_plane_is_found<3>();
}

/// A box sinks from beside the surface to where there is liquid alone, over several tiles: what it
/// displaces flows around it, and the volume stays, but for what it displaces in a step: its walls
/// pass centres of cells one after the other. The flow is the box's own within a cell of it and
/// ends three cells farther, free of divergence on the grid.
TEST(VolumeOfFluid, ABodySinksFromItsSurfaceIntoTheDeep) {
  constexpr int n = 64, n_steps = 60;
  constexpr double h = 1.0 / n, dt = 0.1, size = 0.101, start = 0.79, end = 0.4;
  Bath<2> bath(closed_cube<2>(n));
  auto model = bath.make(model_name);
  const SurfaceMesh<2> box = box_surface<2>(Point<2>::Constant(size), h);
  const auto height = [&](double step) { return start + (end - start) * step / n_steps; };
  const auto at = [&](int step) { return snapshot<2>(box, Point<2>(0.503, height(step)), true); };
  model->initialise([](const Point<2>& x) { return x[1] - 0.913; }, at(0));
  const double before = model->ledger().volume;
  for (int i = 0; i < n_steps; ++i) {
    const Point<2> middle(0.503, height(i + 0.5));
    const double speed = (end - start) / (n_steps * dt);
    const auto streamfunction = [&](double x, double y) {
      double result = -speed * (x - middle[0]);
      for (const double off : {x - middle[0], y - middle[1]})
        result *= 1 - std::clamp((std::abs(off) - 0.5 * size - h) / (3 * h), 0.0, 1.0);
      return result;
    };
    bath.set_velocity([&](const Point<2>& x) {
      const double r = 0.5 * h;
      return Point<2>((streamfunction(x[0], x[1] + r) - streamfunction(x[0], x[1] - r)) / h,
                      -(streamfunction(x[0] + r, x[1]) - streamfunction(x[0] - r, x[1])) / h);
    });
    bath.move(at(i), at(i + 1), dt);
    bath.step(*model, i * dt, dt);
  }
  EXPECT_NEAR(model->ledger().target, before, 1e-12);
  EXPECT_NEAR(model->ledger().volume, before, size * (start - end) / n_steps);
}

/// Two balls in a flow that tears them up: the volume is that of the start, whatever the step. In
/// one that is not free of divergence too, with what waits for a body that has room.
template <int dim>
void expect_nothing_is_lost(double cfl, bool is_solenoidal) {
  const int n = dim == 2 ? 48 : 20;
  Bath<dim> bath(closed_cube<dim>(n));
  auto model = bath.make(model_name);
  Point<dim> a = Point<dim>::Constant(0.5), b = a;
  a[0] = 0.25;
  b[0] = 0.7;
  model->initialise(
      [&](const Point<dim>& x) { return std::min((x - a).norm() - 0.13, (x - b).norm() - 0.19); },
      nullptr);
  const double start = model->ledger().volume;
  bath.set_velocity([is_solenoidal](const Point<dim>& x) {
    const auto s = [&](int i) { return std::sin(2 * pi * x[i]); };
    const auto c = [&](int i) { return std::cos(2 * pi * x[i]); };
    Point<dim> u = Point<dim>::Zero();
    u[0] = s(0) * c(1);
    u[1] = is_solenoidal ? -c(0) * s(1) : 0.5 * s(1) * c(0);
    return u;
  });
  for (int i = 0; i < 40; ++i) {
    bath.step(*model, 0, cfl / n);
    EXPECT_NEAR(model->ledger().target, start, 1e-14);
    if (is_solenoidal) {
      EXPECT_NEAR(model->ledger().volume, start, 1e-3 * start) << i;
    }
  }
  const auto& vof = dynamic_cast<VolumeOfFluid<dim>&>(*model);
  double all = 0;
  bath.domain.grid.for_each_owned_cell([&](int c) {
    all += vof.fractions().liquid[c] + vof.fractions().defect[c];
    EXPECT_GE(vof.fractions().liquid[c], 0);
    EXPECT_LE(vof.fractions().liquid[c], 1);
  });
  EXPECT_NEAR(sum_all(world(), all) * bath.domain.cell_volume(), start, 2e-14);
}

TEST(VolumeOfFluid, LosesNothing) {
  for (const double cfl : {0.3, 2.5})
    for (const bool is_solenoidal : {true, false}) {
      expect_nothing_is_lost<2>(cfl, is_solenoidal);
      expect_nothing_is_lost<3>(cfl, is_solenoidal);
    }
}

/// A solid goes slowly down into liquid that does not move, and comes up again: the surface makes
/// room for it.
template <int dim>
void expect_solid_dips() {
  const int n = dim == 2 ? 40 : 20, n_steps = 480;
  Bath<dim> bath(closed_cube<dim>(n));
  auto model = bath.make(model_name);
  const double dt = 0.1 / n, level = 0.45;
  const auto mesh = ball_surface<dim>(0.15, 0.5 / n);
  const auto at = [&](int i) {
    Point<dim> place = Point<dim>::Constant(0.5);
    place[dim - 1] = 0.75 - 0.3 * std::sin(pi * i / n_steps);
    return snapshot<dim>(mesh, place, true);
  };
  auto before = at(0);
  model->initialise([&](const Point<dim>& x) { return x[dim - 1] - level; }, before);
  const double start = model->ledger().volume;
  EXPECT_NEAR(start, level, 1e-3);
  double worst = 0;
  for (int i = 0; i < n_steps; ++i) {
    auto after = at(i + 1);
    bath.move(before, after, dt);
    bath.step(*model, i * dt, dt);
    before = after;
    EXPECT_NEAR(model->ledger().target, start, 1e-13);
    EXPECT_NEAR(model->ledger().lost, 0, 1e-14);
    worst = std::max(worst, std::abs(model->ledger().volume - start));
  }
  EXPECT_LT(worst, 5e-3 * start);  // a step makes good what the last one has displaced
  EXPECT_NEAR(model->ledger().volume, start, 1e-4 * start);
}

/// A full shell goes over more than its size in a step, to and fro: no cell is inside of it before
/// and after, but its liquid goes with it.
template <int dim>
void expect_shell_takes_liquid_along(double distance) {
  const int n = dim == 2 ? 40 : 20;
  const double radius = 0.15;
  Bath<dim> bath(closed_cube<dim>(n));
  auto model = bath.make(model_name);
  const auto mesh = ball_surface<dim>(radius, 0.5 / n);
  const auto center = [&](int i) {
    Point<dim> place = Point<dim>::Constant(0.503);
    place[0] += (i % 2 == 0 ? -0.5 : 0.5) * distance;
    return place;
  };
  auto before = snapshot<dim>(mesh, center(0), false);
  const SignedDistance<dim> by_cells = [&](const Point<dim>& x) {
    return (x - center(0)).norm() < radius ? -1 : 1;
  };
  model->initialise(by_cells, before);
  const double start = model->ledger().volume;
  ASSERT_GT(start, 0);
  for (int i = 0; i < 4; ++i) {
    auto after = snapshot<dim>(mesh, center(i + 1), false);
    const double dt = 0.1;
    bath.move(before, after, dt);
    bath.set_velocity(
        [&](const Point<dim>&) { return Point<dim>((center(i + 1) - center(i)) / dt); });
    bath.step(*model, i * dt, dt);
    before = after;
    EXPECT_NEAR(model->ledger().lost, 0, 1e-14) << i;
    // In a ball of a hundred cells volume defects last longer than a step.
    EXPECT_NEAR(model->ledger().volume, start, (dim == 2 ? 0.1 : 0.5) * start) << i;
    std::vector<char> inside(bath.domain.grid.n_stored_cells(), 0);
    bath.domain.grid.for_each_stored_cell(
        [&](int c) { inside[c] = (bath.domain.grid.center(c) - center(i + 1)).norm() < radius; });
    EXPECT_NEAR(model->liquid_in(inside).target, start, 1e-13) << i;
  }
}

TEST(VolumeOfFluid, AShellTakesItsLiquidAlong) {
  for (const double distance : {0.02, 0.2, 0.37, 0.55}) {
    expect_shell_takes_liquid_along<2>(distance);
    expect_shell_takes_liquid_along<3>(distance);
  }
}

/// A full shell is taken out of the domain at once: what it held is lost, and the target knows.
template <int dim>
void expect_lost_liquid_is_off_target() {
  const int n = dim == 2 ? 40 : 20;
  Bath<dim> bath(closed_cube<dim>(n));
  auto model = bath.make(model_name);
  const auto mesh = ball_surface<dim>(0.15, 0.5 / n);
  const Point<dim> center = Point<dim>::Constant(0.503);
  const auto before = snapshot<dim>(mesh, center, false),
             after = snapshot<dim>(mesh, center + Point<dim>::Unit(0), false);
  model->initialise(ball<dim>(center, 0.15), before);
  const double start = model->ledger().volume;
  bath.move(before, after, 0.1);
  bath.step(*model, 0, 0.1);
  EXPECT_GT(model->ledger().lost, 0.5 * start);  // the rest is a defect of the cells around
  EXPECT_NEAR(model->ledger().target + model->ledger().lost, start, 1e-13);
}

TEST(VolumeOfFluid, LostLiquidIsTakenOffTheTarget) {
  expect_lost_liquid_is_off_target<2>();
  expect_lost_liquid_is_off_target<3>();
}

/// A fragment in the air over a pool, on a tile that goes: it becomes a defect of the pool, or,
/// where none is left, the target knows that it is lost.
template <int dim>
void expect_fragments_of_gone_tiles_return(const std::string& correction, bool has_pool) {
  constexpr int n = 3 * tile_width<dim>;
  const double h = 1.0 / n, height = has_pool ? 4.3 * h : -1;
  Bath<dim> bath(closed_cube<dim>(n));
  ParameterList list;
  list.set("Volume Correction", correction);
  auto model = bath.make(model_name, list);
  Point<dim> place = Point<dim>::Constant(0.5 * h);
  place[dim - 1] = 1 - 4.5 * h;
  model->initialise(
      [&](const Point<dim>& x) {
        return std::min(x[dim - 1] - height, (x - place).norm() - 0.6 * h);
      },
      nullptr);
  const double start = model->ledger().target;
  const auto& vof = dynamic_cast<VolumeOfFluid<dim>&>(*model);
  const auto all = [&] {
    double sum = 0;
    bath.domain.grid.for_each_owned_cell(
        [&](int c) { sum += vof.fractions().liquid[c] + vof.fractions().defect[c]; });
    return sum_all(world(), sum) * bath.domain.cell_volume();
  };
  ASSERT_NEAR(all(), start, 1e-14);
  TiledGrid<dim> grid(bath.description.grid, world(),
                      [](const Index<dim>& first, const Index<dim>&) {
                        return first[dim - 1] < 2 * tile_width<dim>;
                      });
  const auto finish = model->migrate(TileMigration<dim>(bath.domain.grid, grid));
  bath.domain.set_grid(std::move(grid));
  finish();
  EXPECT_NEAR(model->ledger().target + model->ledger().lost, start, 1e-14);
  EXPECT_NEAR(model->ledger().target, all(), 1e-14);
  if (has_pool) {
    EXPECT_NEAR(model->ledger().lost, 0, 1e-16);
  } else {
    EXPECT_NEAR(model->ledger().lost, start, 1e-14);
  }
}

TEST(VolumeOfFluid, FragmentsOfTilesThatGoAreNotForgotten) {
  for (const std::string correction : {"none", "component"})
    for (const bool has_pool : {true, false}) {
      expect_fragments_of_gone_tiles_return<2>(correction, has_pool);
      expect_fragments_of_gone_tiles_return<3>(correction, has_pool);
    }
}

/// A run that blows up would take millions of sweeps for a step.
TEST(VolumeOfFluid, StepsOverAHundredCellsAreRefused) {
  Bath<2> bath(open_cube<2>(20));
  bath.set_velocity([](const Point<2>&) { return Point<2>(0.05, 0); });
  auto model = bath.make(model_name);
  model->initialise(ball<2>(Point<2>(0.5, 0.5), 0.2), nullptr);
  EXPECT_NO_THROW(bath.step(*model, 0, 99));
  model->initialise(ball<2>(Point<2>(0.5, 0.5), 0.2), nullptr);
  EXPECT_THROW(bath.step(*model, 0, 101), SolveError);
}

TEST(VolumeOfFluid, ASolidThatDipsDisplacesLiquid) {
  expect_solid_dips<2>();
  expect_solid_dips<3>();
}

}  // namespace
}  // namespace lockstep::test
