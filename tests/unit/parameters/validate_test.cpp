#include "parameters/validate.hpp"

#include "support.hpp"

namespace lockstep::test {
namespace {

/// The message for a scene of these lines, the first of which is line 2.
std::string validating(const std::string& lines) {
  Document document =
      read_xml_string("<ParameterList>\n" + lines + "\n</ParameterList>", "case.xml");
  return input_error([&] { validate(document, scene_schema()); });
}

std::string in_fluid(const std::string& parameter) {
  return validating("<ParameterList name=\"Fluid\">\n" + parameter + "\n</ParameterList>");
}

TEST(Validate, FillsInDefaultsAndKeepsWhatIsGiven) {
  Document document = read_xml_string(R"xml(<ParameterList>
<ParameterList name="Fluid"><Parameter name="Density" type="double" value="998"/></ParameterList>
<ParameterList name="Solids"><ParameterList name="Ball 1">
<Parameter name="Type" type="string" value="ball"/>
<Parameter name="Radius" type="double" value="2"/></ParameterList></ParameterList>
<ParameterList name="Solver"><Parameter name="Anything" type="int" value="1"/></ParameterList>
</ParameterList>)xml",
                                      "case.xml");

  validate(document, scene_schema());

  const ParameterList& list = document.list;
  EXPECT_EQ(list.get<std::string>("Scheme"), "maccormack");
  EXPECT_EQ(list.sublist("Fluid").get<double>("Density"), 998);
  EXPECT_EQ(list.sublist("Fluid").getEntry("Density").docString(), "Mass density [kg/m^3].");
  EXPECT_FALSE(list.sublist("Fluid").getEntry("Density").isDefault());
  EXPECT_EQ(list.sublist("Fluid").get<int>("Steps"), 10);
  EXPECT_TRUE(list.sublist("Fluid").getEntry("Steps").isDefault());
  EXPECT_FALSE(list.sublist("Fluid").isParameter("Fixed step"));
  EXPECT_FALSE(list.sublist("Solids").sublist("Ball 1").get<bool>("Locked"));
  EXPECT_EQ(list.sublist("Weights").get<std::string>("Type"), "area");
  EXPECT_EQ(list.sublist("Solver").get<int>("Anything"), 1);
}

TEST(Validate, MisspeltNameGetsPlacePathAndSuggestion) {
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Densty" type="double" value="1"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Densty\" is not a parameter. Did you mean "
            "\"Density\" (double, default 1000)?\nValid here: \"Density\", \"Viscosity\", "
            "\"Gravity\", \"Steps\", \"Fixed step\".");
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Colour" type="double" value="1"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Colour\" is not a parameter.\nValid here: "
            "\"Density\", \"Viscosity\", \"Gravity\", \"Steps\", \"Fixed step\".");
  EXPECT_EQ(validating("<ParameterList name=\"Fluids\"/>"),
            "case.xml, line 2: at the top level, \"Fluids\" is not a parameter. Did you mean "
            "\"Fluid\" (a list)?\nValid here: \"Scheme\", \"Fluid\", \"Solids\", \"Weights\", "
            "\"Solver\".");
}

TEST(Validate, WhatBecameOfAFormerNameIsTold) {
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Crest" type="double" value="1"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Crest\" is always 0 now: leave it out.");
  // A list other than the one that had it never knew the name.
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Margin" type="double" value="1"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Margin\" is not a parameter.\nValid here: "
            "\"Density\", \"Viscosity\", \"Gravity\", \"Steps\", \"Fixed step\".");
}

TEST(Validate, WrongTypesAreExplained) {
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Density" type="int" value="1000"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Density\" has type \"int\", but needs \"double\": "
            "write type=\"double\" value=\"1000\".");
  EXPECT_EQ(
      in_fluid(R"xml(<Parameter name="Steps" type="double" value="1"/>)xml"),
      "case.xml, line 3: in \"Fluid\", \"Steps\" has type \"double\", but needs \"int\": write "
      "type=\"int\".");
  EXPECT_EQ(
      in_fluid(R"xml(<ParameterList name="Density"/>)xml"),
      "case.xml, line 3: in \"Fluid\", \"Density\" must be a parameter (double), not a list.");
  EXPECT_EQ(validating(R"xml(<Parameter name="Fluid" type="string" value="water"/>)xml"),
            "case.xml, line 2: at the top level, \"Fluid\" must be a list, <ParameterList "
            "name=\"Fluid\">, not a parameter.");
}

TEST(Validate, ValuesOutOfBoundsNameTheBound) {
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Density" type="double" value="0"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Density\" is 0, but must be greater than 0.");
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Viscosity" type="double" value="-1e-3"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Viscosity\" is -0.001, but must be at least 0.");
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Viscosity" type="double" value="0"/>)xml"), "");
  EXPECT_EQ(in_fluid(R"xml(<Parameter name="Steps" type="int" value="0"/>)xml"),
            "case.xml, line 3: in \"Fluid\", \"Steps\" is 0, but must be at least 1.");
  EXPECT_EQ(
      in_fluid(R"xml(<Parameter name="Gravity" type="Array(double)" value="{0,0,1}"/>)xml"),
      "case.xml, line 3: in \"Fluid\", \"Gravity\" has 3 components, {0, 0, 1}, but needs 2.");
  EXPECT_EQ(validating(R"xml(<Parameter name="Scheme" type="string" value="macormack"/>)xml"),
            "case.xml, line 2: at the top level, \"Scheme\" is \"macormack\", but must be one of "
            "\"maccormack\", \"semi-lagrangian\"; did you mean \"maccormack\"?");
}

TEST(Validate, BoundsHoldForRangesAndArrays) {
  ParameterList valid;
  declare_between(valid, "Fraction", 0.5, 0.0, 1.0, "A fraction.");
  declare(valid, "Lengths", make_array<double>({1, 2}), "Lengths [m].");
  set_positive(valid, "Lengths");
  const Source source{"case.xml", {}};
  ParameterList above, negative, edge;
  above.set("Fraction", 1.5);
  negative.set("Lengths", make_array<double>({1, -2}));
  edge.set("Fraction", 1.0);

  EXPECT_EQ(
      input_error([&] { validate(above, valid, source); }),
      "case.xml: at the top level, \"Fraction\" is 1.5, but must be at least 0 and at most 1.");
  EXPECT_EQ(input_error([&] { validate(negative, valid, source, "Box"); }),
            "case.xml: in \"Box\", \"Lengths\" is {1, -2}, but must be greater than 0.");
  EXPECT_EQ(input_error([&] { validate(edge, valid, source); }), "");
}

TEST(Validate, RequiredParametersAreNamed) {
  EXPECT_EQ(
      validating("<ParameterList name=\"Solids\">\n<ParameterList name=\"A\">\n"
                 "<Parameter name=\"Type\" type=\"string\" value=\"ball\"/>\n"
                 "</ParameterList></ParameterList>"),
      "case.xml, line 3: in \"Solids/A\", the parameter \"Radius\" (double, greater than 0) is "
      "required: Radius [m].");
}

TEST(Validate, OptionalListsRequireOnlyWhereGiven) {
  ParameterList valid;
  declare_required<double>(declare_optional_list(valid, "Smoke", "Smoke."), "Rate", "Rate [1/s].");
  const Source source{"case.xml", {}};
  ParameterList without, with;
  with.sublist("Smoke");

  EXPECT_EQ(input_error([&] { validate(without, valid, source); }), "");
  EXPECT_FALSE(without.isParameter("Smoke"));
  EXPECT_EQ(input_error([&] { validate(with, valid, source); }),
            "case.xml: in \"Smoke\", the parameter \"Rate\" (double) is required: Rate [1/s].");
}

TEST(Validate, AllMistakesOfAFileAreToldTogether) {
  Document document = read_xml_string(R"xml(<ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="heavy"/>
    <Parameter name="Steps" type="int" value="0"/>
    <Parameter name="Visosity" type="double" value="1"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="A"><Parameter name="Type" type="string" value="box"/></ParameterList>
  </ParameterList>
  <Parameter name="Scheme" type="int" value="1"/>
  <ParameterList name="Solver"><Parameter name="Anything" type="int" value="1.5"/></ParameterList>
</ParameterList>)xml",
                                      "case.xml", FormulaPolicy::kept);

  const std::string message = input_error([&] { validate(document, scene_schema()); });

  EXPECT_THAT(message, ::testing::StartsWith("There are 6 mistakes:\n1. case.xml, line "));
  for (const char* part :
       {"line 3: in \"Fluid\", \"Density\" is \"heavy\"", "line 4: in \"Fluid\", \"Steps\" is 0",
        "line 5: in \"Fluid\", \"Visosity\" is not a parameter", "\"Size\" (Array(double), 2",
        "line 10: at the top level, \"Scheme\" has type \"int\"",
        "line 11: in \"Solver\", \"Anything\" is \"1.5\""})
    EXPECT_THAT(message, ::testing::HasSubstr(part));
}

TEST(Validate, TypeChoosesTheSchema) {
  const auto solid = [](const std::string& parameters) {
    return validating("<ParameterList name=\"Solids\">\n<ParameterList name=\"A\">\n" + parameters +
                      "\n</ParameterList></ParameterList>");
  };
  const std::string radius = R"xml(<Parameter name="Radius" type="double" value="1"/>)xml";
  const auto type = [](const std::string& name) {
    return "<Parameter name=\"Type\" type=\"string\" value=\"" + name + "\"/>";
  };

  EXPECT_EQ(solid(type("ball") + radius), "");
  EXPECT_EQ(solid(type("box") + "\n" + radius),
            "There are 2 mistakes:\n"
            "1. case.xml, line 5: in \"Solids/A\", \"Radius\" is not a parameter.\nValid here: "
            "\"Type\", \"Size\".\n"
            "2. case.xml, line 3: in \"Solids/A\", the parameter \"Size\" (Array(double), 2 "
            "components) is required: Edge lengths [m].");
  EXPECT_EQ(solid(type("bal")),
            "case.xml, line 4: in \"Solids/A\", \"Type\" is \"bal\", but must be one of \"ball\", "
            "\"box\"; did you mean \"ball\"?");
  EXPECT_EQ(solid(""),
            "case.xml, line 3: in \"Solids/A\", the parameter \"Type\" (string, one of \"ball\", "
            "\"box\") is required: Type of this list, which decides its other parameters.");
  EXPECT_EQ(validating("<ParameterList name=\"Solids\">\n"
                       "<Parameter name=\"Radius\" type=\"double\" value=\"1\"/></ParameterList>"),
            "case.xml, line 3: in \"Solids\", \"Radius\" is a parameter, but this list holds lists "
            "only: write <ParameterList name=\"Radius\">.");
}

TEST(Declare, RefusesWhatCouldNotBeNamedOrWritten) {
  ParameterList list;
  declare(list, "A", 1, "First.");

  EXPECT_THROW(declare(list, "A", 2, "Twice."), InputError);
  EXPECT_THROW(declare(list, "a/b", 2, "Slash."), InputError);
  EXPECT_THROW(declare(list, "B", std::numeric_limits<double>::infinity(), "Infinite."),
               InputError);
}

}  // namespace
}  // namespace lockstep::test
