// Spin and swing without a fluid: conservation, order, bounded energy.
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

/// A box that turns about its middle axis, with a little of the others: it tumbles.
RigidBody<3> tumbling_box(const std::string& more = "") {
  return body<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12") +
                 numbers("Angular Velocity", "0.01, 1, 0.02") + more);
}

TEST(FreeMotion, TumblingBoxKeepsMomentumAndEnergy) {
  RigidBody<3> b = tumbling_box();
  const double energy = kinetic_energy(b);
  const RigidVector<3> momentum = b.momentum;
  double largest_change = 0, lowest_spin = 1;
  for (int step = 0; step < 10000; ++step) {
    free_step(b, 0.1 * step, 0.1);
    largest_change = std::max(largest_change, std::abs(kinetic_energy(b) / energy - 1));
    lowest_spin = std::min(lowest_spin, (b.pose.orientation * Point<3>(0, 1, 0)).y());
  }
  EXPECT_LE((b.momentum - momentum).norm(), 1e-11 * momentum.norm());
  EXPECT_LE(largest_change, 1e-10);
  EXPECT_LE(lowest_spin, -0.9);  // it did turn over
}

/// Direction of a body-fixed vector after one second. With a lock, though none that its turning
/// feels, bodies move by the velocity at the middle of the step.
Point<3> direction_after(int n_steps, bool corrected, const std::string& lock = "x") {
  RigidBody<3> b = tumbling_box(numbers("Velocity", "0, 0, 0") + texts("Locked", lock));
  set_velocity(b, (RigidVector<3>() << 0, 0, 0, 2, 3, -1).finished());
  for (int step = 0; step < n_steps; ++step) {
    if (corrected) {
      free_step(b, 0, 1.0 / n_steps);
    } else {
      move(b, b.velocity, 0, 1.0 / n_steps);
      set_velocity(b, velocity_of(b, b.pose.orientation, b.momentum));
    }
  }
  return b.pose.orientation * Point<3>(1, 0, 0);
}

/// Direction after one second by RK4 on Euler's equations in small steps.
Point<3> exact_direction() {
  const RigidBody<3> b = tumbling_box();
  const AngularVector<3> momentum = b.inertia * Point<3>(2, 3, -1);
  using Q = Eigen::Vector4d;  // coefficients x, y, z, w
  const auto rate = [&](const Q& q) {
    const Eigen::Quaterniond turn(q);
    const Eigen::Matrix3d r = turn.toRotationMatrix();
    const Point<3> omega = r * b.inertia.inverse() * r.transpose() * momentum;
    return Q(0.5 * (Eigen::Quaterniond(0, omega.x(), omega.y(), omega.z()) * turn).coeffs());
  };
  Q q(0, 0, 0, 1);
  const int n = 2000;
  for (int step = 0; step < n; ++step) {
    const double dt = 1.0 / n;
    const Q k1 = rate(q), k2 = rate(q + 0.5 * dt * k1), k3 = rate(q + 0.5 * dt * k2),
            k4 = rate(q + dt * k3);
    q = (q + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).normalized();
  }
  return Eigen::Quaterniond(q) * Point<3>(1, 0, 0);
}

TEST(FreeMotion, SpinIsOfSecondOrder) {
  const Point<3> exact = exact_direction();
  const double coarse = (direction_after(20, true) - exact).norm();
  const double fine = (direction_after(40, true) - exact).norm();
  EXPECT_LE(fine, 5e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
  // Nothing but the pivot, or nothing at all: exact.
  EXPECT_LE((direction_after(20, true, "x, y, z") - exact).norm(), 1e-8);
  // Without the correction of S1 the error would be of first order.
  EXPECT_GE((direction_after(40, false) - exact).norm(), 5 * fine);
}

TEST(FreeMotion, BallNeedsNoCorrection) {
  const auto b = body<3>(geometry("ball", number("Radius", "0.3")) + number("Density", "1") +
                         numbers("Angular Velocity", "5, 6, 7"));
  EXPECT_EQ(midpoint_correction(b, b.momentum, 0.1).norm(), 0);
}

/// A pivot that nothing holds leaves the motion that of the centre of mass.
template <int dim>
void expect_free_pivot(const std::string& common, const std::string& pivot,
                       const RigidVector<dim>& spin) {
  RigidBody<dim> b = body<dim>(common + pivot);
  RigidVector<dim> velocity = spin;  // at the pivot, so that the centre of mass rests
  velocity.template head<dim>() = -rotate<dim>(spin.template tail<n_rotations<dim>>(), b.arm());
  set_velocity(b, velocity);
  const Point<dim> center = b.pose.position + b.arm();
  const double energy = kinetic_energy(b);
  double largest_change = 0;
  for (int step = 0; step < 500; ++step) {
    free_step(b, 0, 0.02);
    EXPECT_LE(b.momentum.template head<dim>().norm(), 1e-11);
    largest_change = std::max(largest_change, std::abs(kinetic_energy(b) / energy - 1));
  }
  EXPECT_LE(largest_change, 1e-11);
  EXPECT_LE((b.pose.position + b.arm() - center).norm(), 1e-11);
}

TEST(FreeMotion, AnUnheldPivotChangesNothing) {
  expect_free_pivot<2>(geometry("box", numbers("Size", "1, 2")) + number("Mass", "2"),
                       numbers("Pivot", "0.5, 0.3"), RigidVector<2>(0, 0, 1));
  expect_free_pivot<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12"),
                       numbers("Pivot", "0.2, 0.3, 0"),
                       (RigidVector<3>() << 0, 0, 0, 0.2, 1, -0.3).finished());
}

TEST(FreeMotion, AFlyingBodyKeepsMomentumAndSpinWhateverItsPivot) {
  RigidBody<2> b = body<2>(geometry("box", numbers("Size", "1, 2")) + number("Mass", "2") +
                           numbers("Pivot", "0.5, 0.3") + numbers("Velocity", "3, 1") +
                           number("Angular Velocity", "1"));
  const Point<2> free_motion = b.velocity_of_center();
  for (int step = 0; step < 100; ++step)
    free_step(b, 0, 0.05);
  EXPECT_NEAR(b.angular_velocity()(0), 1, 1e-12);
  EXPECT_LE((b.velocity_of_center() - free_motion).norm(), 1e-12);
}

TEST(FreeMotion, HingedPlateTurnsUniformly) {
  RigidBody<2> b = body<2>(geometry("plate", numbers("Size", "2, 0") + text("Normal", "y")) +
                           number("Mass", "3") + numbers("Pivot", "-1, 0") +
                           texts("Locked", "x, y") + number("Angular Velocity", "1.5"));
  for (int step = 0; step < 100; ++step)
    free_step(b, 0, 0.1);
  EXPECT_EQ(b.pose.position, Point<2>(-1, 0));
  EXPECT_NEAR(b.angular_velocity()(0), 1.5, 1e-12);
  EXPECT_NEAR(b.pose.orientation.angle(), 15, 1e-11);
  EXPECT_NEAR(b.momentum[2], 3 * 4.0 / 3 * 1.5, 1e-11);  // m l^2 / 3
}

}  // namespace
}  // namespace lockstep::test
