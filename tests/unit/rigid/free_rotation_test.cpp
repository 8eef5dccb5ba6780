// Bodies that no torque acts on, against solutions in closed form, at any turn.
#include "motion/free_rotation.hpp"

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>

#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

const std::vector<double> turns{0.1, 0.2, 0.5, 1, 2, 4};  // rad a step

struct Spun {
  Orientation<3> orientation = Orientation<3>::Identity();
  double largest_change = 0;  ///< relative change of the energy
};

/// `n_steps` of dt, from axes along those of space.
Spun spun(const Point<3>& moments, const Point<3>& momentum, double dt, int n_steps) {
  Spun result;
  const auto energy = [&] {
    const Point<3> own = result.orientation.inverse() * momentum;
    return own.dot(own.cwiseQuotient(moments));
  };
  const double start = energy();
  for (int step = 0; step < n_steps; ++step) {
    const Eigen::Matrix3d axes = result.orientation.toRotationMatrix();
    const Eigen::Matrix3d inertia = axes * moments.asDiagonal() * axes.transpose();
    result.orientation = turned<3>(free_turn<3>(inertia, momentum, dt), result.orientation);
    result.largest_change = std::max(result.largest_change, std::abs(energy() / start - 1));
  }
  return result;
}

TEST(FreeRotation, ASymmetricTopPrecesses) {
  const double across = 1, along = 1.7;
  const Point<3> omega(0.6, 0, 0.8);
  const Point<3> momentum(across * omega.x(), 0, along * omega.z());
  for (const double turn : turns) {
    const int n_steps = 20;
    const double time = n_steps * turn;  // omega is 1 rad/s
    const Spun top = spun({across, across, along}, momentum, turn, n_steps);
    // About the momentum with |L| / I, and about its own axis with what is left.
    const Orientation<3> exact =
        rotation_of<3>(time / across * momentum) *
        rotation_of<3>(Point<3>(0, 0, time * (1 - along / across) * omega.z()));
    EXPECT_LT(top.orientation.angularDistance(exact), 1e-8 * n_steps * turn);
    EXPECT_LT(top.largest_change, 1e-13);
  }
}

/// About its middle axis, with a little of the others, a body turns over and over.
TEST(FreeRotation, AnAsymmetricTopFollowsJacobi) {
  const Point<3> moments(1, 2, 3.5);
  const Point<3> start(0.02, 1, 0.015);
  const Point<3> momentum = moments.cwiseProduct(start);
  // Landau & Lifshitz, Mechanics, 37: omega_2 is a sine amplitude.
  const double energy2 = start.dot(momentum), square = momentum.squaredNorm();
  ASSERT_GT(square, energy2 * moments[1]);
  const double i1 = moments[0], i2 = moments[1], i3 = moments[2];
  const double speed = std::sqrt((i3 - i2) * (square - energy2 * i1) / (i1 * i2 * i3));
  const double modulus =
      std::sqrt((i2 - i1) * (energy2 * i3 - square) / ((i3 - i2) * (square - energy2 * i1)));
  const double largest1 = std::sqrt((energy2 * i3 - square) / (i1 * (i3 - i1)));
  const double largest2 = std::sqrt((energy2 * i3 - square) / (i2 * (i3 - i2)));
  const double largest3 = std::sqrt((square - energy2 * i1) / (i3 * (i3 - i1)));
  const auto omega_at = [&](double phase) {
    double cn = 0, dn = 0;
    const double sn = boost::math::jacobi_elliptic(modulus, phase, &cn, &dn);
    return Point<3>(largest1 * cn, largest2 * sn, largest3 * dn);
  };
  // omega_2' = (i3 - i1) omega_3 omega_1 / i2 > 0: the phase of the start, by bisection.
  double low = 0, high = 0;
  while (omega_at(high)[0] > start[0])
    high += 0.01;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (omega_at(middle)[0] > start[0] ? low : high) = middle;
  }
  for (const double turn : turns) {
    const int n_steps = static_cast<int>(60 / turn);
    const Spun top = spun(moments, momentum, turn, n_steps);
    const Point<3> own = top.orientation.inverse() * momentum;
    const Point<3> exact = moments.cwiseProduct(omega_at(low + speed * turn * n_steps));
    EXPECT_LT((own - exact).norm(), 1e-5);  // errors of some 1e-10 grow as the unstable motion does
    EXPECT_LT(top.largest_change, 1e-12);
  }
}

TEST(FreeRotation, RodsAndPlatesToo) {
  for (const Point<3>& moments :
       {Point<3>(1e-4, 1, 1), Point<3>(1e-4, 1, 1.0001), Point<3>(1, 1 + 1e-9, 2 + 1e-9)}) {
    for (const double turn : turns) {
      const Point<3> momentum = moments.cwiseProduct(Point<3>(0.3, 1, -0.4));
      const Spun top = spun(moments, momentum, turn, 20);
      EXPECT_LT(top.largest_change, 1e-9);
    }
  }
}

TEST(FreeRotation, WholeTurnsCount) {
  const Eigen::Matrix3d inertia = Point<3>(1, 1.001, 0.999).asDiagonal();
  const Point<3> momentum(3, 4, 12);
  EXPECT_LT((free_turn<3>(inertia, momentum, 2) - 2 * momentum).norm(), 1);
  EXPECT_EQ(free_turn<3>(inertia, Point<3>(0, 0, 0), 2), Point<3>(0, 0, 0));
  EXPECT_EQ(free_turn<2>(Inertia<2>(2.), AngularVector<2>(3.), 4)(0), 6);
}

TEST(FreeRotation, WhatIsNotFiniteStaysSo) {
  const Inertia<3> inertia = Point<3>(1, 2, 3).asDiagonal();
  for (const double bad : {std::nan(""), 1. / 0.})
    EXPECT_FALSE(free_turn<3>(inertia, Point<3>(1, bad, 1), 0.1).allFinite());
}

/// The fluid about a light body takes most of a torque. Were it the body's alone to answer, the
/// motion that it sets out on would be one of ten turns a step.
TEST(FreeRotation, OnlyUnseenBodiesSetOutWithTheirLoad) {
  const auto correction = [](const std::string& more) {
    const auto bodies =
        model<3>({geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "0.01") +
                  numbers("Angular Velocity", "1, 2, -0.5") + more});
    Vector result(bodies->dof_map());
    bodies->add_midpoint_correction(0.05, result);
    return result.norm2();
  };
  const std::string torque = numbers("Torque", "4, -6, 9"),
                    unseen = "<Parameter name=\"Seen by Fluid\" type=\"bool\" value=\"false\"/>";
  const double free = correction("");
  EXPECT_GT(free, 1e-4);
  EXPECT_EQ(correction(torque), free);
  EXPECT_EQ(correction(unseen), free);
  EXPECT_GT(correction(torque + unseen), 10 * free);
}

/// With a torque along axes of space, against steps so small that they are exact.
TEST(FreeRotation, StepsUnderATorqueAreOfSecondOrder) {
  const auto spun_up = [](int n_steps) {
    RigidBody<3> b = body<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12") +
                             numbers("Angular Velocity", "1, 2, -0.5"));
    const double dt = 2. / n_steps;
    RigidVector<3> impulse;
    impulse << 0, 0, 0, dt * Point<3>(4, -6, 9);
    for (int step = 0; step < n_steps; ++step) {
      const RigidVector<3> half = b.momentum + 0.5 * impulse;
      const RigidVector<3> at_middle = half + midpoint_correction<3>(b, half, dt / 2);
      move(b, velocity_of(b, b.pose.orientation, at_middle), 0, dt);
      set_velocity(b, velocity_of<3>(b, b.pose.orientation, b.momentum + impulse));
    }
    return b.pose.orientation;
  };
  const Orientation<3> fine = spun_up(4096);
  const double coarse = spun_up(16).angularDistance(fine), half = spun_up(32).angularDistance(fine);
  EXPECT_LT(half, 0.02);
  EXPECT_NEAR(std::log2(coarse / half), 2, 0.2);
}

/// A hull with ballast whose own moments are those of a symmetric top, 2, 2 and 3 kg m^2, about a
/// centre beside that of its box: the axis goes round the angular momentum L at the rate L / 2, and
/// the centre of mass, not the centroid, flies straight on.
TEST(FreeRotation, ABodyWithItsOwnInertiaPrecesses) {
  auto b = body<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12") +
                   numbers("Center of Mass", "0.1, 0.3, -0.7") + numbers("Inertia", "2, 2, 3") +
                   numbers("Velocity", "1, 0, 0") + numbers("Angular Velocity", "0.5, 0, 2"));
  const Point<3> angular_momentum(1, 0, 6);
  const double rate = angular_momentum.norm() / 2, dt = 0.01;
  const Point<3> start = b.center(), axis = b.pose.orientation * Point<3>::UnitZ();
  const double energy = kinetic_energy(b);
  double time = 0;
  for (int step = 0; step < 200; ++step, time += dt)
    free_step(b, time, dt);
  const Point<3> expected = Eigen::AngleAxisd(rate * time, angular_momentum.normalized()) * axis;
  EXPECT_LE((b.pose.orientation * Point<3>::UnitZ() - expected).norm(), 1e-4);
  EXPECT_LE((b.momentum.tail<3>() - angular_momentum).norm(), 1e-12);
  EXPECT_LE((b.center() - start - Point<3>(time, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(kinetic_energy(b), energy, 1e-5 * energy);
}

}  // namespace
}  // namespace lockstep::test
