// Curvature of the surface that fractions stand for, by the heights of columns.
#include <gtest/gtest.h>

#include "bath.hpp"
#include "liquid/fractions/fraction_heights.hpp"

namespace lockstep::test {
namespace {

/// The part of a cell in a ball, from lines along the axis that is nearest to its surface's normal.
template <int dim>
double part_in_ball(const Point<dim>& from_middle, double h, double radius) {
  constexpr int n = dim == 2 ? 200 : 40;
  int along = 0;
  from_middle.cwiseAbs().maxCoeff(&along);
  const double inner = std::abs(from_middle[along]) - 0.5 * h;
  double sum = 0;
  for (int k = 0, n_lines = dim == 2 ? n : n * n; k < n_lines; ++k) {
    double squares = 0;
    for (int a = 0, rest = k; a < dim; ++a)
      if (a != along) {
        const double x = from_middle[a] + ((rest % n + 0.5) / n - 0.5) * h;
        squares += x * x;
        rest /= n;
      }
    const double end = std::sqrt(std::max(radius * radius - squares, 0.0));
    sum += std::clamp((end - inner) / h, 0.0, 1.0) / n_lines;
  }
  return sum;
}

struct Bent {
  double worst = 0;            ///< error times the radius
  int n_known = 0, n_all = 0;  ///< crossings
};

/// A ball in cells of 1/n, in a domain of which each side may be where it is cut.
template <int dim>
struct Ball {
  Ball(const DomainDescription<dim>& description, const Point<dim>& middle, double radius)
      : domain(description, world()), center(middle), R(radius) {
    const TiledGrid<dim>& grid = domain.grid;
    phi.assign(grid.n_stored_cells(), 1);
    fraction.assign(grid.n_stored_cells(), 0);
    lead.assign(grid.n_stored_cells(), 0);
    grid.for_each_stored_cell([&](int cell) {
      const Point<dim> x = grid.center(cell) - center;
      phi[cell] = x.norm() - R;
      const double h = domain.spacing();
      fraction[cell] = phi[cell] < -2 * h ? 1 : phi[cell] > 2 * h ? 0 : part_in_ball<dim>(x, h, R);
    });
  }
  Bent measure() const {
    const SolidCells<dim> solids = find_solid_cells<dim>(domain, nullptr);
    const FractionHeights<dim> heights(domain, solids, fraction, phi, lead);
    Bent bent;
    domain.grid.for_each_owned_cell([&](int cell) {
      for (int i = 0; i < 2 * dim; ++i) {
        const int other = domain.grid.neighbor(cell, i / 2, i % 2);
        if (other < 0 || !domain.grid.in_domain(other) || phi[cell] >= 0 || phi[other] < 0)
          continue;
        ++bent.n_all;
        const double place = phi[cell] / (phi[cell] - phi[other]);
        const auto kappa = heights.curvature(cell, i / 2, i % 2, place);
        bent.n_known += kappa.has_value();
        bent.worst = std::max(bent.worst, kappa ? std::abs(*kappa * R - (dim - 1)) : 0);
      }
    });
    bent.worst = max_all(world(), bent.worst);
    bent.n_known = sum_all(world(), static_cast<GlobalIndex>(bent.n_known));
    bent.n_all = sum_all(world(), static_cast<GlobalIndex>(bent.n_all));
    return bent;
  }

  MacDomain<dim> domain;
  Point<dim> center;
  double R = 0;
  CellField phi, fraction, lead;
};

template <int dim>
Bent bend_of_ball(int n) {
  Point<dim> center = Point<dim>::Constant(0.503);
  center[1] = 0.511;
  return Ball<dim>(closed_cube<dim>(n), center, 0.31).measure();
}

TEST(FractionHeights, FindTheCurvatureOfABallToSecondOrder) {
  const double coarse = bend_of_ball<2>(32).worst, middle = bend_of_ball<2>(64).worst,
               fine = bend_of_ball<2>(128).worst;
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(middle, 0.32 * coarse);
  EXPECT_LT(fine, 0.32 * middle);
  EXPECT_LT(bend_of_ball<3>(36).worst, 0.1);
  const double coarse_3d = bend_of_ball<3>(56).worst, fine_3d = bend_of_ball<3>(84).worst;
  EXPECT_LT(coarse_3d, 0.06);
  EXPECT_LT(fine_3d, 0.6 * coarse_3d);
}

TEST(FractionHeights, KnowItAllAround) {
  const Bent disc = bend_of_ball<2>(16), ball = bend_of_ball<3>(56);
  EXPECT_EQ(disc.n_known, disc.n_all);
  EXPECT_EQ(ball.n_known, ball.n_all);
  // Along the diagonals of small balls there are no columns beside one.
  const Bent small = bend_of_ball<3>(16);
  EXPECT_GT(small.n_known, 0.5 * small.n_all);
}

TEST(FractionHeights, AreMirroredAtSidesUnlessTheseHaveAContactAngle) {
  for (const double cotangent : {0., 0.5}) {
    DomainDescription<2> description = closed_cube<2>(64);
    description.boundary.sides[1][0].contact_cotangent = cotangent;
    const Bent bent = Ball<2>(description, {0.503, 0}, 0.31).measure();
    EXPECT_LT(bent.worst, 0.02);
    EXPECT_EQ(bent.n_known == bent.n_all, cotangent == 0);
  }
}

/// A level surface that is shifted by waves is bent as these are.
template <int dim>
void expect_lead() {
  constexpr int n = 32;
  Ball<dim> level(closed_cube<dim>(n), Point<dim>::Zero(), 1);
  const double wave = 2 * pi, height = 0.002, top = 0.51;
  const TiledGrid<dim>& grid = level.domain.grid;
  grid.for_each_stored_cell([&](int cell) {
    const Point<dim> x = grid.center(cell);
    level.phi[cell] = x[1] - top;
    level.fraction[cell] = std::clamp(0.5 - level.phi[cell] * n, 0.0, 1.0);
    level.lead[cell] = height * std::cos(wave * x[0]);
  });
  const SolidCells<dim> solids = find_solid_cells<dim>(level.domain, nullptr);
  const FractionHeights<dim> heights(level.domain, solids, level.fraction, level.phi, level.lead);
  grid.for_each_owned_cell([&](int cell) {
    const int above = grid.neighbor(cell, 1, 1);
    if (above < 0 || level.phi[cell] >= 0 || level.phi[above] < 0)
      return;
    const double bend = height * wave * wave, x = grid.center(cell)[0];
    EXPECT_NEAR(heights.curvature(cell, 1, 1, 0.5).value_or(1e9), -bend * std::cos(wave * x),
                0.03 * bend);
  });
}

TEST(FractionHeights, ShiftWithTheSurface) {
  expect_lead<2>();
  expect_lead<3>();
}

}  // namespace
}  // namespace lockstep::test
