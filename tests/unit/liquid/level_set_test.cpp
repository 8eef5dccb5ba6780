#include <gtest/gtest.h>

#include "bath.hpp"
#include "geometry/generators.hpp"
#include "liquid/common/redistance.hpp"

namespace lockstep::test {
namespace {

/// Distance to the ellipse x^2/a^2 + y^2/b^2 = 1 by search along it, negative inside.
double distance_to_ellipse(const Point<2>& x, double a, double b) {
  const auto at = [&](double t) { return Point<2>(a * std::cos(t), b * std::sin(t)); };
  double best = 0, width = 0.01;
  for (int i = 0; i < 629; ++i)
    if ((at(0.01 * i) - x).norm() < (at(best) - x).norm())
      best = 0.01 * i;
  for (; width > 1e-9; width *= 0.6)
    for (const double t : {best - width, best + width})
      if ((at(t) - x).norm() < (at(best) - x).norm())
        best = t;
  const bool inside = x[0] * x[0] / (a * a) + x[1] * x[1] / (b * b) < 1;
  return (inside ? -1 : 1) * (at(best) - x).norm();
}

/// Largest errors, in cells: beside the ellipse and in the whole band.
std::array<double, 2> errors_of_ellipse(int n) {
  Bath<2> bath(open_cube<2>(n));
  const auto& grid = bath.domain.grid;
  const double a = 0.31, b = 0.19, h = bath.domain.spacing();
  CellField phi(grid.n_stored_cells(), 1);
  for (int c = 0; c < grid.n_stored_cells(); ++c) {
    const Point<2> x = grid.center(c) - Point<2>(0.501, 0.4987);
    if (grid.in_domain(c))
      phi[c] = 0.05 * (x[0] * x[0] / (a * a) + x[1] * x[1] / (b * b) - 1) * (1 + 0.3 * x[0]);
  }
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  redistance(bath.domain, solids, std::vector<char>(grid.n_owned_tiles(), 1), 6 * h, phi);
  std::array<double, 2> worst{};
  grid.for_each_owned_cell([&](int c) {
    const double exact = distance_to_ellipse(grid.center(c) - Point<2>(0.501, 0.4987), a, b);
    EXPECT_EQ(phi[c] < 0, exact < 0);
    const double error = std::abs(phi[c] - exact) / h;
    if (std::abs(exact) < 0.7 * h)
      worst[0] = std::max(worst[0], error);
    if (std::abs(exact) < 5 * h)
      worst[1] = std::max(worst[1], error);
    if (std::abs(exact) > 6.8 * h) {
      EXPECT_EQ(std::abs(phi[c]), 6 * h);
    }
  });
  return {max_all(world(), worst[0]), max_all(world(), worst[1])};
}

TEST(Redistancing, ShowsTheDistanceToAnEllipse) {
  const auto coarse = errors_of_ellipse(48), fine = errors_of_ellipse(96);
  // Errors are given in cells: of first order they would not fall, of second they are halved.
  EXPECT_LT(coarse[0], 0.06);
  EXPECT_LT(fine[0], 0.6 * coarse[0]);
  EXPECT_LT(fine[1], 0.3);
}

/// A slot of air two cells wide: the columns on either side of its middle show one step across the
/// interface, and one that is 0 but for round-off of either sign.
TEST(Redistancing, RoundOffDecidesNothingInTheMiddleOfASlot) {
  constexpr int n = 16;
  Bath<2> bath(open_cube<2>(n));
  const auto& grid = bath.domain.grid;
  const double h = bath.domain.spacing();
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto with = [&](double round_off) {
    CellField phi(grid.n_stored_cells(), 1);
    for (int c = 0; c < grid.n_stored_cells(); ++c) {
      const double x = grid.center(c)[0] - 0.5;
      phi[c] = h - std::abs(x) + (x > 0 ? round_off : 0);
    }
    redistance(bath.domain, solids, std::vector<char>(grid.n_owned_tiles(), 1), 6 * h, phi);
    return phi;
  };
  const CellField exact = with(0), less = with(-1e-17), more = with(1e-17);
  grid.for_each_owned_cell([&](int c) {
    EXPECT_NEAR(less[c], exact[c], 1e-15);
    EXPECT_NEAR(more[c], exact[c], 1e-15);
  });
}

template <int dim>
void expect_rest(const std::string& name) {
  Bath<dim> bath(open_cube<dim>(20));
  auto model = bath.make(name);
  Point<dim> normal = Point<dim>::Constant(0.3);
  normal[dim - 1] = 1;
  normal.normalize();
  model->initialise([&](const Point<dim>& x) { return normal.dot(x) - 0.537; }, nullptr);
  const CellField before = model->distance();
  for (int i = 0; i < 20; ++i)
    bath.step(*model, 0.1 * i, 0.1);
  bath.domain.grid.for_each_stored_cell(
      [&](int c) { EXPECT_NEAR(model->distance()[c], before[c], 1e-14); });
}

TEST(LevelSet, StaysAtRest) {
  for (const char* const name : {"level set", "volume of fluid"}) {
    expect_rest<2>(name);
    expect_rest<3>(name);
  }
}

/// By whole cells, so that nothing is interpolated.
template <int dim>
void expect_ball_travels(const std::string& name, int n_cells, double tolerance) {
  const int n = dim == 2 ? 64 : 32;
  Bath<dim> bath(open_cube<dim>(n));
  auto model = bath.make(name);
  const Point<dim> start = Point<dim>::Constant(0.35), u = Point<dim>::Ones();
  model->initialise(ball<dim>(start, 0.2), nullptr);
  bath.set_velocity([&](const Point<dim>&) { return u; });
  const double dt = static_cast<double>(n_cells) / n;
  const int n_steps = 6 / n_cells;
  for (int i = 0; i < n_steps; ++i)
    bath.step(*model, i * dt, dt);
  const auto areas = bath.measure(model->distance(), ball<dim>(start + n_steps * dt * u, 0.2));
  const double volume = dim == 2 ? pi * 0.04 : 4 / 3.0 * pi * 0.008;
  EXPECT_NEAR(areas.liquid, volume, tolerance * volume);
  EXPECT_LT(areas.wrong, tolerance * volume);
}

TEST(LevelSet, CarriesABall) {
  for (const char* const name : {"level set", "volume of fluid"})
    for (const int n_cells : {1, 3}) {
      expect_ball_travels<2>(name, n_cells, 0.01);
      expect_ball_travels<3>(name, n_cells, 0.04);
    }
}

template <int dim>
void expect_same_on_any_ranks(const std::string& name) {
  Bath<dim> bath(open_cube<dim>(dim == 2 ? 70 : 30)), alone(bath.description, self());
  for (auto* b : {&bath, &alone})
    b->set_velocity(swirl<dim>);
  auto model = bath.make(name), model_alone = alone.make(name);
  for (auto* m : {model.get(), model_alone.get()})
    m->initialise(ball<dim>(Point<dim>::Constant(0.45), 0.25), nullptr);
  for (int i = 0; i < 30; ++i) {
    bath.step(*model, 0, 0.04);
    alone.step(*model_alone, 0, 0.04);
  }
  bath.domain.grid.for_each_stored_cell([&](int c) {
    const int other = alone.domain.grid.cell(bath.domain.grid.coordinates(c));
    ASSERT_NEAR(model->distance()[c], model_alone->distance()[other], 1e-13);
  });
}

TEST(LevelSet, IsTheSameOnAnyNumberOfRanks) {
  for (const char* const name : {"level set", "volume of fluid"}) {
    expect_same_on_any_ranks<2>(name);
    expect_same_on_any_ranks<3>(name);
  }
}

/// A wave goes once around a periodic axis, by whole cells; the last tile along it is a short one.
template <int dim>
void expect_wave_comes_around(const std::string& name, int n) {
  DomainDescription<dim> description = closed_cube<dim>(n);
  description.grid.periodic[0] = true;
  for (auto& side : description.boundary.sides[0])
    side.type = SideType::periodic;
  Bath<dim> bath(description);
  auto model = bath.make(name);
  const SignedDistance<dim> wave = [](const Point<dim>& x) {
    return x[dim - 1] - 0.5 - 0.1 * std::sin(2 * pi * x[0]);
  };
  model->initialise(wave, nullptr);
  const double volume = model->ledger().volume;
  bath.set_velocity([](const Point<dim>&) { return Point<dim>(Point<dim>::Unit(0)); });
  for (int i = 0; i < n; ++i)
    bath.step(*model, static_cast<double>(i) / n, 1.0 / n);
  // A column that does not go along would leave a level surface: 2/pi of the amplitude.
  EXPECT_LT(bath.measure(model->distance(), wave).wrong, 0.005) << name << ", " << n;
  EXPECT_NEAR(model->ledger().volume, volume, name == "volume of fluid" ? 1e-12 : 0.005);
}

TEST(LevelSet, ShortTilesAtPeriodicSidesGoAlong) {
  for (const char* const name : {"level set", "particle level set", "volume of fluid"}) {
    for (const int n : {33, 34, 50})
      expect_wave_comes_around<2>(name, n);
    expect_wave_comes_around<3>(name, 17);
  }
}

/// A closed shell, full or empty, is driven through rough water or air: each cell is what its side
/// of the shell was from the start.
template <int dim>
void expect_shell_holds(const std::string& name, bool full) {
  const int n = dim == 2 ? 48 : 24;
  Bath<dim> bath(closed_cube<dim>(n));
  auto model = bath.make(name);
  const double dt = 1.5 / n, radius = 0.21;
  const auto center = [&](int i) {
    return Point<dim>(Point<dim>::Constant(0.5) + 0.1 * std::sin(0.8 * i) * Point<dim>::Unit(0) +
                      0.1 * std::sin(0.5 * i) * Point<dim>::Unit(1));
  };
  const SurfaceMesh<dim> shell = ball_surface<dim>(radius, 1.5 / n);
  const auto at = [&](int i) { return snapshot<dim>(shell, center(i), false); };
  bath.set_velocity([](const Point<dim>& x) {
    Point<dim> u;
    for (int a = 0; a < dim; ++a)
      u[a] = std::sin(31 * x[a] + 17 * x[(a + 1) % dim] + a);
    return u;
  });
  auto before = at(0);
  model->initialise(
      [&](const Point<dim>& x) { return ((x - center(0)).norm() < radius) == full ? -1 : 1; },
      before);
  for (int i = 0; i < 12; ++i) {
    auto after = at(i + 1);
    bath.move(before, after, dt);
    bath.step(*model, i * dt, dt);
    before = after;
    bath.domain.grid.for_each_owned_cell([&](int c) {
      const double distance = (bath.domain.grid.center(c) - center(i + 1)).norm() - radius;
      if (std::abs(distance) > 0.2 / n) {  // the polygon is not quite round
        ASSERT_EQ(model->distance()[c] < 0, (distance < 0) == full)
            << "step " << i << " at " << bath.domain.grid.center(c).transpose();
      }
    });
  }
}

TEST(LevelSet, AClosedShellLetsNothingThrough) {
  for (const char* const name : {"level set", "volume of fluid"})
    for (const bool full : {true, false}) {
      expect_shell_holds<2>(name, full);
      expect_shell_holds<3>(name, full);
    }
}

/// True if a corner of the cell's upper face lies outside of a ball by a little.
template <int dim>
bool upper_face_is_open(const Bath<dim>& bath, int cell, const Point<dim>& center, double radius) {
  const double h = bath.domain.spacing();
  for (int k = 0; k < 1 << (dim - 1); ++k) {
    Point<dim> corner = bath.domain.grid.center(cell) + 0.5 * h * Point<dim>::Unit(dim - 1);
    for (int a = 0; a < dim - 1; ++a)
      corner[a] += (k >> a & 1 ? 0.5 : -0.5) * h;
    if ((corner - center).norm() > radius + 0.02 * h)
      return true;
  }
  return false;
}

/// Where water and air meet in faces that a ball leaves open, phi is the plane that it is farther
/// off, in cells whose centre is in the ball, too, and under the overhang of a ball that is hardly
/// immersed: else water and ball would not rest.
template <int dim>
void expect_plane_goes_on(double depth) {
  const double h = 1.0 / 32, radius = 0.2, height = 0.5 + depth;
  Bath<dim> bath(open_cube<dim>(32));
  auto model = bath.make("level set");
  const Point<dim> center = Point<dim>::Constant(0.5);
  model->initialise([=](const Point<dim>& x) { return x[dim - 1] - height; },
                    snapshot<dim>(ball_surface<dim>(radius, 0.05), center, true));
  double n_beside = 0;
  bath.domain.grid.for_each_owned_cell([&](int c) {
    const Point<dim> x = bath.domain.grid.center(c);
    const double level = x[dim - 1] - height;
    if (level > 0 || level <= -h || (x - center).norm() > radius + h ||
        !upper_face_is_open(bath, c, center, radius))
      return;
    ++n_beside;
    const int above = bath.domain.grid.neighbor(c, dim - 1, 1);
    EXPECT_NEAR(model->distance()[c], level, 1e-9 * h) << x.transpose() << ", " << depth;
    EXPECT_NEAR(model->distance()[above], level + h, 1e-9 * h) << x.transpose() << ", " << depth;
  });
  EXPECT_GT(sum_all(world(), n_beside), 1);
}

TEST(LevelSet, GoesOnIntoSolids) {
  for (const double depth : {-0.161, -0.12, -0.077, -0.031, 0.01, 0.055, 0.093, 0.147}) {
    expect_plane_goes_on<2>(depth);
    expect_plane_goes_on<3>(depth);
  }
}

/// A ball lies on a sheet that water is under: none of it reaches into the ball.
TEST(LevelSet, DoesNotGoOnThroughShells) {
  SurfaceMesh<2> mesh = plate_surface<2>(Point<2>(3, 3), 1, 0.5);
  for (Point<2>& x : mesh.vertices)
    x += Point<2>(0.5, 0.492);
  SolidDescription sheet, disc;
  sheet.closed = false;
  sheet.simplex_end = disc.simplex_begin = static_cast<int>(mesh.simplices.size());
  sheet.vertex_end = disc.vertex_begin = static_cast<int>(mesh.vertices.size());
  const SurfaceMesh<2> round = ball_surface<2>(0.15, 0.02);
  for (const auto& [a, b] : round.simplices)
    mesh.simplices.push_back({a + disc.vertex_begin, b + disc.vertex_begin});
  for (const Point<2>& x : round.vertices)
    mesh.vertices.emplace_back(x + Point<2>(0.5, 0.645));
  disc.simplex_end = static_cast<int>(mesh.simplices.size());
  disc.vertex_end = static_cast<int>(mesh.vertices.size());
  const auto solids =
      std::make_shared<const SurfaceSnapshot<2>>(std::move(mesh), std::vector{sheet, disc});
  Bath<2> bath(open_cube<2>(32));
  auto model = bath.make("level set");
  model->initialise([](const Point<2>& x) { return x[1] - 0.49; }, solids);
  bath.domain.grid.for_each_owned_cell([&](int c) {
    const Point<2> x = bath.domain.grid.center(c);
    if ((x - Point<2>(0.5, 0.645)).norm() < 0.15) {
      EXPECT_GT(model->distance()[c], 0) << x.transpose();
    }
  });
}

}  // namespace
}  // namespace lockstep::test
