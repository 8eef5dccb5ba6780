// Springs, and lines of any law: forces are minus the derivatives of energies.
#include "lines/line_law.hpp"

#include <gtest/gtest.h>

#include "lines/catenary.hpp"

namespace lockstep::test {
namespace {

/// Forces and stiffness of a law by differences of energies and forces.
template <int dim>
void expect_consistent(const LineLaw<dim>& law, const Point<dim>& way, double across_part = 1) {
  constexpr double step = 1e-6;
  const LineResponse<dim> here = law.response(way);
  const double scale = here.force[1].norm() + 1;
  for (int a = 0; a < dim; ++a) {
    const Point<dim> shift = step * Point<dim>::Unit(a);
    const LineResponse<dim> ahead = law.response(way + shift), behind = law.response(way - shift);
    EXPECT_NEAR((behind.energy - ahead.energy) / (2 * step), here.force[1][a], 1e-6 * scale) << a;
    const Point<dim> slope = (behind.force[1] - ahead.force[1]) / (2 * step);
    EXPECT_LE((slope - across_part * here.stiffness.col(a)).norm(),
              1e-5 * here.stiffness.norm() + 1e-5)
        << a;
  }
}

TEST(LineLaw, SpringPullsAndPushesAlongItself) {
  const auto spring = spring_law<2>({100, 3, 2, false});
  const LineResponse<2> stretched = spring->response({3, 4});
  EXPECT_LE((stretched.force[1] - Point<2>(-180, -240)).norm(), 1e-12);
  EXPECT_LE((stretched.force[0] + stretched.force[1]).norm(), 0);
  EXPECT_NEAR(stretched.energy, 450, 1e-12);
  EXPECT_NEAR(stretched.tension[0], 300, 1e-12);
  EXPECT_NEAR(Point<2>(3, 4).dot(stretched.damping * Point<2>(3, 4)), 3 * 25, 1e-12);
  expect_consistent<2>(*spring, {3, 4});
  EXPECT_GT(spring->response({1, 0}).force[1].x(), 0);
  expect_consistent<3>(*spring_law<3>({100, 3, 0, false}), {0.3, -0.4, 0.1});
}

TEST(LineLaw, ARopeDoesNotPush) {
  const auto rope = spring_law<3>({100, 3, 2, true});
  const LineResponse<3> slack = rope->response({1, 0.5, 0});
  EXPECT_EQ(slack.force[1].norm() + slack.stiffness.norm() + slack.damping.norm(), 0);
  EXPECT_GT(rope->response({2.1, 0, 0}).tension[1], 0);
}

TEST(LineLaw, CatenaryIsTheGradientOfItsEnergy) {
  const CatenaryParameters line{10, 3, 5e3, false};
  expect_consistent<2>(*catenary_law<2>(line, {0, 1}), {7, 4});
  expect_consistent<2>(*catenary_law<2>(line, {0, 1}), {9, -4.2});
  expect_consistent<3>(*catenary_law<3>(line, {0, 0, 1}), {5, 3, 4});
  expect_consistent<3>(*catenary_law<3>({10, 3, 5e3, true}, {0, 0, 1}), {6, 2, 4});
}

}  // namespace
}  // namespace lockstep::test
