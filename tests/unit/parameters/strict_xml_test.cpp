#include <Tpetra_Core.hpp>
#include <cstdio>
#include <fstream>

#include "parameters/files/parameter_file.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct BadValue {
  const char* type;
  const char* value;
  const char* complaint;
};

void PrintTo(const BadValue& bad, std::ostream* out) {
  *out << bad.type << " " << bad.value;
}

class BadValues : public ::testing::TestWithParam<BadValue> {};

TEST_P(BadValues, AreRefusedWithFileLineAndReason) {
  const auto [type, value, complaint] = GetParam();
  const std::string message =
      reading(file_with(fmt::format(R"xml(name="X" type="{}" value="{}")xml", type, value)));
  EXPECT_EQ(message, fmt::format(R"xml(case.xml, line 3: in "Fluid", "X" {} (type "{}").)xml",
                                 complaint, type));
}

INSTANTIATE_TEST_SUITE_P(
    Traps, BadValues,
    ::testing::Values(
        BadValue{"double", "abc", "is \"abc\", which is not a number"},
        BadValue{"double", "1e-3x", "is \"1e-3x\", which is not a number"},
        BadValue{"double", "1,5",
                 "is \"1,5\", which is not a number (the decimal mark is a point)"},
        BadValue{"double", "", "is empty, but must be a number"},
        BadValue{"double", "0x10", "is \"0x10\", which is not a number"},
        BadValue{"double", "nan", "is \"nan\", but must be finite"},
        BadValue{"double", "inf", "is \"inf\", but must be finite"},
        BadValue{"double", "-inf", "is \"-inf\", but must be finite"},
        BadValue{"double", "1e400", "is \"1e400\", which no double can hold"},
        BadValue{"int", "1e3", "is \"1e3\", which is not an integer (write 1000)"},
        BadValue{"int", "1.5", "is \"1.5\", which is not an integer"},
        BadValue{"int", "ten", "is \"ten\", which is not an integer"},
        BadValue{"int", "", "is empty, but must be an integer"},
        BadValue{"int", "3000000000", "is \"3000000000\", which no int can hold"},
        BadValue{"bool", "on", "is \"on\", but a bool is true or false"},
        BadValue{"Array(double)", "{1,2,x}",
                 "is \"{1,2,x}\", whose component 3 is \"x\", which is not a number"},
        BadValue{"Array(double)", "{1,2,}",
                 "is \"{1,2,}\", whose component 3 is empty, but must be a number"},
        BadValue{"Array(double)", "1,2",
                 "is \"1,2\", but an array is written in braces: {1, 2, 3}"},
        BadValue{"Array(int)", "{1,2.5}",
                 "is \"{1,2.5}\", whose component 2 is \"2.5\", which is not an integer"},
        BadValue{"Array(string)", "{a,,b}", "is \"{a,,b}\", whose component 2 is empty"}));

TEST(StrictXml, ReadsEveryTypeExactly) {
  const Document document = read_xml_string(R"xml(<?xml version="1.0"?>
<!-- a comment -->
<ParameterList name="scene">
  <Parameter name="d" type="double" value=" +1e-3 "/>
  <Parameter name="i" type="int" value="-7"/>
  <Parameter name="b" type="bool" value="yes"/>
  <Parameter name="s" type="string" value="a &lt; b"/>
  <ParameterList name="Sub list">
    <Parameter name="ad" type="Array(double)" value="{1, .5, -2e1}"/>
    <Parameter name="ai" type="Array(int)" value="{}"/>
    <Parameter name="as" type="Array(string)" value="{one, two words}"/>
  </ParameterList>
</ParameterList>)xml",
                                            "case.xml");

  const ParameterList& list = document.list;
  EXPECT_EQ(list.get<double>("d"), 1e-3);
  EXPECT_EQ(list.get<int>("i"), -7);
  EXPECT_TRUE(list.get<bool>("b"));
  EXPECT_EQ(list.get<std::string>("s"), "a < b");
  const ParameterList& sub = list.sublist("Sub list");
  EXPECT_EQ(sub.get<ParameterArray<double>>("ad"), (make_array<double>({1, 0.5, -20})));
  EXPECT_EQ(sub.get<ParameterArray<int>>("ai").size(), 0);
  EXPECT_EQ(sub.get<ParameterArray<std::string>>("as"),
            (make_array<std::string>({"one", "two words"})));
  EXPECT_EQ(list.name(), "case.xml");
  EXPECT_EQ(document.source.place("Sub list/ai"), "case.xml, line 10");
  EXPECT_EQ(document.source.place("Sub list/defaulted"), "case.xml, line 8");
  EXPECT_EQ(document.source.place("defaulted"), "case.xml");
}

TEST(StrictXml, RefusesUnknownTypesAndAttributes) {
  EXPECT_EQ(reading(file_with(R"xml(name="X" type="dbl" value="1")xml")),
            "case.xml, line 3: in \"Fluid\", \"X\" has the unknown type \"dbl\"; types are double, "
            "int, bool, string, Array(double), Array(int), Array(string).");
  EXPECT_EQ(reading(file_with(R"xml(name="X" type="int" vlaue="1")xml")),
            "case.xml, line 3: \"vlaue\" is not an attribute of <Parameter> of \"X\". Did you mean "
            "\"value\"?");
  EXPECT_EQ(reading(file_with(R"xml(name="X" type="int")xml")),
            "case.xml, line 3: the <Parameter> of \"X\" has no attribute \"value\".");
  EXPECT_EQ(reading(file_with(R"xml(name="X" value="1")xml")),
            "case.xml, line 3: the <Parameter> of \"X\" has no attribute \"type\".");
  EXPECT_EQ(reading(file_with(R"xml(type="int" value="1")xml")),
            "case.xml, line 3: the <Parameter> has no attribute \"name\".");
  EXPECT_EQ(reading(file_with(R"xml(name=" " type="int" value="1")xml")),
            "case.xml, line 3: the <Parameter> has an empty name.");
}

TEST(StrictXml, RefusesNamesGivenTwice) {
  const std::string twice = reading(
      "<ParameterList>\n<Parameter name=\"X\" type=\"int\" value=\"1\"/>\n"
      "<Parameter name=\"X\" type=\"int\" value=\"2\"/>\n</ParameterList>");
  EXPECT_EQ(twice,
            "case.xml, line 3: at the top level, \"X\" is given twice, first in case.xml, line 2. "
            "Remove one of the two.");
  const std::string list_twice = reading(
      "<ParameterList>\n<ParameterList name=\"L\"/>\n<ParameterList name=\"L\"/>\n"
      "</ParameterList>");
  EXPECT_THAT(list_twice, StartsWith("case.xml, line 3: at the top level, \"L\" is given twice"));
  const std::string both = reading(
      "<ParameterList>\n<ParameterList name=\"L\"/>\n"
      "<Parameter name=\"L\" type=\"int\" value=\"2\"/>\n</ParameterList>");
  EXPECT_THAT(both, StartsWith("case.xml, line 3: at the top level, \"L\" is given twice"));
}

TEST(StrictXml, RefusesWhatIsNotAParameterFile) {
  EXPECT_EQ(reading(" \n"), "case.xml is empty; a parameter file holds one <ParameterList>.");
  EXPECT_EQ(reading("<Scene/>"),
            "case.xml, line 1: the file must hold one <ParameterList>, not <Scene>.");
  EXPECT_EQ(
      reading("<ParameterList>\n<ParameterList name=\"L\">\n</ParameterLst>\n"),
      "case.xml, line 3: this is not well-formed XML (mismatched tag). The <ParameterList> of "
      "line 2 is not closed.");
  EXPECT_EQ(reading("<ParameterList>\n<Parameter name=\"X\" type=\"int\" value=\"1\">\n"
                    "</ParameterList>"),
            "case.xml, line 3: this is not well-formed XML (mismatched tag). The <Parameter> of "
            "line 2 is not closed; end it with \"/>\".");
  EXPECT_THAT(reading("<ParameterList>\n"),
              StartsWith("case.xml, line 2: this is not well-formed XML"));
  EXPECT_EQ(reading("<ParameterList>\n<Paramter name=\"X\"/>\n</ParameterList>"),
            "case.xml, line 2: at the top level, <Paramter> is not an element of a parameter file. "
            "Did you mean <Parameter>?");
  EXPECT_THAT(reading("<ParameterList>\nhello</ParameterList>"),
              HasSubstr("line 2: the text \"hello\" stands between the elements"));
  EXPECT_THAT(reading("<ParameterList>\n<ParameterList/>\n</ParameterList>"),
              StartsWith("case.xml, line 2: the <ParameterList> has no attribute \"name\""));
  EXPECT_THAT(reading("<!DOCTYPE x [<!ENTITY a \"b\">]>\n<ParameterList/>"),
              HasSubstr("<!DOCTYPE>"));
}

/// A list that was called a parameter: what it holds is looked at, too, and each end closes what it
/// belongs to. (One end too many closed the document.)
TEST(StrictXml, ParametersWithinAParameterAreTold) {
  const std::string message = reading(
      R"(<ParameterList name="a">
  <Parameter name="b" type="int" value="1">
    <Parameter name="c" type="int" value="2"/>
    <Parameter name="d" type="int" value="3"/>
  </Parameter>
  <Parameter name="e" type="int" value="x"/>
</ParameterList>)");
  EXPECT_THAT(message, HasSubstr("case.xml, line 3: a <Parameter> holds nothing"));
  EXPECT_THAT(message, HasSubstr("case.xml, line 4: a <Parameter> holds nothing"));
  EXPECT_THAT(message, HasSubstr("case.xml, line 6"));
}

TEST(StrictXml, EveryRankReadsOrFailsAlike) {
  const auto comm = Tpetra::getDefaultComm();
  const std::string file = fmt::format("strict_xml_{}.xml", comm->getSize());
  if (is_root(comm))
    std::ofstream(file) << file_with(R"xml(name="X" type="double" value="2.5")xml");

  const Document document = read_parameters(file, comm);
  const std::string missing = input_error([&] { read_parameters("no/such.xml", comm); });
  const std::string folder = input_error([&] { read_parameters(".", comm); });

  EXPECT_EQ(document.list.sublist("Fluid").get<double>("X"), 2.5);
  EXPECT_EQ(missing,
            "Cannot read \"no/such.xml\": No such file or directory. Give the path of an XML "
            "parameter file.");
  EXPECT_EQ(folder, "Cannot read \".\": it is a folder. Give the path of an XML parameter file.");
  if (is_root(comm))
    std::remove(file.c_str());
}

TEST(Source, ResolvesPathsAgainstTheScene) {
  EXPECT_EQ(resolve_path("xml-params/scenes/a.xml", "../solvers/x.xml"),
            "xml-params/solvers/x.xml");
  EXPECT_EQ(resolve_path("a.xml", "x.xml"), "x.xml");
  EXPECT_EQ(resolve_path("scenes/a.xml", "/abs/x.xml"), "/abs/x.xml");
}

TEST(Source, MergedFileFillsInAndTheSceneWins) {
  Document scene = read_xml_string(R"xml(<ParameterList>
<ParameterList name="Solver"><ParameterList name="Belos">
<Parameter name="Tolerance" type="double" value="1e-9"/>
</ParameterList></ParameterList></ParameterList>)xml",
                                   "scene.xml");
  const Document solver = read_xml_string(R"xml(<ParameterList>
<ParameterList name="Belos">
<Parameter name="Tolerance" type="double" value="1e-4"/>
<Parameter name="Blocks" type="int" value="5"/>
</ParameterList></ParameterList>)xml",
                                          "solver.xml");
  Document conflict = read_xml_string(
      "<ParameterList>\n<Parameter name=\"Belos\" type=\"int\" value=\"1\"/></ParameterList>",
      "bad.xml");

  merge(scene, "Solver", solver);

  const ParameterList& belos = scene.list.sublist("Solver").sublist("Belos");
  EXPECT_EQ(belos.get<double>("Tolerance"), 1e-9);
  EXPECT_EQ(belos.get<int>("Blocks"), 5);
  EXPECT_EQ(scene.source.place("Solver/Belos/Blocks"), "solver.xml, line 4");
  EXPECT_EQ(scene.source.place("Solver/Belos/Tolerance"), "scene.xml, line 3");
  EXPECT_EQ(
      input_error([&] { merge(conflict, "", solver); }),
      "bad.xml, line 2: at the top level, \"Belos\" is a parameter, but solver.xml, line 2 has "
      "a list of this name.");
}

}  // namespace
}  // namespace lockstep::test
