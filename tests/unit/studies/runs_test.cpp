// Whole studies on a stand-in for simulate whose result is 2 + h^2 + offset.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "studies/curves.hpp"
#include "studies/study_table.hpp"

namespace lockstep::test {

namespace fs = std::filesystem;

namespace {

class Runs : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/scene.xml") << "anything";
    study_.ladder_name = "n";
    study_.ladder_values = {4, 8, 16};
    study_.abscissa = "h";
    study_.assignments = {"Domain/Cells={[n], [n]}"};
    study_.series = {{"all", folder_ + "/scene.xml", {}, {}, {}}};
    Quantity speed;
    speed.name = "speed";
    speed.expression = "Ball_1.vx / step";
    speed.reference = "2";
    study_.quantities = {speed};
    options_.simulate = FAKE_SIMULATE;
    options_.output_directory = folder_;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<CaseOutcome> run() {
    cases_ = study_cases(study_, {});
    return run_cases(cases_, options_, [](std::size_t, const CaseOutcome&) {});
  }
  std::vector<StudyRow> table() {
    const auto outcomes = run();
    return table_of(outcomes);
  }
  std::vector<StudyRow> table_of(const std::vector<CaseOutcome>& outcomes) {
    told_.clear();
    return study_table(study_, cases_, outcomes, tell_);
  }

  std::vector<std::string> told_;
  std::function<void(const std::string&)> tell_ = [this](const std::string& sentence) {
    told_.push_back(sentence);
  };
  std::string folder_ = "studies-test-runs";
  Study study_;
  RunnerOptions options_;
  std::vector<StudyCase> cases_;
};

}  // namespace

TEST_F(Runs, ErrorsAndOrders) {
  const auto rows = table();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].value, 2 + 1. / 16, 1e-14);
  EXPECT_NEAR(*rows[0].error, 1. / 32, 1e-14);  // relative to 2
  EXPECT_FALSE(rows[0].order);
  EXPECT_NEAR(*rows[2].order, 2, 1e-10);
  EXPECT_EQ(rows[2].cells, 256);
  EXPECT_EQ(rows[2].spacing, 1. / 16);
  EXPECT_NEAR(rows[2].mean_step, 0.4 / 3, 1e-15);
  EXPECT_EQ(rows[2].iterations_median, 6);
  EXPECT_EQ(rows[2].iterations_max, 9);
  EXPECT_THAT(table_csv(study_, rows), testing::HasSubstr("\nall,256,0.0625,"));
}

/// Along a parameter that is no resolution, a density ratio say, errors do not converge.
TEST_F(Runs, OrdersOnlyWhereTheLadderIsAResolution) {
  for (const auto& [abscissa, has_orders] : {std::pair("n", false), std::pair(" n ", false),
                                             std::pair("1/n", true), std::pair("dt*h", true)}) {
    study_.abscissa = abscissa;
    const auto rows = table();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_TRUE(rows[2].error);
    EXPECT_EQ(rows[2].order.has_value(), has_orders) << abscissa;
  }
  study_.ladder_name = "h";  // by its name
  study_.abscissa = "h";
  EXPECT_TRUE(is_resolution(study_));
}

/// A busy machine lengthens the wall time, so that times the ranks is no measure of the work.
TEST_F(Runs, CoreSecondsAreCpuSecondsOfAllRanks) {
  study_.ladder_values = {4};
  const auto rows = table();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].wall_seconds, 2.0);
  EXPECT_EQ(rows[0].core_seconds, 1.5);
  EXPECT_THAT(table_csv(study_, rows), testing::HasSubstr("core_seconds: CPU seconds"));
  EXPECT_THAT(table_markdown(study_, rows), testing::HasSubstr("Core seconds are CPU seconds"));
}

TEST_F(Runs, SelfConvergenceAndReductions) {
  study_.quantities[0].reference = "self";
  study_.quantities[0].relative = false;
  Quantity sum = study_.quantities[0];
  sum.name = "mean after 0.15 s";
  sum.expression = "dt";
  sum.over = Quantity::Over::mean;
  sum.from_time = 0.15;
  sum.reference = "";
  study_.quantities.push_back(sum);
  const auto rows = table();
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_NEAR(*rows[0].error, 1. / 16 - 1. / 256, 1e-14);
  EXPECT_FALSE(rows[2].error);
  EXPECT_NEAR(rows[3].value, 0.15, 1e-15);
}

/// A wire is looked at in steps 0 and 2, two probes in every step.
TEST_F(Runs, TablesOfObservers) {
  study_.ladder_values = {4};
  Quantity& height = study_.quantities[0];
  height.expression = "Wire_1.height";
  height.reference = "";
  height.over = Quantity::Over::mean;
  Quantity pressure = height;
  pressure.expression = "Probes.2.p - Probes.1.p + 100*Probes.2.p";
  pressure.over = Quantity::Over::last;
  study_.quantities.push_back(pressure);
  const auto rows = table();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[0].value, (5. + 7 + 7) / 3, 1e-14);
  EXPECT_EQ(rows[1].value, 3201);
  study_.quantities[1].expression = "Probes.3.p";
  EXPECT_EQ(table().size(), 1u);  // only one quantity can be measured
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("Probes.3.p"));
}

/// A series without its finest run has nothing to be compared with.
TEST_F(Runs, ASeriesIsItsOwnReferenceByItsLastRungAlone) {
  study_.quantities[0].reference = "self";
  study_.assignments.push_back("Fake/Fail=[n == 16 ? 3 : 0]");
  const auto rows = table();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_FALSE(rows[0].error);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("last rung"));
}

TEST_F(Runs, SurfacesInTheFrames) {
  study_.ladder_values = {4};
  Quantity corner = study_.quantities[0];
  corner.from = Quantity::From::surface;
  corner.solid = "Ball 1";
  corner.point = {2, 3, 0};
  corner.reference = "";
  Quantity volume = corner;
  volume.expression = "volume / volume0";
  volume.over = Quantity::Over::min;
  corner.expression = "x + 2 * (y - y0) - 0.8";
  Quantity extent = volume;
  extent.expression = "x_extent / x_extent0 - 1 + z_extent";
  study_.quantities = {corner, corner, volume, extent};
  study_.quantities[0].over = Quantity::Over::frequency;
  study_.quantities[1].over = Quantity::Over::amplitude;
  const auto rows = table();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR(rows[0].value, 2.5, 1e-12);
  EXPECT_NEAR(rows[1].value, 0.3, 1e-12);
  EXPECT_NEAR(rows[2].value, 0.81 / 1.21, 1e-12);  // value for a cone from outside the square
  EXPECT_NEAR(rows[3].value, 0.9 / 1.1 - 1, 1e-12);
  study_.quantities[0].solid = "Bell";
  EXPECT_EQ(table().size(), 3u);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("no dataset \"/solids/Bell/vertices\""));
}

TEST_F(Runs, ExtremaAlongLines) {
  study_.ladder_values = {8};
  Quantity low = study_.quantities[0];
  low.from = Quantity::From::line;
  low.field = "velocity";
  low.component = 1;
  low.axis = 1;
  low.point = {0.3, 0, 0};  // between two columns of cells
  low.over = Quantity::Over::min;
  low.reference = "-0.3";
  Quantity high = low;
  high.over = Quantity::Over::max;
  study_.quantities = {low, high};
  const auto rows = table();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[0].value, -0.3, 1e-14);
  EXPECT_NEAR(*rows[0].error, 0, 1e-13);
  const double end = 15. / 16;  // the last cell
  EXPECT_NEAR(rows[1].value, -0.3 * (1 - (end - 0.4) * (end - 0.4)), 1e-14);
  study_.quantities[0].component = 3;
  EXPECT_EQ(table().size(), 1u);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("has no component 3"));
}

TEST_F(Runs, MeanAndSpreadOverSamples) {
  study_.ladder_values = {4};
  study_.n_samples = 3;
  study_.sample_assignments = {"Solids/Ball/Position={[sample - 1], 0}"};
  study_.quantities[0].reference = "2 + h^2";
  const auto rows = table();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(*rows[0].error, 0, 1e-14);
  EXPECT_NEAR(rows[0].spread, 1, 1e-14);  // spread of -1, 0, 1
  EXPECT_EQ(rows[0].n_samples, 3);
  study_.quantities[0].reference = "1 + h^2 + sample";  // another one for each of them
  EXPECT_NEAR(*table()[0].error, 0, 1e-14);
}

TEST_F(Runs, FinishedRunsAreUsedAgainOnlyIfNothingChanged) {
  EXPECT_FALSE(run()[0].reused);
  EXPECT_TRUE(run()[0].reused);
  std::ofstream(folder_ + "/scene.xml") << "something else";
  EXPECT_FALSE(run()[0].reused);
  study_.assignments.push_back("Fluid/Density=1");
  EXPECT_FALSE(run()[0].reused);
  EXPECT_TRUE(run()[2].reused);
  options_.fresh = true;
  EXPECT_FALSE(run()[0].reused);
}

TEST_F(Runs, WithoutAllOfItsFilesACaseIsRunAnew) {
  study_.ladder_values = {4};
  run();
  EXPECT_TRUE(run()[0].reused);
  const std::string folder = folder_ + "/runs/all/n=4/";
  for (const char* name :
       {"history.csv", "bodies.csv", "frames.xmf", "frames/frame-000024.h5", "frames"}) {
    fs::remove_all(folder + name);
    EXPECT_FALSE(run()[0].reused) << name;
    EXPECT_TRUE(run()[0].reused) << name;
  }
}

TEST_F(Runs, WhatCannotBeReadLeavesTheRest) {
  Quantity width = study_.quantities[0];
  width.name = "width";
  width.from = Quantity::From::surface;
  width.solid = "Ball 1";
  width.expression = "x";
  width.over = Quantity::Over::max;
  width.reference = "";
  study_.quantities.push_back(width);
  study_.curves = {
      {"first", "dt", "", "s"}, {"second", "1 / (step - 2)", "", ""}, {"third", "step", "", ""}};
  ASSERT_EQ(table().size(), 6u);
  std::ofstream(folder_ + "/runs/all/n=8/frames/frame-000003.h5") << "no frame";
  EXPECT_EQ(table().size(), 5u);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("all/n=8: \"width\" is not measured. Cannot read"));
  const auto outcomes = run();
  std::ofstream(folder_ + "/runs/all/n=8/history.csv") << "step,time\n1\n";
  EXPECT_EQ(table_of(outcomes).size(), 4u);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_THAT(told_[0], testing::HasSubstr("all/n=8: not measured. "));
  told_.clear();
  const std::string curves = curves_csv(study_, cases_, outcomes, tell_);
  EXPECT_THAT(curves, testing::HasSubstr("# unit of first: s\ncurve,"));
  EXPECT_THAT(curves, testing::HasSubstr("\nfirst,all,16,"));
  EXPECT_THAT(curves, testing::Not(testing::HasSubstr("second")));
  EXPECT_THAT(curves, testing::HasSubstr("\nthird,all,4,"));
  EXPECT_THAT(curves, testing::Not(testing::HasSubstr(",all,8,")));
  EXPECT_EQ(told_.size(), 5u);
  study_.curves.resize(0);
  EXPECT_EQ(curves_csv(study_, cases_, outcomes, tell_), "");
}

TEST_F(Runs, MoreJobsThanCases) {
  options_.n_jobs = 2000000000;
  for (const CaseOutcome& outcome : run())
    EXPECT_TRUE(outcome.done);
}

TEST_F(Runs, EveryFileThatACaseReadsCounts) {
  const auto write = [&](const std::string& name, const std::string& parameter,
                         const std::string& value) {
    std::ofstream(folder_ + "/" + name)
        << "<ParameterList name=\"a\"><Parameter name=\"" << parameter
        << "\" type=\"string\" value=\"" << value << "\"/></ParameterList>";
  };
  fs::create_directories(folder_ + "/solvers");
  write("scene.xml", "Include", "included.xml");
  write("included.xml", "File", "solvers/first.xml");
  write("solvers/first.xml", "File", "mesh.obj");
  std::ofstream(folder_ + "/solvers/mesh.obj") << "v 0 0 0";
  std::ofstream(folder_ + "/other.obj") << "v 0 0 0";
  study_.assignments.push_back("Solids/Ball/Geometry/File=other.obj");
  EXPECT_FALSE(run()[0].reused);
  EXPECT_TRUE(run()[0].reused);
  for (const char* name : {"solvers/mesh.obj", "other.obj", "solvers/first.xml", "included.xml"}) {
    std::ofstream(folder_ + "/" + name, std::ios::app) << " ";
    EXPECT_FALSE(run()[0].reused) << name;
    EXPECT_TRUE(run()[0].reused) << name;
  }
}

TEST_F(Runs, OneStudyAtATimeInAFolder) {
  options_.seconds_to_wait = 0;
  {
    const auto lock = FolderLock::take(folder_, 0);
    EXPECT_THROW(run(), OutputError);
  }
  EXPECT_TRUE(run()[0].done);
}

TEST_F(Runs, LinksAreNotFollowed) {
  const std::string elsewhere = folder_ + "/elsewhere";
  fs::create_directories(elsewhere + "/all/n=4");
  std::ofstream(elsewhere + "/all/n=4/precious") << "text";
  fs::create_directory_symlink(fs::absolute(elsewhere), folder_ + "/runs");
  EXPECT_THROW(run(), OutputError);
  EXPECT_TRUE(fs::exists(elsewhere + "/all/n=4/precious"));
}

TEST_F(Runs, AFailureLeavesTheRest) {
  study_.assignments.push_back("Fake/Fail=[n == 8 ? 3 : 0]");
  options_.n_jobs = 2;
  const auto outcomes = run();
  EXPECT_TRUE(outcomes[0].done);
  EXPECT_EQ(outcomes[1].exit_code, 3);
  EXPECT_EQ(outcomes[1].message, "S2 did not converge: residual 1.");
  EXPECT_EQ(table_of(outcomes).size(), 2u);
  EXPECT_FALSE(run()[1].reused);
}

TEST_F(Runs, SecondsOfRunsSideBySideAreMarked) {
  study_.ladder_values = {4, 8};
  study_.assignments.push_back("Fake/Seconds=0.5");
  const auto alone = table();
  EXPECT_EQ(alone[0].n_at_a_time, 1);
  EXPECT_THAT(table_markdown(study_, alone), testing::Not(testing::HasSubstr("shared")));
  options_.fresh = true;
  options_.n_jobs = 2;
  EXPECT_EQ(table()[1].n_at_a_time, 2);
  options_.fresh = false;
  options_.n_jobs = 1;
  const auto again = table();  // they are used again, with their mark
  EXPECT_EQ(again[0].n_at_a_time, 2);
  EXPECT_THAT(table_markdown(study_, again), testing::HasSubstr("| 1.5 (2) | 6, 9 |"));
  EXPECT_THAT(table_markdown(study_, again), testing::HasSubstr("shared the machine"));
  EXPECT_THAT(table_csv(study_, again), testing::EndsWith(",0.125,2\n"));
}

TEST_F(Runs, CasesAreToldWhenTheyStartAndEnd) {
  study_.ladder_values = {4};
  cases_ = study_cases(study_, {});
  std::string log;
  CaseOutcome outcome;
  const auto tell = [&] {
    log.clear();
    run_cases(
        cases_, options_, [&](std::size_t, const CaseOutcome& one) { outcome = one; },
        [&](std::size_t i, const std::string& file) { log = fmt::format("{} {}", i, file); });
  };
  tell();
  EXPECT_EQ(log, "0 " + folder_ + "/runs/all/n=4/log.txt");
  EXPECT_GT(outcome.seconds, 0);
  tell();
  EXPECT_EQ(log, "");
  EXPECT_EQ(outcome.seconds, 0);
}

TEST_F(Runs, BadInputStopsTheLadder) {
  study_.assignments.push_back("Fake/Fail=[n == 4 ? 2 : 0]");
  const auto outcomes = run();
  EXPECT_EQ(outcomes[0].exit_code, 2);
  EXPECT_FALSE(outcomes[1].done);
  EXPECT_EQ(outcomes[1].exit_code, 0);
}

TEST_F(Runs, ARunThatCrashedLeavesTheRestOneThatWasEndedDoesNot) {
  options_.fresh = true;
  const std::vector<std::pair<int, bool>> goes_on_after = {
      {139, true}, {137, true}, {134, true}, {130, false}, {143, false}};
  for (const auto& [code, goes_on] : goes_on_after) {
    study_.assignments = {"Domain/Cells={[n], [n]}",
                          fmt::format("Fake/Fail=[n == 4 ? {} : 0]", code)};
    const auto outcomes = run();
    EXPECT_EQ(outcomes[0].exit_code, code);
    EXPECT_EQ(outcomes[1].done, goes_on) << code;
  }
}

TEST_F(Runs, AMissingProgramIsNamed) {
  options_.simulate = folder_ + "/nothing";
  EXPECT_THROW(run(), InputError);
}

TEST_F(Runs, SymbolsOfAStudyFileAreStrict) {
  const std::string file = folder_ + "/study.xml";
  std::ofstream(file) << R"xml(<ParameterList name="Study">
  <Parameter name="Scene" type="string" value="scene.xml"/>
  <ParameterList name="Ladder">
    <Parameter name="Values" type="Array(double)" value="{4, 8}"/>
  </ParameterList>
  <ParameterList name="Quantities">
    <ParameterList name="speed">
      <Parameter name="Expresion" type="string" value="step"/>
    </ParameterList>
  </ParameterList>
</ParameterList>)xml";
  try {
    read_study(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("Did you mean \"Expression\""));
  }
}

TEST_F(Runs, TheAbscissaIsTheStepAlongALadderOfSteps) {
  const std::string file = folder_ + "/study.xml";
  for (const auto& [ladder, abscissa] : {std::pair("dt", "dt"), std::pair("n", "h")}) {
    std::ofstream(file) << R"xml(<ParameterList name="Study">
  <Parameter name="Scene" type="string" value="scene.xml"/>
  <ParameterList name="Ladder">
    <Parameter name="Name" type="string" value=")xml"
                        << ladder << R"xml("/>
    <Parameter name="Values" type="Array(double)" value="{4, 8}"/>
  </ParameterList>
  <ParameterList name="Quantities">
    <ParameterList name="speed"><Parameter name="Expression" type="string" value="step"/>
    </ParameterList>
  </ParameterList>
</ParameterList>)xml";
    EXPECT_EQ(read_study(file).abscissa, abscissa);
  }
}

}  // namespace lockstep::test
