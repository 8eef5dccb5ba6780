#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/mistakes.hpp"
#include "scenes/expand_scene.hpp"
#include "scenes/include.hpp"

namespace lockstep::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<TypedSchema> solid_types = {{"rigid body", "", {}}, {"cloth", "", {}}};

Document expanded(const std::string& body, std::vector<std::string> settings = {}) {
  const std::string head =
      "<ParameterList name=\"Scene\">\n<Parameter name=\"Dimension\" type=\"int\" value=\"2\"/>\n";
  Document document =
      read_xml_string(head + body + "</ParameterList>", "case.xml", FormulaPolicy::kept);
  expand_scene(document, settings, solid_types);
  return document;
}

/// Throws what is a mistake in the list, as `validate` does.
void check_readable_list(const ParameterList& list) {
  for (const auto& [name, entry] : entries(list)) {
    if (entry.isList())
      check_readable_list(list.sublist(name));
    else
      check_readable(entry);
  }
}

std::string refusal(const std::string& body, const std::vector<std::string>& settings = {}) {
  try {
    check_readable_list(expanded(body, settings).list);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string list(const std::string& name, const std::string& body) {
  return "<ParameterList name=\"" + name + "\">\n" + body + "</ParameterList>\n";
}
std::string parameter(const std::string& name, const std::string& type, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>\n";
}
std::string ball(const std::string& more) {
  return parameter("Type", "string", "rigid body") +
         list("Geometry",
              parameter("Shape", "string", "ball") + parameter("Radius", "double", "0.1")) +
         more;
}
std::vector<double> position(const Document& document, const std::string& name) {
  return document.list.sublist("Solids")
      .sublist(name)
      .get<ParameterArray<double>>("Position")
      .toVector();
}
int n_solids(const Document& document) {
  return document.list.sublist("Solids").numParams();
}

TEST(SceneLanguage, SettingsOfConstantsMayBeFormulas) {
  const std::string body =
      list("Constants", parameter("Q", "double", "3") + parameter("R", "double", "1")) +
      list("Solids", list("Ball", ball(parameter("Position", "Array(double)", "{[R], [S]}"))));

  const Document document = expanded(body, {"Constants/R=[2*Q]", "Constants/S=[R+1]"});

  EXPECT_THAT(position(document, "Ball"), ElementsAre(6, 7));
  EXPECT_EQ(document.constants.at("S"), 7);
}

TEST(SceneLanguage, FormulasKnowConstantsAndConstantsThoseBeforeThem) {
  const std::string body =
      list("Constants", parameter("R", "double", "0.25") + parameter("n", "int", "8") +
                            parameter("D", "string", "2*R")) +
      list("Domain", parameter("Upper", "Array(double)", "{[D], 1, [n*R]}") +
                         parameter("Cells", "Array(int)", "{[n], [2*n]}")) +
      parameter("Title", "string", "a [bracket] in a text");

  const Document document = expanded(body);

  const ParameterList& domain = document.list.sublist("Domain");
  EXPECT_THAT(domain.get<ParameterArray<double>>("Upper").toVector(), ElementsAre(0.5, 1, 2));
  EXPECT_THAT(domain.get<ParameterArray<int>>("Cells").toVector(), ElementsAre(8, 16));
  EXPECT_EQ(document.list.get<std::string>("Title"), "a [bracket] in a text");
  EXPECT_FALSE(document.list.isParameter("Constants"));
  EXPECT_EQ(expanded(body, {"Constants/R=1"})
                .list.sublist("Domain")
                .get<ParameterArray<double>>("Upper")[0],
            2);
}

TEST(SceneLanguage, BadFormulasAreNamedWithTheirPlace) {
  const std::string constants = list("Constants", parameter("R", "double", "0.5"));
  const auto formula = [&](const std::string& type, const std::string& text) {
    return refusal(constants + list("Fluid", parameter("Density", type, text)));
  };
  EXPECT_THAT(formula("double", "[2*r]"), HasSubstr("case.xml, line 7: in \"Fluid\", \"Density\""));
  EXPECT_THAT(formula("double", "[2*r]"), HasSubstr("Did you mean \"R\""));
  EXPECT_THAT(formula("int", "[R]"), HasSubstr("0.5"));
  EXPECT_THAT(formula("double", "[1/(R-R)]"), HasSubstr("finite"));
  EXPECT_THAT(formula("double", "[R"), HasSubstr("without ']'"));
  EXPECT_THAT(formula("double", "[R] m"), HasSubstr("not a number"));
  EXPECT_THAT(refusal(list("Constants", parameter("2x", "double", "1"))), HasSubstr("name"));
  EXPECT_THAT(refusal(list("Constants", parameter("x", "bool", "true"))), HasSubstr("double"));
  EXPECT_THAT(refusal(list("Constants", parameter("x", "string", "2*y"))), HasSubstr("2*y"));
}

TEST(SceneLanguage, FormulasOutsideScenesAreRefused) {
  EXPECT_THROW(read_xml_string(list("Solver", parameter("x", "double", "[1]")), "solver.xml"),
               InputError);
}

TEST(SceneLanguage, DefaultsHoldWhereTheSolidIsSilent) {
  const Document document = expanded(
      list("Defaults", parameter("Density", "double", "7") +
                           list("cloth", parameter("Density", "double", "3")) +
                           list("Geometry", parameter("Shape", "string", "ball") +
                                                parameter("Radius", "double", "2"))) +
      list("Solids", list("A", parameter("Type", "string", "rigid body")) +
                         list("B", parameter("Type", "string", "cloth") +
                                       list("Geometry", parameter("Shape", "string", "box"))) +
                         list("C", parameter("Type", "string", "rigid body") +
                                       parameter("Density", "double", "1"))));

  const ParameterList& solids = document.list.sublist("Solids");
  EXPECT_EQ(solids.sublist("A").get<double>("Density"), 7);
  EXPECT_EQ(solids.sublist("A").sublist("Geometry").get<double>("Radius"), 2);
  EXPECT_FALSE(solids.sublist("A").isParameter("cloth"));
  EXPECT_EQ(solids.sublist("B").get<double>("Density"), 3);
  EXPECT_FALSE(solids.sublist("B").sublist("Geometry").isParameter("Radius"));
  EXPECT_EQ(solids.sublist("C").get<double>("Density"), 1);
  EXPECT_THAT(document.source.place("Solids/A/Density"), HasSubstr("line 4"));
}

/// As presets have them, which scenes of other solids include.
TEST(SceneLanguage, DefaultsOfATypeThatNoSolidHasAreOfNoEffect) {
  const std::string defaults =
      list("Defaults", list("cloth", parameter("Mass", "string", "lumped")) +
                           list("Material", parameter("Poisson", "double", "0.3")));
  const Document document =
      expanded(defaults + list("Solids", list("A", parameter("Type", "string", "rigid body"))));
  EXPECT_FALSE(document.list.sublist("Solids").sublist("A").isParameter("cloth"));
  EXPECT_TRUE(document.list.sublist("Solids").sublist("A").isSublist("Material"));
  EXPECT_FALSE(expanded(defaults).list.isParameter("Defaults"));
}

TEST(SceneLanguage, ALatticeWithFormulasAndOverrides) {
  const Document document = expanded(list(
      "Solids",
      list("Ball",
           ball(parameter("Density", "double", "[100*copy]") +
                parameter("Position", "Array(double)", "{1, 2}") +
                list("Copies",
                     parameter("Type", "string", "lattice") +
                         parameter("Count", "Array(int)", "{2, 3}") +
                         parameter("Spacing", "Array(double)", "{0.5, 1}") +
                         list("Overrides", list("3", parameter("Density", "double", "5"))))))));

  EXPECT_EQ(n_solids(document), 6);
  const ParameterList& solids = document.list.sublist("Solids");
  EXPECT_EQ(solids.sublist("Ball 1").get<double>("Density"), 100);
  EXPECT_EQ(solids.sublist("Ball 3").get<double>("Density"), 5);
  EXPECT_EQ(solids.sublist("Ball 6").get<double>("Density"), 600);
  EXPECT_THAT(position(document, "Ball 1"), ElementsAre(1, 2));
  EXPECT_THAT(position(document, "Ball 6"), ElementsAre(1.5, 4));
  EXPECT_FALSE(solids.sublist("Ball 1").isParameter("Copies"));
}

TEST(SceneLanguage, RandomCopiesKeepApartFromEachOtherAndFromOtherBalls) {
  const auto scene = [](const std::string& seed) {
    return expanded(list(
        "Solids",
        list("Ball", ball(list("Copies", parameter("Type", "string", "random") +
                                             parameter("Count", "int", "30") +
                                             parameter("Seed", "int", seed) +
                                             parameter("Lower", "Array(double)", "{0, 0}") +
                                             parameter("Upper", "Array(double)", "{2, 1.5}")))) +
            list("Fixed", ball(parameter("Position", "Array(double)", "{1, 0.7}")))));
  };
  const Document document = scene("1");

  ASSERT_EQ(n_solids(document), 31);
  std::vector<std::vector<double>> places{position(document, "Fixed")};
  for (int i = 1; i <= 30; ++i)
    places.push_back(position(document, "Ball " + std::to_string(i)));
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_TRUE(places[i][0] >= 0 && places[i][0] <= 2 && places[i][1] >= 0 && places[i][1] <= 1.5);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE(std::hypot(places[i][0] - places[j][0], places[i][1] - places[j][1]), 0.2);
  }
  EXPECT_EQ(position(scene("1"), "Ball 30"), places[30]);
  EXPECT_NE(position(scene("2"), "Ball 30"), places[30]);
}

// Each by its own radius, by a formula or an override.
TEST(SceneLanguage, RandomCopiesOfManySizesKeepApart) {
  const std::string larger = list("3", list("Geometry", parameter("Radius", "double", "0.3")));
  const std::string copies =
      list("Copies", parameter("Type", "string", "random") + parameter("Count", "int", "20") +
                         parameter("Lower", "Array(double)", "{0, 0}") +
                         parameter("Upper", "Array(double)", "{2, 2}") + list("Overrides", larger));
  const std::string growing = list("Geometry", parameter("Shape", "string", "ball") +
                                                   parameter("Radius", "double", "[0.01*copy]"));
  const Document document = expanded(list("Solids", list("Ball", growing + copies)));
  const auto radius = [](int copy) { return copy == 3 ? 0.3 : 0.01 * copy; };
  for (int i = 1; i <= 20; ++i) {
    const auto one = position(document, "Ball " + std::to_string(i));
    for (int j = 1; j < i; ++j) {
      const auto other = position(document, "Ball " + std::to_string(j));
      EXPECT_GE(std::hypot(one[0] - other[0], one[1] - other[1]), radius(i) + radius(j));
    }
  }
}

TEST(SceneLanguage, CopiesThatCannotBeAreRefused) {
  const auto copies = [](const std::string& body) {
    return refusal(list("Solids", list("Ball", ball(list("Copies", body)))));
  };
  const std::string box =
      parameter("Lower", "Array(double)", "{0, 0}") + parameter("Upper", "Array(double)", "{1, 1}");
  EXPECT_THAT(
      copies(parameter("Type", "string", "random") + parameter("Count", "int", "900") + box),
      HasSubstr("of 900 places"));
  EXPECT_THAT(copies(parameter("Type", "string", "rows")), HasSubstr("lattice"));
  EXPECT_THAT(copies(parameter("Type", "string", "positions") +
                     parameter("Points", "Array(double)", "{1, 2, 3}")),
              HasSubstr("3 numbers"));
  EXPECT_THAT(
      copies(parameter("Type", "string", "positions") +
             parameter("Points", "Array(double)", "{1, 2}") + list("Overrides", list("2", ""))),
      HasSubstr("1 to 1"));
}

TEST(SceneLanguage, SettingsReachConstantsDefaultsAndCopies) {
  const std::string body =
      list("Defaults", parameter("Density", "double", "7")) +
      list("Solids",
           list("Ball", ball(list("Copies", parameter("Type", "string", "lattice") +
                                                parameter("Count", "Array(int)", "{1, 1}") +
                                                parameter("Spacing", "Array(double)", "{1, 1}")))));
  std::vector<std::string> settings{"Time/End=2", "Solids/Ball/Copies/Count={3, 1}",
                                    "Defaults/Density=9"};
  const Document document = expanded(body, settings);
  EXPECT_EQ(n_solids(document), 3);
  EXPECT_EQ(document.list.sublist("Solids").sublist("Ball 2").get<double>("Density"), 9);
}

class Includes : public testing::Test {
 protected:
  void SetUp() override {
    const auto comm = Tpetra::getDefaultComm();
    folder_ = std::filesystem::temp_directory_path() /
              ("lockstep-includes-" + std::to_string(comm->getSize()));
    if (comm->getRank() == 0)
      std::filesystem::create_directories(folder_ / "parts");
    comm->barrier();
  }
  void TearDown() override {
    const auto comm = Tpetra::getDefaultComm();
    comm->barrier();
    if (comm->getRank() == 0)
      std::filesystem::remove_all(folder_);
  }
  void write(const std::string& name, const std::string& body) const {
    const auto comm = Tpetra::getDefaultComm();
    if (comm->getRank() == 0)
      std::ofstream(folder_ / name) << list("Scene", body);
    comm->barrier();
  }
  Document read(const std::string& name, std::vector<std::string> settings = {}) const {
    Document document =
        read_parameters((folder_ / name).string(), Tpetra::getDefaultComm(), FormulaPolicy::kept);
    include_scenes(document, settings, Tpetra::getDefaultComm());
    expand_scene(document, settings, solid_types);
    return document;
  }
  std::filesystem::path folder_;
};

TEST_F(Includes, WhatTheFileSaysWinsAndMeshesMoveAlong) {
  write("parts/base.xml",
        parameter("Dimension", "int", "2") + list("Constants", parameter("R", "double", "1")) +
            list("Fluid",
                 parameter("Density", "double", "[R]") + parameter("Viscosity", "double", "3")) +
            list("Solids", list("A", parameter("File", "string", "a.obj"))));
  write("scene.xml", parameter("Include", "string", "parts/base.xml") +
                         list("Constants", parameter("R", "double", "5")) +
                         list("Fluid", parameter("Viscosity", "double", "4")));

  const Document document = read("scene.xml");

  EXPECT_EQ(document.list.get<int>("Dimension"), 2);
  EXPECT_EQ(document.list.sublist("Fluid").get<double>("Density"), 5);
  EXPECT_EQ(document.list.sublist("Fluid").get<double>("Viscosity"), 4);
  EXPECT_EQ(document.list.sublist("Solids").sublist("A").get<std::string>("File"), "parts/a.obj");
}

TEST_F(Includes, WhatTheCommandLineIncludesWinsOverTheFile) {
  write("parts/first.xml", list("Fluid", parameter("Advection", "string", "cubic")));
  write("parts/second.xml", list("Fluid", parameter("Advection", "string", "maccormack") +
                                              parameter("Viscosity", "double", "7")) +
                                list("Solids", list("A", parameter("File", "string", "a.obj"))));
  write("base.xml", list("Fluid", parameter("Density", "double", "1")));
  write("scene.xml", parameter("Include", "string", "base.xml") +
                         parameter("Dimension", "int", "2") +
                         list("Fluid", parameter("Viscosity", "double", "4")));

  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {"Include=parts/first.xml", "Include=parts/second.xml", "Fluid/Density=1"},
           {"Include={parts/first.xml, parts/second.xml}", "Fluid/Density=1"}}) {
    std::vector<std::string> left = settings;
    const Document document = read("scene.xml", left);
    const ParameterList& fluid = document.list.sublist("Fluid");
    EXPECT_EQ(fluid.get<std::string>("Advection"), "cubic");
    EXPECT_EQ(fluid.get<double>("Viscosity"), 7);
    EXPECT_EQ(fluid.get<double>("Density"), 1);  // from the scene's own include
    EXPECT_EQ(document.list.sublist("Solids").sublist("A").get<std::string>("File"), "parts/a.obj");
  }
  try {
    read("scene.xml", {"Include=none.xml"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--set \"Include=none.xml\""));
    EXPECT_THAT(error.what(), HasSubstr((folder_ / "none.xml").filename().string()));
  }
}

TEST_F(Includes, PlugInsOfAllFilesAreOneList) {
  const std::string one = "string", several = "Array(string)";
  write("parts/base.xml",
        parameter("Dimension", "int", "2") + parameter("Plug-ins", several, "{../lib/a.so, b.so}"));
  write("scene.xml",
        parameter("Include", "string", "parts/base.xml") + parameter("Plug-ins", one, "lib/c.so"));
  const auto files = [this](const std::vector<std::string>& settings) {
    std::vector<std::string> names;
    for (const std::string& file : plug_in_files(read("scene.xml", settings)))
      names.push_back(std::filesystem::path(file).lexically_relative(folder_).string());
    return names;
  };
  EXPECT_THAT(files({}), ElementsAre("lib/c.so", "lib/a.so", "parts/b.so"));
  EXPECT_THAT(files({"Plug-ins={d.so}"}), ElementsAre("d.so", "lib/a.so", "parts/b.so"));
  write("scene.xml", parameter("Dimension", "int", "2") + parameter("Plug-ins", one, "lib/c.so"));
  EXPECT_THAT(files({"Include=parts/base.xml"}), ElementsAre("lib/a.so", "parts/b.so", "lib/c.so"));
  write("scene.xml", parameter("Dimension", "int", "2") + parameter("Plug-ins", "int", "1"));
  EXPECT_THROW(files({}), InputError);
}

TEST_F(Includes, CirclesAreRefused) {
  write("a.xml", parameter("Include", "string", "b.xml"));
  write("b.xml", parameter("Include", "string", "a.xml"));
  try {
    read("a.xml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("includes itself"));
  }
}

TEST_F(Includes, MissingFilesAreNamedWithWhoIncludesThem) {
  write("a.xml", parameter("Include", "string", "none.xml"));
  try {
    read("a.xml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.xml, line 2"));
    EXPECT_THAT(error.what(), HasSubstr("none.xml"));
  }
}

}  // namespace
}  // namespace lockstep::test
