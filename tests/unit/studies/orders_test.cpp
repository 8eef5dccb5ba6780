// Orders over whole ladders and the grid convergence index, by numbers computed by hand.
#include "studies/orders.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace lockstep::test {

namespace {

/// Rungs with these abscissas and values.
std::vector<StudyRow> rungs_of(const std::vector<double>& abscissas,
                               const std::vector<double>& values) {
  std::vector<StudyRow> rows(values.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].series = "flux";
    rows[k].quantity = "speed";
    rows[k].abscissa = abscissas[k];
    rows[k].value = values[k];
  }
  return rows;
}

std::vector<StudyRow> with_errors(std::vector<StudyRow> rows, const std::vector<double>& errors) {
  for (std::size_t k = 0; k < errors.size(); ++k)
    rows[k].error = errors[k];
  return rows;
}

const std::vector<double> halvings{1, 0.5, 0.25, 0.125};

Study study_along(const std::string& abscissa) {
  Study study;
  study.ladder_name = "ratio";
  study.abscissa = abscissa;
  study.quantities.resize(1);
  study.quantities[0].name = "speed";
  return study;
}

}  // namespace

TEST(FittedOrder, IsTheSlopeOfAllErrors) {
  // Log2 of the errors: 0, -1, -3 at 0, -1, -2. Slope 3/2, residuals -1/6, 1/3, -1/6.
  const auto fitted = fitted_order(with_errors(rungs_of(halvings, {0, 0, 0}), {1, 0.5, 0.125}));
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->n_rungs, 3);
  EXPECT_NEAR(fitted->order, 1.5, 1e-12);
  EXPECT_NEAR(fitted->standard_error, std::sqrt(1. / 12), 1e-12);
}

TEST(Abscissa, OneThatDoesNotChangeIsTold) {
  const Study study = study_along("h");
  const auto along = [&](const std::vector<double>& abscissas) {
    return note_on_abscissa(study, with_errors(rungs_of(abscissas, {0, 0, 0}), {4, 2, 1}));
  };

  EXPECT_EQ(along({1, 0.5, 0.25}), "");
  EXPECT_THAT(along({0.25, 0.25, 0.25}),
              testing::StartsWith(
                  "The abscissa \"h\" is 0.25 at all rungs of \"flux\", so there are no orders"));
  EXPECT_EQ(note_on_abscissa(study, rungs_of({1, 1, 1}, {0, 0, 0})), "") << "no errors";
  EXPECT_EQ(note_on_abscissa(study_along("ratio"),
                             with_errors(rungs_of({1, 1, 1}, {0, 0, 0}), {4, 2, 1})),
            "")
      << "a ladder of something else";
}

TEST(FittedOrder, APowerHasNoStandardError) {
  const auto fitted =
      fitted_order(with_errors(rungs_of({1, 0.5, 0.3, 0.1}, {0, 0, 0, 0}), {3, 0.75, 0.27, 0.03}));
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->n_rungs, 4);
  EXPECT_NEAR(fitted->order, 2, 1e-12);
  EXPECT_NEAR(fitted->standard_error, 0, 1e-7);
}

TEST(FittedOrder, WantsThreeErrorsAboveRoundOff) {
  const auto rungs = rungs_of(halvings, {0, 0, 0});
  EXPECT_FALSE(fitted_order(with_errors(rungs, {1, 0.5})));  // the finest is the reference
  EXPECT_FALSE(fitted_order(with_errors(rungs, {1, 0.5, 0})));
  EXPECT_FALSE(fitted_order(with_errors(rungs, {1, 0.5, std::nan("")})));
  EXPECT_FALSE(fitted_order(with_errors(rungs, {1e-11, 2e-12, 1e-13})));
  EXPECT_FALSE(fitted_order(with_errors(rungs_of({1, 1, 1}, {0, 0, 0}), {1, 0.5, 0.2})));
}

TEST(GridConvergence, IsThatOfTheFinestPair) {
  // 2 + h^2: 1.25 (0.1875/2.0625)/(2^2 - 1); what is coarser does not count.
  const auto second = grid_convergence(rungs_of({2, 1, 0.5, 0.25}, {9, 3, 2.25, 2.0625}));
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->order, 2, 1e-9);
  EXPECT_NEAR(second->index, 1.25 * 0.1875 / 2.0625 / 3, 1e-9);
  // 2 + h^3: observed is 3, and 2 counts.
  const auto third = grid_convergence(rungs_of(halvings, {3, 2.125, 2.015625}));
  ASSERT_TRUE(third);
  EXPECT_NEAR(third->order, 3, 1e-9);
  EXPECT_NEAR(third->index, 1.25 * 0.109375 / 2.015625 / 3, 1e-9);
}

TEST(GridConvergence, TakesUnevenRatios) {
  // -2 - h on grids of 1, 0.5 and 0.4: 1.25 (0.1/2.4)/(1.25 - 1).
  const auto first = grid_convergence(rungs_of({1, 0.5, 0.4}, {-3, -2.5, -2.4}));
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->order, 1, 1e-9);
  EXPECT_NEAR(first->index, 1.25 * 0.1 / 2.4 / 0.25, 1e-9);
}

TEST(GridConvergence, SaysNothingWithoutConvergence) {
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {3, 2.5})));
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {3, 2, 2.5})));     // swings
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {3, 2.5, 2})));     // order 0
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {3, 2.5, 1})));     // diverges
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {3, 2, 2})));       // does not change
  EXPECT_FALSE(grid_convergence(rungs_of(halvings, {1, 0.25, 0})));    // relative to nothing
  EXPECT_FALSE(grid_convergence(rungs_of({1, 2, 4}, {3, 2.5, 2.3})));  // gets coarser
}

TEST(Extrapolation, ACleanOrderGivesTheLimit) {
  const auto second = extrapolate(rungs_of(halvings, {2 + 1., 2 + 1. / 4, 2 + 1. / 16}));
  ASSERT_TRUE(second);
  EXPECT_NEAR(*second, 2, 1e-9);
  // An order of 1.5 is believed if four rungs show it, not from three.
  const std::vector<double> odd{1, std::pow(0.5, 1.5), std::pow(0.25, 1.5), std::pow(0.125, 1.5)};
  EXPECT_NEAR(extrapolate(rungs_of(halvings, odd)).value(), 0, 1e-9);
  EXPECT_FALSE(extrapolate(rungs_of(halvings, {odd.begin(), odd.begin() + 3})));
}

TEST(Extrapolation, NothingIsSaidWhereTheOrderIsNotClean) {
  EXPECT_FALSE(extrapolate(rungs_of(halvings, {3, 2.5})));
  EXPECT_FALSE(extrapolate(rungs_of(halvings, {3, 2, 2.5})));              // swings
  EXPECT_FALSE(extrapolate(rungs_of(halvings, {3, 2.5, 1})));              // diverges
  EXPECT_FALSE(extrapolate(rungs_of(halvings, {9, 5, 3, 2.75})));          // order 1, then 3
  EXPECT_FALSE(extrapolate(rungs_of({1, 0.5, 0.35}, {3, 2.25, 2.0625})));  // order 1.3
}

TEST(Orders, StandInOneTable) {
  auto rungs = with_errors(rungs_of(halvings, {3, 2.25, 2.0625}), {1, 0.25, 0.0625});
  EXPECT_THAT(orders_markdown(study_along("h"), rungs),
              testing::HasSubstr("| speed | flux | 3 | 2.00 | 0.00 | 2.00 | 3.8 | 2 |  |\n"));
  rungs.back().reference = 2.5;
  EXPECT_THAT(orders_markdown(study_along("h"), rungs), testing::HasSubstr("| 3.8 | 2 | 0.2 |\n"));
  EXPECT_EQ(orders_markdown(study_along("ratio"), rungs), "");
  for (StudyRow& row : rungs)
    row.reference = 0;  // an index is relative
  EXPECT_THAT(orders_markdown(study_along("h"), rungs),
              testing::HasSubstr("| speed | flux | 3 | 2.00 | 0.00 |  |  |  |  |\n"));
  for (StudyRow& row : rungs)
    row.error.reset();
  EXPECT_EQ(orders_markdown(study_along("h"), rungs), "");
}

TEST(Orders, TheHeadNamesTheFinestRunAsReference) {
  Study study = study_along("h");
  const auto rungs = rungs_of(halvings, {3, 2.25, 2.0625});
  EXPECT_THAT(table_markdown(study, rungs), testing::HasSubstr("**speed**\n"));
  study.quantities[0].reference = "self";
  study.quantities[0].unit = "m/s";
  study.abscissa_name = "size of an element";
  study.abscissa_unit = "m";
  EXPECT_THAT(table_markdown(study, rungs),
              testing::HasSubstr("**speed**, reference `self`: the finest run of each series\n"));
  EXPECT_THAT(table_csv(study, rungs),
              testing::HasSubstr("# abscissa name: size of an element\n# abscissa unit: m\n"
                                 "# unit of speed: m/s\n# reference of speed: self\nseries,"));
}

}  // namespace lockstep::test
