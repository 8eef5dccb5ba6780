#include "parameters/command_line.hpp"

#include "parameters/validate.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

Document scene() {
  return read_xml_string(R"(<ParameterList>
<ParameterList name="Solids"><ParameterList name="Ball 1">
<Parameter name="Type" type="string" value="ball"/>
<Parameter name="Radius" type="double" value="2"/></ParameterList></ParameterList>
<ParameterList name="Solver"><ParameterList name="Belos">
<Parameter name="Tolerance" type="double" value="1e-8"/></ParameterList></ParameterList>
</ParameterList>)",
                         "case.xml");
}

std::string setting(const std::string& assignment) {
  Document document = scene();
  return input_error([&] { set_from_command_line(document, assignment, scene_schema()); });
}

TEST(CommandLine, TypeComesFromTheSchema) {
  Document document = scene();
  for (const char* assignment :
       {"Fluid/Density=2", "Fluid/Steps=7", "Fluid/Gravity={0, 1}", "Scheme=semi-lagrangian",
        "Solids/Ball 1/Radius=3", "Solids/Ball 1/Locked=true", "Weights/Type=closest"}) {
    set_from_command_line(document, assignment, scene_schema());
  }

  validate(document, scene_schema());

  const ParameterList& fluid = document.list.sublist("Fluid");
  const ParameterList& ball = document.list.sublist("Solids").sublist("Ball 1");
  EXPECT_EQ(fluid.get<double>("Density"), 2);
  EXPECT_EQ(fluid.get<int>("Steps"), 7);
  EXPECT_EQ(fluid.get<ParameterArray<double>>("Gravity"), (make_array<double>({0, 1})));
  EXPECT_EQ(document.list.get<std::string>("Scheme"), "semi-lagrangian");
  EXPECT_EQ(ball.get<double>("Radius"), 3);
  EXPECT_TRUE(ball.get<bool>("Locked"));
  EXPECT_EQ(document.list.sublist("Weights").get<std::string>("Type"), "closest");
}

TEST(CommandLine, ArraysNeedNoBraces) {
  Document document = scene();

  set_from_command_line(document, "Fluid/Gravity=0,1", scene_schema());

  EXPECT_EQ(document.list.sublist("Fluid").get<ParameterArray<double>>("Gravity"),
            (make_array<double>({0, 1})));
}

TEST(CommandLine, FreeListsTakeTheTypeOfTheEntryOrOfTheText) {
  Document document = scene();
  for (const char* assignment :
       {"Solver/Belos/Tolerance=1", "Solver/New/Count=3", "Solver/New/Weight=1e-3",
        "Solver/New/On=true", "Solver/New/Word=1x"}) {
    set_from_command_line(document, assignment, scene_schema());
  }

  ParameterList& solver = document.list.sublist("Solver");
  EXPECT_EQ(solver.sublist("Belos").get<double>("Tolerance"), 1);
  EXPECT_EQ(solver.sublist("New").get<int>("Count"), 3);
  EXPECT_EQ(solver.sublist("New").get<double>("Weight"), 1e-3);
  EXPECT_TRUE(solver.sublist("New").get<bool>("On"));
  EXPECT_EQ(solver.sublist("New").get<std::string>("Word"), "1x");
}

TEST(CommandLine, ChangingTheTypeOfASolidLeavesItsOtherParametersToValidation) {
  Document document = scene();

  set_from_command_line(document, "Solids/Ball 1/Type=box", scene_schema());

  EXPECT_THAT(input_error([&] { validate(document, scene_schema()); }),
              ::testing::HasSubstr("case.xml, line 4: in \"Solids/Ball 1\", \"Radius\" is not a "
                                   "parameter."));
}

TEST(CommandLine, MistakesNameTheSetting) {
  EXPECT_EQ(setting("Fluid/Densty=2"),
            "--set \"Fluid/Densty=2\": in \"Fluid\", \"Densty\" is not a parameter. Did you mean "
            "\"Density\" (double, default 1000)?\nValid here: \"Density\", \"Viscosity\", "
            "\"Gravity\", \"Steps\", \"Fixed step\".");
  EXPECT_EQ(
      setting("Fluid/Density=2x"),
      "--set \"Fluid/Density=2x\": in \"Fluid\", \"Density\" is \"2x\", which is not a number.");
  EXPECT_EQ(
      setting("Fluid/Steps=1e3"),
      "--set \"Fluid/Steps=1e3\": in \"Fluid\", \"Steps\" is \"1e3\", which is not an integer "
      "(write 1000).");
  EXPECT_EQ(setting("Solids/Ball 2/Radius=1"),
            "--set \"Solids/Ball 2/Radius=1\": in \"Solids\", there is no list \"Ball 2\". Did you "
            "mean \"Ball 1\"?\nThere are: \"Ball 1\".");
  EXPECT_EQ(setting("Solids/Ball 1/Size=1"),
            "--set \"Solids/Ball 1/Size=1\": in \"Solids/Ball 1\", \"Size\" is not a "
            "parameter.\nValid here: \"Type\", \"Radius\", \"Locked\".");
  EXPECT_EQ(setting("Fluid=2"),
            "--set \"Fluid=2\": at the top level, \"Fluid\" is a list; name one of its parameters, "
            "\"Fluid/...\".");
  EXPECT_EQ(setting("Solids/Ball 1=2"),
            "--set \"Solids/Ball 1=2\": in \"Solids\", \"Ball 1\" is a list; name one of its "
            "parameters, \"Solids/Ball 1/...\".");
  EXPECT_EQ(setting("Scheme/X=2"),
            "--set \"Scheme/X=2\": at the top level, \"Scheme\" is a parameter, not a list.");
  EXPECT_EQ(setting("Density"),
            "--set \"Density\": write a path and a value, as in --set \"List/Sub "
            "list/Name=value\".");
}

TEST(CommandLine, NumbersMayBeFormulasOfConstants) {
  Document document = scene();
  document.constants = {{"R", 2}, {"n", 3}};
  ParameterList valid = scene_schema();
  declare(valid, "Title", "", "A text, in which brackets are brackets.");
  for (const char* assignment :
       {"Fluid/Density=[500*R]", "Fluid/Steps=[n]", "Fluid/Gravity={0, [-R]}", "Title=[R]"})
    set_from_command_line(document, assignment, valid);

  validate(document, valid);

  EXPECT_EQ(document.list.get<std::string>("Title"), "[R]");
  const ParameterList& fluid = document.list.sublist("Fluid");
  EXPECT_EQ(fluid.get<double>("Density"), 1000);
  EXPECT_EQ(fluid.get<int>("Steps"), 3);
  EXPECT_EQ(fluid.get<ParameterArray<double>>("Gravity"), (make_array<double>({0, -2})));
}

TEST(CommandLine, WrongFormulasNameTheSettingAndTheConstants) {
  const auto refusal = [](const std::string& assignment, const Variables& constants) {
    Document document = scene();
    document.constants = constants;
    return input_error([&] { set_from_command_line(document, assignment, scene_schema()); });
  };
  const std::string where = ": in \"Fluid\", ";
  EXPECT_EQ(refusal("Fluid/Density=[Radus]", {{"Radius", 2}, {"U", 1}}),
            "--set \"Fluid/Density=[Radus]\"" + where +
                "\"Density\": cannot evaluate \"Radus\": Unexpected token \"Radus\" found at "
                "position 0. Did you mean \"Radius\"? Known names: Radius, U.");
  EXPECT_THAT(refusal("Fluid/Density=[R]", {}), ::testing::HasSubstr("there are no constants."));
  EXPECT_EQ(refusal("Fluid/Steps=[R]", {{"R", 2.5}}),
            "--set \"Fluid/Steps=[R]\"" + where +
                "\"Steps\" = \"[R]\" is \"2.5\", which is not an integer.");
}

TEST(CommandLine, ValidationNamesTheSettingAsThePlace) {
  Document document = scene();

  set_from_command_line(document, "Fluid/Density=-1", scene_schema());

  EXPECT_EQ(input_error([&] { validate(document, scene_schema()); }),
            "--set \"Fluid/Density=-1\": in \"Fluid\", \"Density\" is -1, but must be greater than "
            "0.");
}

}  // namespace
}  // namespace lockstep::test
