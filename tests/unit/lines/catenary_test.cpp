// The elastic catenary against closed forms.
#include "lines/catenary.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lockstep::test {
namespace {

TEST(Catenary, StiffLineBetweenLevelEnds) {
  // l = 2 a sinh^-1(L / 2a) with a = H / w.
  const double a = 7, w = 3, length = 10, l = 2 * a * std::asinh(length / (2 * a));
  const CatenaryTension found = solve_catenary({length, w, 1e12, false}, l, 0);
  EXPECT_NEAR(found.horizontal, a * w, 1e-7 * a * w);
  EXPECT_NEAR(found.vertical, w * length / 2, 1e-9 * w * length);
}

TEST(Catenary, FairleadOfALineThatLeavesTheGround) {
  // The lifted part s of a catenary that is level where it leaves the ground: h = sqrt(a^2 + s^2) -
  // a, its way a sinh^-1(s / a); V = w s.
  const double a = 5, w = 20, s = 12, rest = 3;
  const double h = std::hypot(a, s) - a, l = rest + a * std::asinh(s / a);
  const CatenaryTension found = solve_catenary({s + rest, w, 1e12, true}, l, h);
  EXPECT_NEAR(found.horizontal, a * w, 1e-7 * a * w);
  EXPECT_NEAR(found.vertical, w * s, 1e-7 * w * s);
}

TEST(Catenary, ElasticLineHangsStraightDown) {
  // Ends above each other, stretched: V L / EA - w L^2 / (2 EA) is the stretch.
  const double w = 2, length = 8, ea = 500, vertical = 40;
  const double h = length + (vertical * length - w * length * length / 2) / ea;
  const CatenaryTension found = solve_catenary({length, w, ea, false}, 0, h);
  EXPECT_NEAR(found.vertical, vertical, 1e-6 * vertical);
  EXPECT_NEAR(found.stiffness(1, 1), ea / length, 1e-6 * ea / length);
}

TEST(Catenary, IsFoundForSlackAndTautLines) {
  for (const bool on_floor : {false, true}) {
    for (const double l : {0., 1e-3, 1., 5., 8., 9.9, 10.5, 14.}) {
      for (const double h : {0.1, 1., 4., 9., 12.}) {
        const CatenaryParameters line{10, 3, 1e3, on_floor};
        const CatenaryTension found = solve_catenary(line, l, h);
        EXPECT_TRUE(std::isfinite(found.horizontal) && std::isfinite(found.vertical));
        EXPECT_GE(found.stiffness(0, 0), 0);
        EXPECT_GE(found.stiffness.determinant(), 0);
      }
    }
  }
}

TEST(Catenary, ALooseLineOnTheGroundHangsFromItsUpperEnd) {
  const CatenaryTension found = solve_catenary({10, 3, 1e12, true}, 2, 4);
  EXPECT_EQ(found.horizontal, 0);
  EXPECT_NEAR(found.vertical, 12, 1e-3);
}

TEST(Catenary, TheWholeWeightHangsOnTheEnds) {
  const LineResponse<3> response =
      catenary_law<3>({10, 3, 1e4, false}, {0, 0, 1})->response({4, 5, 2});
  EXPECT_LE((response.force[0] + response.force[1] - Point<3>(0, 0, -30)).norm(), 1e-10);
  const auto shape = catenary_law<2>({10, 3, 1e4, false}, {0, 1})->shape({6, 2});
  EXPECT_LE((shape.back() - Point<2>(6, 2)).norm(), 1e-12);
  double length = 0;
  for (std::size_t k = 1; k < shape.size(); ++k)
    length += (shape[k] - shape[k - 1]).norm();
  EXPECT_NEAR(length, 10, 0.05);
}

}  // namespace
}  // namespace lockstep::test
