#include <gtest/gtest.h>

#include "liquid/common/liquid_volume.hpp"

#include <random>

#include "bath.hpp"
#include "geometry/generators.hpp"
#include "liquid/common/wet_fraction.hpp"

namespace lockstep::test {
namespace {

/// Fraction by samples, from the values on the simplex that holds each.
template <int dim>
double sampled_fraction(const std::array<double, 1 << dim>& phi, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const int n = 40000;
  int n_wet = 0;
  for (int i = 0; i < n; ++i) {
    std::array<std::pair<double, int>, dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = {uniform(random), a};
    std::sort(x.rbegin(), x.rend());
    double value = phi[0], at = phi[0];
    for (int a = 0, corner = 0; a < dim; ++a) {
      corner |= 1 << x[a].second;
      value += x[a].first * (phi[corner] - at);
      at = phi[corner];
    }
    n_wet += value < 0;
  }
  return static_cast<double>(n_wet) / n;
}

template <int dim>
void expect_fractions() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 40; ++i) {
    std::array<double, 1 << dim> phi;
    for (double& value : phi)
      value = uniform(random) + 0.5 * uniform(random);
    EXPECT_NEAR(wet_fraction<dim>(phi), sampled_fraction<dim>(phi, random), 0.012);
  }
}

TEST(WetFraction, AgreesWithSamples) {
  expect_fractions<2>();
  expect_fractions<3>();
}

template <int dim>
GroupVolumes volumes(const Bath<dim>& bath, const SolidCells<dim>& solids,
                     const SignedDistance<dim>& distance) {
  const auto& grid = bath.domain.grid;
  CellField phi(grid.n_stored_cells(), 1);
  grid.for_each_stored_cell([&](int c) { phi[c] = distance(grid.center(c)); });
  std::vector<char> wet(phi.size());
  for (std::size_t c = 0; c < phi.size(); ++c)
    wet[c] = phi[c] < 0;
  LiquidVolume<dim> measure(bath.domain);
  measure.prepare(solids, phi);
  return measure.measure(phi, find_groups(bath.domain, solids, wet));
}

/// A plane that cuts the sides of the domain: exact where it is not parallel to them too.
TEST(LiquidVolume, OfATiltedPlaneIsExact) {
  Bath<2> bath(open_cube<2>(20));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto result = volumes<2>(bath, solids, [](const Point<2>& x) { return x[1] - 0.437; });
  EXPECT_NEAR(result.total(), 0.437, 1e-14);
  ASSERT_EQ(result.area.size(), 1U);
  EXPECT_NEAR(result.area[0], 1, 1e-9);
}

template <int dim>
double error_of_ball(int n) {
  Bath<dim> bath(open_cube<dim>(n));
  const auto solids = find_solid_cells<dim>(bath.domain, nullptr);
  const double r = 0.31;
  const auto result = volumes<dim>(bath, solids, ball<dim>(Point<dim>::Constant(0.487), r));
  const double exact = dim == 2 ? pi * r * r : 4 * pi * r * r * r / 3;
  EXPECT_NEAR(result.area[0], dim * exact / r, 0.01 * dim * exact / r);
  return std::abs(result.total() - exact) / exact;
}

TEST(LiquidVolume, OfABallIsOfSecondOrder) {
  EXPECT_LT(error_of_ball<2>(32), 2e-3);
  EXPECT_LT(error_of_ball<2>(64), 0.3 * error_of_ball<2>(32));
  EXPECT_LT(error_of_ball<3>(24), 0.01);
  EXPECT_LT(error_of_ball<3>(48), 0.3 * error_of_ball<3>(24));
}

/// Between thin walls that stand on faces of cells the volume of the body grows steadily with its
/// level.
template <int dim>
void expect_no_leaps_between_shells() {
  constexpr int n = 16;
  const double h = 1.0 / n, width = 4 * h;
  Bath<dim> bath(open_cube<dim>(n));
  Point<dim> size = Point<dim>::Constant(1.5);
  SurfaceMesh<dim> walls;
  for (const double x : {6 * h, 6 * h + width}) {
    const SurfaceMesh<dim> wall = plate_surface<dim>(size, 0, h);
    const int begin = static_cast<int>(walls.vertices.size());
    for (Point<dim> v : wall.vertices) {
      v += Point<dim>::Constant(0.5);
      v[0] = x;
      walls.vertices.push_back(v);
    }
    for (auto simplex : wall.simplices) {
      for (int& v : simplex)
        v += begin;
      walls.simplices.push_back(simplex);
    }
  }
  const auto shell = snapshot<dim>(walls, Point<dim>::Zero(), false);
  const auto solids = find_solid_cells<dim>(bath.domain, shell);
  for (int i = 0; i <= 10; ++i) {
    const double level = 0.5 + (0.1 * i + 0.03) * h;
    const auto result = volumes<dim>(bath, solids, [&](const Point<dim>& x) {
      return x[0] > 6 * h && x[0] < 10 * h ? x[dim - 1] - level : 1;
    });
    ASSERT_EQ(result.volume.size(), 1U);
    EXPECT_NEAR(result.volume[0], width * level, 1e-12) << i;
    EXPECT_NEAR(result.area[0], width, 0.25 * width) << i;
  }
}

TEST(LiquidVolume, DoesNotLeapBetweenShells) {
  expect_no_leaps_between_shells<2>();
  expect_no_leaps_between_shells<3>();
}

/// A ball of liquid half full of a solid ball; the volume hardly depends on where the grid is.
template <int dim>
void expect_solid_is_taken_off() {
  Bath<dim> bath(open_cube<dim>(32));
  const double level = 0.52, r = 0.2, h = 1.0 / 32;
  for (int i = 0; i < 4; ++i) {
    const Point<dim> place = Point<dim>::Constant(0.5 + 0.23 * i * h);
    const auto solid = snapshot<dim>(ball_surface<dim>(r, 0.3 * h), place, true);
    const auto solids = find_solid_cells<dim>(bath.domain, solid);
    const auto result =
        volumes<dim>(bath, solids, [&](const Point<dim>& x) { return x[dim - 1] - level; });
    const double d = place[dim - 1] - level;  // height of the centre above the level
    const double wet = dim == 2 ? r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d)
                                : pi * (r - d) * (r - d) * (2 * r + d) / 3;
    EXPECT_NEAR(result.total(), level - wet, 2e-3 * wet) << i;
  }
}

TEST(LiquidVolume, LeavesOutSolids) {
  expect_solid_is_taken_off<2>();
  expect_solid_is_taken_off<3>();
}

/// A solid at the lower end of a periodic axis takes its part of the boxes that end there, too.
template <int dim>
void expect_solid_at_periodic_sides() {
  constexpr int n = 16;
  const double h = 1.0 / n, level = 0.52;
  DomainDescription<dim> description = closed_cube<dim>(n);
  for (const int axis : {0, dim - 2}) {
    for (auto& side : description.boundary.sides[axis])
      side.type = SideType::periodic;
    description.grid.periodic[axis] = true;
  }
  Bath<dim> bath(description);
  for (const double gap : {0.0, 0.1, 0.3, 0.45}) {
    const Point<dim> size = Point<dim>::Constant(0.3);
    Point<dim> center = 0.5 * size + Point<dim>::Constant(gap * h);
    center[dim - 1] = 0.25;
    const auto solids =
        find_solid_cells<dim>(bath.domain, snapshot<dim>(box_surface<dim>(size, h), center, true));
    const auto result =
        volumes<dim>(bath, solids, [&](const Point<dim>& x) { return x[dim - 1] - level; });
    EXPECT_NEAR(result.total(), level - std::pow(0.3, dim - 1) * 0.3, 1e-13) << gap;
  }
}

TEST(LiquidVolume, LeavesOutSolidsAtPeriodicSides) {
  expect_solid_at_periodic_sides<2>();
  expect_solid_at_periodic_sides<3>();
}

/// Checks the liquid in a closed shell, air around it, wherever its cells' centres are, against the
/// volume of whole cells, which changes as the shell goes over the grid. Mean squares.
template <int dim>
void expect_volume_in_shell(int n, double part) {
  Bath<dim> bath(open_cube<dim>(n));
  const double radius = 0.3;
  const double full = dim == 2 ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius;
  double squares = 0, squares_of_cells = 0;
  for (int i = 0; i < 9; ++i) {
    Point<dim> center = Point<dim>::Constant(0.5);
    for (int a = 0; a < dim; ++a)
      center[a] += i * (0.37 - 0.14 * a) / n;
    const auto shell = snapshot<dim>(ball_surface<dim>(radius, 0.25 / n), center, false);
    const auto solids = find_solid_cells<dim>(bath.domain, shell);
    double cells = 0;
    const SignedDistance<dim> distance = [&](const Point<dim>& x) {
      return (x - center).norm() < radius ? -1 : 1;
    };
    bath.domain.grid.for_each_owned_cell(
        [&](int c) { cells += distance(bath.domain.grid.center(c)) < 0; });
    cells = sum_all(world(), cells) * bath.domain.cell_volume();
    const double found = volumes<dim>(bath, solids, distance).total();
    squares += (found / full - 1) * (found / full - 1);
    squares_of_cells += (cells / full - 1) * (cells / full - 1);
  }
  EXPECT_LT(squares, part * part * squares_of_cells);
}

TEST(LiquidVolume, OfAFullShellGoesWithIt) {
  expect_volume_in_shell<2>(20, 0.01);
  expect_volume_in_shell<2>(40, 0.01);
  expect_volume_in_shell<3>(20, 0.1);
}

/// Plane sides count in full; of the cells at the corners up to a half may be on the wrong side.
TEST(LiquidVolume, OfAFullChestGoesWithIt) {
  Bath<2> bath(open_cube<2>(20));
  for (int i = 0; i < 9; ++i) {
    const Point<2> center(0.5 + 0.05 * 0.11 * i, 0.5 + 0.05 * 0.07 * i), half(0.237, 0.311);
    const auto shell = snapshot<2>(box_surface<2>(2 * half, 0.02), center, false);
    const auto result =
        volumes<2>(bath, find_solid_cells<2>(bath.domain, shell), [&](const Point<2>& x) {
          return ((x - center).cwiseAbs().array() < half.array()).all() ? -1 : 1;
        });
    EXPECT_NEAR(result.total(), 4 * half[0] * half[1], 4 * 0.5 * 0.05 * 0.05) << i;
  }
}

}  // namespace
}  // namespace lockstep::test
