#include "transport/strip_values.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace lockstep;

namespace {

/// -3, 1, -1, ...: no two alike, of either sign.
template <int dim>
StripValues<dim> some_row() {
  StripValues<dim> row;
  for (int i = 0; i < tile_width<dim>; ++i)
    row[i] = (i % 2 == 0 ? -3 : 1) + 0.25 * i;
  return row;
}

template <int dim>
void check_each_value() {
  const StripValues<dim> a = some_row<dim>(), b = some_row<dim>().reverse();
  const StripValues<dim> ahead = row_ahead<dim>(a, 100), behind = row_behind<dim>(a, -100);
  const StripValues<dim> low = least(a, b), high = most(a, b), limited = clamped(a, -1, 2);
  StripValues<dim> flag = StripValues<dim>::Zero();
  flag[1] = -2;
  flag[tile_width<dim> - 1] = 1e-300;
  const StripValues<dim> either = chosen(flag, a, b), between = within(a, low, high, b);
  const StripValues<dim> nothing_between = within(a, high, low, b),
                         one_value = within(b, a, a, flag);
  for (int i = 0; i < tile_width<dim>; ++i) {
    EXPECT_EQ(ahead[i], i + 1 < tile_width<dim> ? a[i + 1] : 100);
    EXPECT_EQ(behind[i], i > 0 ? a[i - 1] : -100);
    EXPECT_EQ(low[i], std::min(a[i], b[i]));
    EXPECT_EQ(high[i], std::max(a[i], b[i]));
    EXPECT_EQ(limited[i], std::clamp(a[i], -1.0, 2.0));
    EXPECT_EQ(either[i], flag[i] != 0 ? a[i] : b[i]);
    EXPECT_EQ(between[i], a[i]);
    EXPECT_EQ(one_value[i], a[i]);
    EXPECT_EQ(nothing_between[i], a[i] == b[i] ? a[i] : b[i]);
    EXPECT_EQ(bits_of_non_negative(a) >> i & 1, a[i] >= 0 ? 1U : 0U);
  }
}

}  // namespace

TEST(StripValues, EachValue2D) {
  check_each_value<2>();
}
TEST(StripValues, EachValue3D) {
  check_each_value<3>();
}

TEST(StripValues, WhetherSomeValueIsNotZero) {
  for (int i = 0; i < tile_width<3>; ++i) {
    StripValues<3> row = StripValues<3>::Zero();
    row[i] = -0.0;
    EXPECT_FALSE(has_nonzero(row));
    row[i] = -1e-300;
    EXPECT_TRUE(has_nonzero(row));
    row[i] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has_nonzero(row));
  }
}

TEST(StripValues, WhatIsNotANumberBecomesTheLowerLimit) {
  StripValues<3> row = StripValues<3>::Constant(5);
  row[3] = std::numeric_limits<double>::quiet_NaN();
  const StripValues<3> limited = clamped(row, 0, 7);
  EXPECT_EQ(limited[3], 0);
  EXPECT_EQ(limited[2], 5);
}

TEST(StripValues, TheBitsOfFourValues) {
  const Eigen::Array<double, 4, 1> values(-1, 0, std::numeric_limits<double>::quiet_NaN(), 2);
  EXPECT_EQ(bits_of_non_negative(values), 0b1010U);
}
