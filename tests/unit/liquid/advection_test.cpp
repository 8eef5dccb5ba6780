// Bodies that a flow should bring back as they were. The bounds are a fifth above what a separate
// prototype of the method has shown, unless they say otherwise.
#include <gtest/gtest.h>

#include "advection_cases.hpp"

namespace lockstep::test {
namespace {

TEST(Advection, ZalesaksDiscKeepsItsSlot) {
  const Return plain = zalesak("particle level set", uncorrected());
  EXPECT_LT(std::abs(plain.loss), 0.036);
  EXPECT_LT(plain.shape, 0.048);
  const Return corrected = zalesak("particle level set", {});
  EXPECT_LT(std::abs(corrected.ledger), 1e-9);
  EXPECT_LT(std::abs(corrected.loss), 0.002);
  EXPECT_LT(corrected.shape, 0.053);
  EXPECT_EQ(corrected.n_components, 1);
  // Without particles most of the slot is gone: the measure sees it.
  const Return without = zalesak("level set", uncorrected());
  EXPECT_GT(without.shape, 0.3);
  EXPECT_LT(without.shape, 0.65);
  EXPECT_GT(without.loss, 0.2);
}

TEST(Advection, TheVortexGivesTheDiscBack) {
  const Return plain = vortex("particle level set", uncorrected(), 64);
  EXPECT_LT(std::abs(plain.loss), 0.036);
  EXPECT_LT(plain.shape, 0.052);
  // The last step before the thread tears decides on single drops, and so does round-off: 25 discs
  // moved by 1e-4 ended with .057 on average, each off by .015, the worst with .101. Five of them
  // are off by .0065, so that another compiler must not meet these bounds by luck. Level sets
  // without particles lose most of the disc.
  double shape = 0;
  for (int i = -2; i <= 2; ++i) {
    const Return corrected = vortex("particle level set", {}, 64, 8, 0.5, 1e-4 * i);
    EXPECT_LT(std::abs(corrected.ledger), 1e-3);
    EXPECT_LT(corrected.shape, 0.13);
    shape += corrected.shape / 5;
  }
  EXPECT_LT(shape, 0.083);
  EXPECT_GT(vortex("level set", uncorrected(), 64).shape, 0.3);
}

TEST(Advection, FractionsLoseNothing) {
  const Return disc = zalesak("volume of fluid", {});
  EXPECT_LT(std::abs(disc.ledger), 1e-14);
  EXPECT_LT(disc.shape, 0.035);
  const Return tail = vortex("volume of fluid", {}, 64);
  EXPECT_LT(std::abs(tail.ledger), 1e-14);
  EXPECT_LT(tail.shape, 0.28);
  const Return sheet = deformation("volume of fluid", {}, 32, 1.5);
  EXPECT_LT(std::abs(sheet.ledger), 1e-12);
  EXPECT_LT(sheet.shape, 0.25);
}

TEST(Advection, TheSheetBecomesABallAgain) {
  const Return plain = deformation("particle level set", uncorrected(), 32, 1.5);
  const Return without = deformation("level set", uncorrected(), 32, 1.5);
  EXPECT_LT(plain.shape, 0.5 * without.shape);
  EXPECT_LT(plain.shape, 0.25);
}

}  // namespace
}  // namespace lockstep::test
