// The cases of advection_test.cpp at the sizes for which figures are known.
#include <gtest/gtest.h>

#include "advection_cases.hpp"

namespace lockstep::test {
namespace {

TEST(LargeAdvection, TheVortexGivesTheDiscBack) {
  const Return plain = vortex("particle level set", uncorrected(), 128);
  EXPECT_LT(std::abs(plain.loss), 0.017);
  EXPECT_LT(plain.shape, 0.0204);
}

TEST(LargeAdvection, FractionsLoseNothing) {
  const Return tail = vortex("volume of fluid", {}, 128, 8, 0.25);
  EXPECT_LT(std::abs(tail.ledger), 1e-13);
  EXPECT_LT(tail.shape, 0.0288);
}

TEST(LargeAdvection, TheSheetBecomesABallAgain) {
  const Return plain = deformation("particle level set", uncorrected(), 64);
  EXPECT_LT(std::abs(plain.loss), 0.103);
  EXPECT_LT(plain.shape, 0.106);
}

}  // namespace
}  // namespace lockstep::test
