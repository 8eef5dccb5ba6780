// Costs of an error, on tables made by hand.
#include "studies/work_precision.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace lockstep::test {

namespace {

StudyRow row_of(const std::string& series, double seconds, double error) {
  StudyRow row;
  row.series = series;
  row.quantity = "speed";
  row.core_seconds = seconds;
  row.cells = 10 * seconds;
  row.peak_memory_mb = 100;
  row.error = error;
  return row;
}

Study study_of(const Quantity& quantity) {
  Study study;
  study.quantities = {quantity};
  study.quantities[0].name = "speed";
  return study;
}

}  // namespace

TEST(WorkPrecision, CostIsInterpolatedInLogarithms) {
  // error = 1 / seconds: 5 % cost 20 s.
  const auto cost = cost_of_target({row_of("a", 10, 0.1), row_of("a", 100, 0.01)}, 0.05);
  EXPECT_EQ(cost.found, TargetCost::Found::between_rungs);
  EXPECT_NEAR(cost.core_seconds, 20, 1e-12);
  EXPECT_NEAR(cost.cells, 200, 1e-12);
  EXPECT_NEAR(cost.peak_memory_mb, 100, 1e-12);
}

TEST(WorkPrecision, ARungCountsOnlyIfAllFinerOnesKeepTheTarget) {
  const std::vector<StudyRow> lucky{row_of("a", 1, 0.2), row_of("a", 2, 0.001), row_of("a", 4, 0.1),
                                    row_of("a", 8, 0.025)};
  EXPECT_NEAR(cost_of_target(lucky, 0.05).core_seconds, 4 * std::sqrt(2.), 1e-12);
  EXPECT_EQ(cost_of_target(lucky, 0.01).found, TargetCost::Found::not_reached);
  const auto early = cost_of_target(lucky, 0.5);
  EXPECT_EQ(early.found, TargetCost::Found::at_coarsest);
  EXPECT_EQ(early.core_seconds, 1);
}

TEST(WorkPrecision, TheFinestRungMayBeWhatTheOthersAreComparedWith) {
  std::vector<StudyRow> rows{row_of("a", 10, 0.1), row_of("a", 100, 0.01), row_of("a", 1000, 0)};
  rows.back().error.reset();
  EXPECT_NEAR(cost_of_target(rows, 0.05).core_seconds, 20, 1e-12);
  EXPECT_EQ(cost_of_target(rows, 0.001).found, TargetCost::Found::not_reached);
  rows.front().error.reset();
  rows[1].error.reset();
  EXPECT_EQ(cost_of_target(rows, 0.05).found, TargetCost::Found::not_reached);
}

TEST(WorkPrecision, AnErrorThatIsNotANumberReachesNothing) {
  const double nothing = std::nan("");
  EXPECT_EQ(cost_of_target({row_of("a", 1, 0.1), row_of("a", 9, nothing)}, 0.5).found,
            TargetCost::Found::not_reached);
}

TEST(WorkPrecision, NoErrorAtAllCostsItsRung) {
  EXPECT_EQ(cost_of_target({row_of("a", 1, 0.1), row_of("a", 9, 0)}, 0.05).core_seconds, 9);
}

TEST(WorkPrecision, TheCheapestSeriesComesFirst) {
  std::vector<StudyRow> rows{row_of("slow", 10, 0.1), row_of("slow", 100, 0.01),
                             row_of("never", 1, 0.2), row_of("fast", 1, 0.1),
                             row_of("fast", 10, 0.01)};
  const auto costs = ranking(rows, 0.05);
  ASSERT_EQ(costs.size(), 3u);
  EXPECT_EQ(costs[0].series, "fast");
  EXPECT_EQ(costs[1].series, "slow");
  EXPECT_EQ(costs[2].series, "never");
  EXPECT_EQ(costs[2].found, TargetCost::Found::not_reached);
  Quantity quantity;
  quantity.targets = {0.05};
  const std::string page = targets_markdown(study_of(quantity), rows);
  EXPECT_THAT(page, testing::HasSubstr("| 0.05 | 1 | fast | 2 | 20 | 100 |"));
  EXPECT_THAT(page, testing::HasSubstr("| 0.05 | not reached | never |  |  |  |"));
  EXPECT_EQ(targets_markdown(study_of({}), rows), "");
}

}  // namespace lockstep::test
