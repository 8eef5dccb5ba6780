#include "coupling/momentum_ledger.hpp"

#include <gtest/gtest.h>

namespace lockstep::test {
namespace {

Momentum<3> momentum_3d(const Point<3>& linear, const Point<3>& angular) {
  Momentum<3> result;
  result.linear = linear;
  result.angular = angular;
  return result;
}

}  // namespace

TEST(MomentumLedger, BalancedBudgetsHaveNoError) {
  MomentumLedger<3> ledger;
  ledger.open(momentum_3d({1, 0, 0}, {0, 0, 2}));
  ledger.add("gravity", momentum_3d({0, 0, -3}, {1, 0, 0}));
  ledger.add("wall", momentum_3d({0, 0, 1}, {0, 1, 0}));
  ledger.add("wall", momentum_3d({0, 0, 1}, {0, 1, 0}));
  ledger.close(momentum_3d({1, 0, -1}, {1, 2, 2}));
  EXPECT_EQ(ledger.linear_error(), 0);
  EXPECT_EQ(ledger.angular_error(1), 0);
  EXPECT_EQ(ledger.impulse_of("wall").linear.z(), 2);
  EXPECT_EQ(ledger.total_impulse().linear.z(), -1);
}

TEST(MomentumLedger, ErrorIsRelativeToTheLargestOfImpulsesAndMomentum) {
  MomentumLedger<3> ledger;
  ledger.open(momentum_3d({0, 0, 0}, {0, 0, 0}));
  ledger.add("push", momentum_3d({4, 0, 0}, {0, 0, 0}));
  ledger.add("pull", momentum_3d({-4, 0, 0}, {0, 0, 0}));
  ledger.close(momentum_3d({0, 0.8, 0}, {0, 0, 0.4}));
  EXPECT_DOUBLE_EQ(ledger.linear_error(), 0.8 / 8);
  EXPECT_DOUBLE_EQ(ledger.angular_error(2), 0.4 / 16);  // 2 m times the linear scale
}

TEST(MomentumLedger, NothingMovesNoError) {
  MomentumLedger<3> ledger;
  ledger.open({});
  ledger.close({});
  EXPECT_EQ(ledger.linear_error(), 0);
  EXPECT_EQ(ledger.angular_error(1), 0);
}

}  // namespace lockstep::test
