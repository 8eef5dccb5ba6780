#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/errors.hpp"
#include "studies/expression_check.hpp"
#include "studies/series_product.hpp"
#include "studies/study_cases.hpp"

namespace lockstep::test {

namespace {

Study two_series() {
  Study study;
  study.constants = {{"h", "1/n"}, {"density", "10"}};
  study.assignments = {"Domain/Cells={[n], [n]}", "Solids/Ball/Density=[density]"};
  study.ladder_name = "n";
  study.ladder_values = {8, 16, 32};
  study.usual_rungs = 2;
  study.series = {{"light one", "scene.xml", {{"density", "1/2"}}, {"Time/Fixed Step=[h]"}, {}},
                  {"two ranks", "scene.xml", {{"ranks", "2"}}, {}, {64}}};
  study.n_samples = 2;
  study.sample_assignments = {"Solids/Ball/Position={[h*offset_x], 0}"};
  return study;
}

}  // namespace

TEST(Cases, SeriesTimesRungsTimesSamples) {
  const auto cases = study_cases(two_series(), {});
  ASSERT_EQ(cases.size(), 2u * 2 + 1 * 2);  // the ladder of the second series has one rung
  EXPECT_THAT(cases[0].assignments,
              testing::ElementsAre("Domain/Cells={8, 8}", "Solids/Ball/Density=0.5",
                                   "Time/Fixed Step=0.125", "Solids/Ball/Position={0, 0}"));
  EXPECT_EQ(cases[0].directory, "light-one/n=8/sample-0");
  EXPECT_EQ(cases[2].constants.at("h"), 1. / 16);
  EXPECT_EQ(cases[4].ranks, 2);
  EXPECT_EQ(cases[4].assignments[1], "Solids/Ball/Density=10");
  EXPECT_EQ(cases[5].directory, "two-ranks/n=64/sample-1");
}

TEST(Cases, EachHasAFolderOfItsOwn) {
  Study study = two_series();
  study.series[0].name = "a b";
  study.series[1].name = "a/b";
  study.series[1].values.clear();
  study.series.push_back(study.series[1]);
  study.series[2].name = "..";
  std::set<std::string> folders;
  for (const StudyCase& one : study_cases(study, {})) {
    EXPECT_TRUE(folders.insert(one.directory).second) << one.directory;
    EXPECT_EQ(std::count(one.directory.begin(), one.directory.end(), '/'), 2) << one.directory;
    EXPECT_NE(one.directory.front(), '.') << one.directory;
  }
  EXPECT_EQ(folders.count("a-b/n=8/sample-0"), 1u);
  study.series[1].name = "a-b";
  EXPECT_THROW(study_cases(study, {}), InputError);
  study.series[1].name = "c";
  study.ladder_values = {8, 8};
  EXPECT_THROW(study_cases(study, {}), InputError);
}

TEST(Cases, FormulasAreCheckedBeforeAnythingRuns) {
  const std::string scene = "studies-test-scene.xml";
  std::ofstream(scene) << R"xml(<ParameterList name="Scene">
  <ParameterList name="Solids"><ParameterList name="Ball 1"/></ParameterList>
  <ParameterList name="Observers"><ParameterList name="Wire 1"/></ParameterList>
</ParameterList>)xml";
  Study study = two_series();
  for (Series& series : study.series)
    series.scene_file = scene;
  study.abscissa = "h";
  study.parameters = {{"viscosity", "Fluid/Viscosity"}};
  const auto complaint = [&](const std::string& expression) -> std::string {
    study.quantities.resize(1);
    study.quantities[0].name = "speed";
    study.quantities[0].expression = expression;
    try {
      check_expressions(study, study_cases(study, {}));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint("2.5e-3*Ball_1.vx / max(density, viscosity) + time*summary.wall_seconds"),
            "");
  EXPECT_EQ(complaint("Wire_1.height + Wire_1.12.pressure"), "");
  for (const char* wrong : {"Wire.height", "Wire_1.a.height", "Wire_1..height", "Wire_1."})
    EXPECT_THAT(complaint(wrong), testing::HasSubstr("cannot evaluate")) << wrong;
  EXPECT_THAT(complaint("Ball.vx"), testing::HasSubstr("Did you mean \"Ball_1.vx\"?"));
  EXPECT_THAT(complaint("Ball_1.vx +"), testing::HasSubstr("Quantity \"speed\""));
  EXPECT_THAT(complaint("tim"), testing::HasSubstr("cannot evaluate"));
  study.curves = {{"curve", "time", "densty", ""}};
  EXPECT_THAT(complaint("time"), testing::HasSubstr("Curve \"curve\""));
  study.curves.clear();
  study.abscissa = "hh";
  EXPECT_THAT(complaint("time"), testing::HasSubstr("Abscissa"));
  study.abscissa = "h";
  complaint("time");
  study.quantities[0].reference = "g";
  EXPECT_THROW(check_expressions(study, study_cases(study, {})), InputError);
  study.quantities[0].reference = " self";
  EXPECT_NO_THROW(check_expressions(study, study_cases(study, {})));
  std::filesystem::remove(scene);
}

TEST(Cases, PartOfTheLadder) {
  const auto all = study_cases(two_series(), parse_rungs("1:"));
  EXPECT_EQ(all.size(), 2u * 3 + 2);
  const auto last = study_cases(two_series(), parse_rungs("3"));
  EXPECT_EQ(last.size(), 2u);
  EXPECT_THROW(study_cases(two_series(), parse_rungs("7:9")), InputError);
  for (const char* wrong : {"a:b", "0:2", "3:1", "1.5"})
    EXPECT_THROW(parse_rungs(wrong), InputError) << wrong;
}

TEST(Cases, SomeOfTheSeries) {
  Study study = two_series();
  keep_series(".*ranks", study);
  ASSERT_EQ(study.series.size(), 1u);
  EXPECT_EQ(study.series[0].name, "two ranks");
  for (const char* wrong : {"ranks", "light one", "(", ""})
    EXPECT_THROW(keep_series(wrong, study), InputError) << wrong;
}

TEST(Cases, ALadderOfRanks) {
  Study study = two_series();
  study.series.resize(1);
  study.ladder_name = "ranks";
  study.constants = {{"n", "8"}, {"h", "1/n"}, {"density", "1"}};
  study.ladder_values = {1, 4};
  study.n_samples = 1;
  const auto cases = study_cases(study, {});
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[1].ranks, 4);
  EXPECT_EQ(cases[1].directory, "light-one/ranks=4");
}

TEST(Cases, AProductOfFactorsIsOneSeriesForEveryChoice) {
  const Series plain{"", "scene.xml", {}, {}, {}};
  Series voxel = plain, flux = plain, fine = plain, coarse = plain;
  voxel.name = "voxel";
  flux.name = "flux";
  flux.assignments = {"Coupling/Type=flux"};
  fine.name = "small steps";
  fine.constants = {{"number", "0.1"}};
  coarse.name = "large steps";
  coarse.scene_file = "other.xml";
  coarse.values = {8, 16};
  coarse.assignments = {"Time/CFL=4"};
  const auto series = series_product({{voxel, flux}, {fine, coarse}}, plain);
  ASSERT_EQ(series.size(), 4u);
  EXPECT_EQ(series[0].name, "voxel, small steps");
  EXPECT_EQ(series[0].scene_file, "scene.xml");
  EXPECT_EQ(series[2].constants, (Formulas{{"number", "0.1"}}));
  EXPECT_EQ(series[3].name, "flux, large steps");
  EXPECT_EQ(series[3].scene_file, "other.xml");
  EXPECT_THAT(series[3].assignments, testing::ElementsAre("Coupling/Type=flux", "Time/CFL=4"));
  EXPECT_THAT(series[3].values, testing::ElementsAre(8, 16));
  EXPECT_TRUE(series_product({}, plain).empty());
}

/// As of assignments and values: the last factor that says something of a constant counts.
TEST(Cases, OfSeveralReplacementsTheLastCounts) {
  Study study;
  study.constants = {{"number", "1"}};
  study.ladder_name = "n";
  study.ladder_values = {4};
  study.series = {{"both", "scene.xml", {{"number", "2"}, {"number", "3"}}, {}, {}}};
  EXPECT_EQ(study_cases(study, {}).at(0).constants.at("number"), 3);
}

TEST(Cases, EveryShippedStudyCanBeExpanded) {
  int n_studies = 0;
  for (const auto& file : std::filesystem::directory_iterator(STUDIES_DIRECTORY)) {
    const std::string name = file.path().stem();
    if (file.path().extension() != ".xml" || name.find("-scene") != std::string::npos)
      continue;
    ++n_studies;
    const Study study = read_study(file.path());
    for (const Series& series : study.series)
      EXPECT_TRUE(std::filesystem::exists(series.scene_file)) << series.scene_file;
    EXPECT_FALSE(study.title.empty()) << name;
    const auto cases = study_cases(study, {});
    EXPECT_GT(cases.size(), 1u) << name;
    EXPECT_NO_THROW(check_expressions(study, cases)) << name;
  }
  EXPECT_GE(n_studies, 12);
}

}  // namespace lockstep::test
