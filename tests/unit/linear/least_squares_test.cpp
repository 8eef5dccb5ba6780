#include "linear/least_squares.hpp"

#include <gtest/gtest.h>

using namespace lockstep;

TEST(LeastSquares, AFullColumnRankHasOneSolution) {
  Eigen::MatrixXd a(3, 2);
  a << 1, 0, 0, 2, 1, 0;
  // Row 1 and 3 ask for x_0 = 1 and 3: their mean.
  const Eigen::VectorXd x = least_squares(a, Eigen::Vector3d(1, 4, 3));
  EXPECT_NEAR(x[0], 2, 1e-14);
  EXPECT_NEAR(x[1], 2, 1e-14);
}

TEST(LeastSquares, OfManySolutionsTheShortest) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Ones(2, 2);
  const Eigen::VectorXd x = least_squares(a, Eigen::Vector2d(1, 1));
  EXPECT_LT((x - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-14);
  EXPECT_LT((pseudo_inverse(a) - Eigen::MatrixXd::Constant(2, 2, 0.25)).norm(), 1e-14);
}

TEST(LeastSquares, WhatIsTakenForDependent) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(2, 2);
  a(1, 1) = 1e-8;
  const Eigen::Vector2d b(1, 1e-8);
  EXPECT_NEAR(least_squares(a, b)[1], 1, 1e-7);
  EXPECT_EQ(least_squares(a, b, 1e-7)[1], 0);
}
