// One contact with friction: Coulomb's law to round-off, for mobilities that mix its directions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "contact/impulses/coulomb.hpp"

namespace lockstep::test {
namespace {

template <int dim>
CoulombContact<dim> contact(const Eigen::Matrix<double, dim, dim>& mobility, double friction) {
  return {mobility, mobility.inverse(), friction};
}

/// Largest violation of Coulomb's law, over |v|, and the state: 0 open, 1 sticks, 2 slips.
template <int dim>
std::pair<double, int> violation(const CoulombContact<dim>& contact, const Point<dim>& v,
                                 const Point<dim>& impulse) {
  const Point<dim> w = v + contact.mobility * impulse;
  const double unit = contact.mobility.trace();
  const auto slip = w.template tail<dim - 1>();
  const auto friction = impulse.template tail<dim - 1>();
  const double bound = contact.friction * impulse[0];
  double worst = std::max({0.0, -w[0], -unit * impulse[0], unit * (friction.norm() - bound)});
  if (impulse[0] > 0)
    worst = std::max(worst, w[0]);
  const bool slips = slip.norm() > 1e-9 * v.norm();
  if (impulse[0] > 0 && slips)
    worst = std::max(worst, unit * (friction + bound * slip / slip.norm()).norm());
  return {worst / v.norm(), impulse[0] == 0 ? 0 : slips ? 2 : 1};
}

template <typename T>
class Coulomb : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Coulomb, Dimensions);

/// Masses differ by axis, up to a thousand to one, as lumped fluid makes them, and the contact lies
/// askew: normal impulses then move it sideways more than along themselves.
TYPED_TEST(Coulomb, LawHoldsToRoundOff) {
  constexpr int dim = TypeParam::value;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::array<int, 3> n_states{};
  for (int n = 0; n < 20000; ++n) {
    Eigen::Matrix<double, dim, dim> axes;
    Point<dim> v, by_axis;
    for (int a = 0; a < dim; ++a) {
      v[a] = uniform(random);
      by_axis[a] = std::pow(10, 1.5 * uniform(random));
      for (int b = 0; b < dim; ++b)
        axes(a, b) = uniform(random);
    }
    axes = Eigen::HouseholderQR<Eigen::Matrix<double, dim, dim>>(axes).householderQ();
    const auto one = contact<dim>(axes * by_axis.asDiagonal() * axes.transpose(),
                                  0.05 + 0.95 * std::abs(uniform(random)));
    const auto [worst, state] =
        violation<dim>(one, v, coulomb_impulse<dim>(one, v, Point<dim>::Zero()));
    EXPECT_LT(worst, 1e-9) << n;
    ++n_states[state];
  }
  for (const int n_of_state : n_states)
    EXPECT_GT(n_of_state, 1000);
}

/// By hand: a block of mass m thrown at the floor. Its friction stops at most mu times what the
/// floor stops.
TYPED_TEST(Coulomb, ABlockThrownAtAFloor) {
  constexpr int dim = TypeParam::value;
  const double m = 2, mu = 0.3;
  const Eigen::Matrix<double, dim, dim> mobility = Eigen::Matrix<double, dim, dim>::Identity() / m;
  const auto block = contact<dim>(mobility, mu);
  Point<dim> v = Point<dim>::Zero();
  v[0] = -1;
  v[dim - 1] = 0.2;
  const Point<dim> stops = coulomb_impulse<dim>(block, v, Point<dim>::Zero());
  EXPECT_LT((stops + m * v).norm(), 1e-15);
  v[dim - 1] = 5;
  const Point<dim> slides = coulomb_impulse<dim>(block, v, Point<dim>::Zero());
  EXPECT_NEAR(slides[0], m, 1e-15);
  EXPECT_NEAR(slides[dim - 1], -mu * m, 1e-14);
  v[0] = 0.1;
  EXPECT_EQ(coulomb_impulse<dim>(block, v, slides), (Point<dim>::Zero()));
}

/// The answer does not depend on what was before, but for the choice among several.
TEST(Coulomb3D, LastDirectionOnlySpeedsUp) {
  Eigen::Matrix3d mobility;
  mobility << 2, 0.5, -0.3, 0.5, 1, 0.1, -0.3, 0.1, 1.5;
  const auto one = contact<3>(mobility, 0.4);
  const Point<3> v(-1, 2, -3);
  const Point<3> fresh = coulomb_impulse<3>(one, v, Point<3>::Zero());
  for (const double angle : {0.0, 1.0, 2.5, 4.0, 5.5}) {
    const Point<3> last(1, std::cos(angle), std::sin(angle));
    EXPECT_LT((coulomb_impulse<3>(one, v, last) - fresh).norm(), 1e-13) << angle;
  }
}

}  // namespace
}  // namespace lockstep::test
