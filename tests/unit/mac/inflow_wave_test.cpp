// Velocities that a wavemaker side prescribes, against linear theory.
#include "staggered/domain/inflow_wave.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mac_cases.hpp"
#include "staggered/domain/boundary.hpp"

namespace lockstep::test {

namespace {

constexpr double g = 9.81;

/// Still water from y = -0.2 to 0.3, a wave 1 m long.
InflowWave<2> wave(double height) {
  InflowWave<2> result;
  result.height = height;
  result.period = 2 * M_PI / 7.836343;
  result.depth = 0.5;
  result.level = 0.3;
  result.gravity = g;
  result.up = Point<2>(0, 1);
  result.inward = Point<2>(1, 0);
  result.number = wave_number(result.frequency(), g, 0.5);
  return result;
}

/// Flow through the side up to a wave that rises with a sin(omega t), mean over a period.
double mean_flow(const InflowWave<2>& w) {
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n * w.period;
    const double surface = w.level + w.height / 2 * std::sin(w.frequency() * t);
    const Box<2> below(Point<2>(0, -0.2), Point<2>(0, surface));
    sum += w.mean_velocity(below, t)[0] * (surface + 0.2) / n;
  }
  return sum;
}

}  // namespace

TEST(InflowWave, ItsNumberIsThatOfTheDispersionRelation) {
  EXPECT_NEAR(wave_number(7.836343, g, 0.5), 2 * M_PI, 1e-6);
  for (const double omega : {1e-3, 0.1, 1., 30., 1e4})
    for (const double depth : {1e-3, 0.5, 100.}) {
      const double k = wave_number(omega, g, depth);
      EXPECT_NEAR(g * k * std::tanh(k * depth) / (omega * omega), 1, 1e-12)
          << omega << " " << depth;
    }
}

TEST(InflowWave, MovesAsBelowAWave) {
  const InflowWave<2> w = wave(0.02);
  const double k = w.number, a = 0.01, omega = w.frequency();
  const double back = a * a * g / (2 * w.speed()) / 0.5;
  for (const double t : {0., 0.1, 0.33}) {
    for (const double y : {-0.2, 0., 0.3}) {
      const Point<2> v = w.velocity_at({0, y}, t);
      const double scale = a * omega / std::sinh(k * 0.5);
      EXPECT_NEAR(v[0], scale * std::cosh(k * (y + 0.2)) * std::sin(omega * t) - back, 1e-13);
      EXPECT_NEAR(v[1], scale * std::sinh(k * (y + 0.2)) * std::cos(omega * t), 1e-13);
    }
    EXPECT_EQ(w.velocity_at({0, 0.4}, t), w.velocity_at({0, 0.3}, t));
  }
}

TEST(InflowWave, GrowsFromNothing) {
  InflowWave<2> w = wave(0.02);
  w.ramp_time = 2;
  for (const double t : {-1., 0.})
    EXPECT_EQ(w.velocity_at({0, 0.2}, t), Point<2>(0, 0));
  const Point<2> grown = w.velocity_at({0, 0.2}, 2.5);
  w.ramp_time = 0;
  EXPECT_EQ(w.velocity_at({0, 0.2}, 2.5), grown);
}

TEST(InflowWave, MeansOverFacesAreIntegrals) {
  InflowWave<2> w = wave(0.02);
  w.ramp_time = 0.1 / 0.7;
  for (const auto& [lower, upper] :
       {std::pair{-0.2, -0.1}, {0.1, 0.25}, {0.25, 0.35}, {0.31, 0.4}, {-0.3, 0.4}}) {
    constexpr int n = 2000;
    Point<2> sum(0, 0);
    for (int i = 0; i < n; ++i)
      sum += w.velocity_at({0, lower + (upper - lower) * (i + 0.5) / n}, 0.1) / n;
    const Point<2> mean = w.mean_velocity({Point<2>(0, lower), Point<2>(0, upper)}, 0.1);
    EXPECT_LT((mean - sum).norm(), 1e-7) << lower << " to " << upper;
  }
}

/// Without the return flow g a^2 / 2c would come in, and the tank would fill.
TEST(InflowWave, NeitherFillsNorEmptiesTheTank) {
  const InflowWave<2> w = wave(0.002);
  EXPECT_LT(std::abs(mean_flow(w)), 0.01 * g * 1e-6 / (2 * w.speed()));
}

TEST(InflowWave, GoesInwardsFromEitherSide) {
  for (const int end : {0, 1}) {
    Case<2> scene({16, 16}, 0.0625);
    ParameterList& side =
        scene.side(side_name(0, end), "inflow").domain.sublist("Sides").sublist(side_name(0, end));
    ParameterList& list = side.sublist("Wave");
    list.set("Ramp Time", 2.0);
    list.set("Height", 0.02);
    list.set("Frequency", 1.25);
    scene.fluid.set("Gravity", numbers({0, -g}));
    ParameterList& liquids = scene.fluid.sublist("Free Surface").sublist("Liquid");
    liquids.sublist("Tank").set("Type", std::string("level")).set("Height", 0.5);
    validate(scene.domain, domain_parameters<2>(), Source{"test", {}}, "Domain");
    auto description = read_domain<2>(scene.domain);
    read_waves<2>(scene.fluid, scene.domain, description);
    const BoundarySide<2>& made = description.boundary.side(0, end);
    ASSERT_TRUE(made.wave && made.moves());
    EXPECT_EQ(made.wave->depth, 0.5);
    EXPECT_GT(made.velocity_at(0, Point<2>(end, 0.5), 1)[0] * (end == 0 ? 1 : -1),
              0);  // 1 s: 1.25 periods
    EXPECT_FALSE(description.boundary.side(1, 0).wave);
  }
}

}  // namespace lockstep::test
