// A scene and its solver file, merged.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "stepping/scene_file.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep::test {
namespace {

ParameterList valid_scene() {
  ParameterList scene;
  declare(scene, "Dimension", 2, "");
  ParameterList& solver = declare_list(scene, "Solver", "");
  declare(solver, "File", "", "");
  declare(solver, "Tolerance", 1e-8, "");
  declare_typed_sublist(solver, "Strategy", "", {{"any", "", common_strategy_parameters()}}, "any");
  return scene;
}

double tolerance(Document document, const std::vector<std::string>& settings = {}) {
  document.list.set("Dimension", 2);
  complete_scene(document, settings, valid_scene(), Tpetra::getDefaultComm());
  return document.list.sublist("Solver").get<double>("Tolerance");
}

}  // namespace

TEST(Tolerance, OfTheStrategyCountsWhereTheSceneHasNone) {
  Document document;
  EXPECT_EQ(tolerance(document), 1e-8);
  EXPECT_EQ(tolerance(document, {"Solver/Strategy/Tolerance=1e-5"}), 1e-5);
  document.list.sublist("Solver").sublist("Strategy").set("Tolerance", 1e-6);
  EXPECT_EQ(tolerance(document), 1e-6);
  EXPECT_EQ(tolerance(document, {"Solver/Strategy/Tolerance=1e-5"}), 1e-5);
}

TEST(Tolerance, OfTheSceneWins) {
  Document document;
  document.list.sublist("Solver").sublist("Strategy").set("Tolerance", 1e-6);
  EXPECT_EQ(tolerance(document, {"Solver/Tolerance=1e-4"}), 1e-4);
  document.list.sublist("Solver").set("Tolerance", 1e-8);  // the default, but said
  EXPECT_EQ(tolerance(document), 1e-8);
}

}  // namespace lockstep::test
