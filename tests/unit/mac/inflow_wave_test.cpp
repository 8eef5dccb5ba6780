// Velocities that a wavemaker side prescribes, against linear theory, and theories of higher order
// against what a wave of permanent form has to obey: at the surface of the frame that goes with it
// water flows along the surface, and the head is the same.
#include "staggered/domain/inflow_wave.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mac_cases.hpp"
#include "staggered/domain/boundary.hpp"

namespace lockstep::test {

namespace {

constexpr double g = 9.81;

constexpr double depth = 0.5, period = 2 * M_PI / 7.836343;  // a wave 1 m long

std::shared_ptr<const WaveTheory> theory(const std::string& name, double height) {
  return make_wave(name, {height, name == "solitary" ? 0 : period, depth, g}, "Test");
}

/// Still water from y = -0.2 to 0.3.
InflowWave<2> wave(double height, const std::string& name = "Airy") {
  InflowWave<2> result;
  result.theory = theory(name, height);
  result.depth = depth;
  result.level = 0.3;
  result.up = Point<2>(0, 1);
  result.inward = Point<2>(1, 0);
  return result;
}

/// Flow through the side up to the surface, a sin(omega t) in linear theory, mean over a period.
double mean_flow(const InflowWave<2>& w, double amplitude) {
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n * period;
    const double airy = amplitude * std::sin(2 * M_PI / period * t);
    const double surface = w.level + (amplitude > 0 ? airy : w.theory->top(t, 1));
    const Box<2> below(Point<2>(0, -0.2), Point<2>(0, surface));
    sum += w.mean_velocity(below, t)[0] * (surface + 0.2) / n;
  }
  return sum;
}

/// Greatest and mean of `flow` over a period [m^2/s].
std::pair<double, double> flows(const InflowWave<2>& w) {
  constexpr int n = 400;
  double greatest = 0, mean = 0;
  for (int i = 0; i < n; ++i) {
    const double flow = w.flow((i + 0.5) / n * period);
    greatest = std::max(greatest, flow);
    mean += flow / n;
  }
  return {greatest, mean};
}

/// Largest normal velocity at the surface over the speed, and spread of the head over g H, in the
/// frame of the wave.
std::pair<double, double> misfit(const WaveTheory& wave, double height) {
  constexpr int n = 2000;
  const double c = wave.speed(), h = 1e-5;
  double normal = 0, least = 1e9, most = -1e9;
  for (int i = 0; i < n; ++i) {
    const double t = i * wave.length() / c / n;
    const double z = wave.top(t, 1);
    const WaveMotion motion = wave.motion(z, t, 1);
    const double slope = -(wave.top(t + h, 1) - wave.top(t - h, 1)) / (2 * h * c);
    normal = std::max(normal, std::abs(motion.upward - (motion.along - c) * slope) / c);
    const double head =
        0.5 * (std::pow(motion.along - c, 2) + motion.upward * motion.upward) / g + z;
    least = std::min(least, head);
    most = std::max(most, head);
  }
  return {normal, (most - least) / height};
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
  const double k = 2 * M_PI / w.theory->length(), a = 0.01, omega = 2 * M_PI / period;
  const double back = a * a * g / (2 * w.theory->speed()) / depth;
  for (const double t : {0., 0.1, 0.33}) {
    for (const double y : {-0.2, 0., 0.3}) {
      const Point<2> v = w.velocity_at({0, y}, t);
      const double scale = a * omega / std::sinh(k * depth);
      EXPECT_NEAR(v[0], scale * std::cosh(k * (y + 0.2)) * std::sin(omega * t) - back, 1e-13);
      EXPECT_NEAR(v[1], scale * std::sinh(k * (y + 0.2)) * std::cos(omega * t), 1e-13);
    }
    EXPECT_EQ(w.velocity_at({0, 0.4}, t), w.velocity_at({0, 0.3}, t));
  }
}

/// Water that comes in lifts the surface: q = c eta in linear theory.
TEST(InflowWave, BringsWhatItsCrestsHold) {
  for (const char* name : {"Airy", "Stokes 2", "Stokes 5"}) {
    InflowWave<2> w = wave(0.02, name);
    w.period = period;
    const auto [greatest, mean] = flows(w);
    EXPECT_NEAR(mean, 0, 1e-6 * greatest) << name;
    EXPECT_NEAR(greatest / (w.theory->speed() * 0.01), 1, name[0] == 'A' ? 1e-4 : 0.04) << name;
    const double without = w.velocity_at({0, 0.1}, 0.3)[0], flow = w.flow(0.3);
    w.stream = 0.5;
    EXPECT_NEAR(w.velocity_at({0, 0.1}, 0.3)[0] - without, 0.5, 1e-15);
    EXPECT_EQ(w.flow(0.3), flow);
  }
}

TEST(InflowWave, GrowsFromNothing) {
  for (const char* name : {"Airy", "Stokes 5"}) {
    InflowWave<2> w = wave(0.02, name);
    w.ramp_time = 2;
    for (const double t : {-1., 0.})
      EXPECT_EQ(w.velocity_at({0, 0.2}, t), Point<2>(0, 0));
    const Point<2> grown = w.velocity_at({0, 0.2}, 2.5);
    w.ramp_time = 0;
    EXPECT_EQ(w.velocity_at({0, 0.2}, 2.5), grown);
  }
}

/// Half the height leaves, of an expansion to the order n, 1 / 2^(n + 1) of the misfit, over the
/// height 1 / 2^n.
TEST(WaveTheory, HoldsAtTheSurfaceToItsOrder) {
  const auto ratio = [](const char* name, double height) {
    const auto [normal, head] = misfit(*theory(name, height), height);
    const auto [half_normal, half_head] = misfit(*theory(name, height / 2), height / 2);
    return std::pair{normal / half_normal, head / half_head};
  };
  const auto [normal_2, head_2] = ratio("Stokes 2", 0.04);
  EXPECT_NEAR(normal_2, 8, 1.2);
  EXPECT_NEAR(head_2, 4, 0.8);
  const auto [normal_5, head_5] = ratio("Stokes 5", 0.06);
  EXPECT_NEAR(normal_5, 64, 10);
  EXPECT_NEAR(head_5, 32, 5);
  const auto [normal_solitary, head_solitary] = ratio("solitary", 0.1);
  EXPECT_GT(normal_solitary, 15);
  EXPECT_NEAR(head_solitary, 8, 2);
}

/// Figures of Fenton's coefficients as his table has them, by a script.
TEST(WaveTheory, TheFifthOrderIsFasterAndHasSharperCrests) {
  const double height = 0.06;
  const auto airy = theory("Airy", height), fifth = theory("Stokes 5", height);
  EXPECT_NEAR(fifth->speed() / airy->speed(), 1.023185158, 1e-7);
  EXPECT_NEAR(fifth->top(period / 4, 1) / height, 0.5489756482, 1e-8);
  EXPECT_NEAR(fifth->top(-period / 4, 1) / height, 0.5489756482 - 1, 1e-8);
  EXPECT_NEAR(fifth->motion(0, period / 4, 0).along, 0, 0);
}

TEST(WaveTheory, WaterIsKept) {
  constexpr double h = 1e-4;
  for (const char* name : {"Stokes 2", "Stokes 5", "solitary"}) {
    const auto w = theory(name, 0.04);
    for (const double t : {0.1, 0.6, 1.2})
      for (const double z : {-0.4, -0.1}) {
        // It goes by with its speed, so that d/dx is -1/c d/dt.
        const double along =
            (w->motion(z, t + h, 1).along - w->motion(z, t - h, 1).along) / (2 * h);
        const double up = (w->motion(z + h, t, 1).upward - w->motion(z - h, t, 1).upward) / (2 * h);
        EXPECT_NEAR(up - along / w->speed(), 0, name[1] == 'o' ? 2e-4 : 1e-6) << name << t << z;
      }
    EXPECT_NEAR(w->motion(-depth, 0.3, 1).upward, 0, 1e-15);
  }
}

TEST(WaveTheory, WhatBreaksIsRefused) {
  EXPECT_THROW(theory("Stokes 5", 0.15), InputError);
  EXPECT_THROW(theory("solitary", 0.4), InputError);
  EXPECT_THROW(make_wave("Stokes 2", {0.1, 5, depth, g}, "Test"), InputError);  // Ursell's number
}

TEST(InflowWave, MeansOverFacesAreIntegrals) {
  for (const char* name : {"Airy", "Stokes 5"})
    for (const auto& [lower, upper] :
         {std::pair{-0.2, -0.1}, {0.1, 0.25}, {0.25, 0.35}, {0.31, 0.4}, {-0.3, 0.4}}) {
      InflowWave<2> w = wave(0.02, name);
      w.ramp_time = 0.1 / 0.7;
      constexpr int n = 2000;
      Point<2> sum(0, 0);
      for (int i = 0; i < n; ++i)
        sum += w.velocity_at({0, lower + (upper - lower) * (i + 0.5) / n}, 0.1) / n;
      const Point<2> mean = w.mean_velocity({Point<2>(0, lower), Point<2>(0, upper)}, 0.1);
      EXPECT_LT((mean - sum).norm(), 2e-6) << name << lower << " to " << upper;
    }
}

/// Without the return flow g a^2 / 2c would come in, and the tank would fill.
TEST(InflowWave, NeitherFillsNorEmptiesTheTank) {
  const InflowWave<2> airy = wave(0.002);
  EXPECT_LT(std::abs(mean_flow(airy, 0.001)), 0.01 * g * 1e-6 / (2 * airy.theory->speed()));
  const InflowWave<2> fifth = wave(0.05, "Stokes 5");
  EXPECT_LT(std::abs(mean_flow(fifth, 0)), 1e-2 * g * 0.025 * 0.025 / (2 * fifth.theory->speed()));
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
