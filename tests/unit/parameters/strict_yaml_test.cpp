#include "parameters/files/strict_yaml.hpp"

#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/untyped.hpp"
#include "parameters/validate.hpp"
#include "parameters/write.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;

std::string reading_yaml(const std::string& text) {
  return input_error([&] { read_yaml_string(text, "case.yaml"); });
}

/// The message for a scene of the small schema.
std::string validating_yaml(const std::string& text) {
  return input_error([&] {
    Document document = read_yaml_string(text, "case.yaml");
    validate(document, scene_schema());
  });
}

TEST(StrictYaml, ValuesTakeTheTypesOfTheirParameters) {
  Document document = read_yaml_string(R"yaml(# a comment
Scheme: semi-lagrangian
Fluid:
  Density: 998            # an integer is good for a double
  Gravity: [0, -9.81]
  Steps: 12
Solids:
  "1": {Type: ball, Radius: 1e-1, Locked: true}
Solver:
  Tolerance: 1.0
  Iterations: 10
  Name: "10"
  Verbose: false
  Levels: [1, 2]
  Weights: [1, 2.5]
  Words: [one, two words]
  List: {}
)yaml",
                                       "case.yaml");
  validate(document, scene_schema());

  const ParameterList& list = document.list;
  EXPECT_EQ(list.get<std::string>("Scheme"), "semi-lagrangian");
  const ParameterList& fluid = list.sublist("Fluid");
  EXPECT_EQ(fluid.get<double>("Density"), 998.);
  EXPECT_EQ(fluid.get<ParameterArray<double>>("Gravity")[1], -9.81);
  EXPECT_EQ(fluid.get<int>("Steps"), 12);
  EXPECT_EQ(list.sublist("Solids").sublist("1").get<double>("Radius"), .1);
  EXPECT_TRUE(list.sublist("Solids").sublist("1").get<bool>("Locked"));
  const ParameterList& solver = list.sublist("Solver");
  EXPECT_EQ(solver.get<double>("Tolerance"), 1.);
  EXPECT_EQ(solver.get<int>("Iterations"), 10);
  EXPECT_EQ(solver.get<std::string>("Name"), "10");
  EXPECT_FALSE(solver.get<bool>("Verbose"));
  EXPECT_EQ(solver.get<ParameterArray<int>>("Levels")[1], 2);
  EXPECT_EQ(solver.get<ParameterArray<double>>("Weights")[0], 1.);
  EXPECT_EQ(solver.get<ParameterArray<std::string>>("Words")[1], "two words");
  EXPECT_TRUE(solver.isSublist("List"));
  EXPECT_EQ(document.source.place("Fluid/Density"), "case.yaml, line 4");
}

struct Wrong {
  const char* text;
  const char* message;
};
void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.text;
}
class WrongYaml : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongYaml, IsToldWithItsLine) {
  EXPECT_THAT(validating_yaml(GetParam().text), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Form, WrongYaml,
    ::testing::Values(
        Wrong{"", "case.yaml is empty"}, Wrong{"# nothing\n", "case.yaml is empty"},
        Wrong{"<ParameterList/>", "case.yaml is XML, not YAML"},
        Wrong{"\xff", "case.yaml is no text in UTF-8"},
        Wrong{"a", "case.yaml, line 1: a parameter file holds names and values"},
        Wrong{"[1]", "case.yaml, line 1: a parameter file holds names and values, not an array"},
        Wrong{"Scheme: {a", "this is not well-formed YAML"},
        Wrong{"Fluid:\n\tSteps: 1", "case.yaml, line 2: this is not well-formed YAML"},
        Wrong{"Fluid:\n  Steps: 1\n  Steps: 2",
              "case.yaml, line 3: in \"Fluid\", \"Steps\" is given twice, first in case.yaml, line "
              "2"},
        Wrong{"Fluid:\n  Steps: 1\nFluid:\n  Density: 2",
              "case.yaml, line 3: at the top level, \"Fluid\" is given twice"},
        Wrong{"Scheme:\nFluid: {}", "case.yaml, line 1: at the top level, \"Scheme\" has no value"},
        Wrong{"Fluid:\n  Gravity: {0, 1}", "an array is written in brackets"},
        Wrong{"Fluid: &f {}", "line 1: anchors"},
        Wrong{"Fluid: &f {}\nWeights: *f", "line 2: anch"},
        Wrong{"Fluid:\n  <<: {}", "case.yaml, line 2: merges (<<) of YAML are not read"},
        Wrong{"Fluid:\n  Steps: !!int 1", "line 2: the tag \"tag:yaml.org,2002:int\" is not read"},
        Wrong{"Fluid: {}\n---\nFluid: {}", "line 2: a second document begins here"},
        Wrong{"? [a, b]\n: 1", "case.yaml, line 1: a name cannot be an array"},
        Wrong{"? {a: b}\n: 1\nFluid: 3", "case.yaml, line 1: a name cannot be a list"},
        Wrong{"Fluid:\n  Gravity: [[R], 1]",
              "arrays do not nest; a formula in brackets is written"},
        Wrong{"Fluid:\n  - Steps: 1", "lists are named"},
        Wrong{"Scheme: \"a\\0b\"", "holds a control character"}));

INSTANTIATE_TEST_SUITE_P(
    Values, WrongYaml,
    ::testing::Values(
        Wrong{"Fluid:\n  Densty: 1",
              "case.yaml, line 2: in \"Fluid\", \"Densty\" is not a parameter. Did you mean "
              "\"Density\" (double, default 1000)?"},
        Wrong{"Fluid:\n  Density: heavy",
              "line 2: in \"Fluid\", \"Density\" is \"heavy\", which is not a number (type "
              "\"double\")."},
        Wrong{"Fluid:\n  Density: \"998\"", "is the string \"998\", but must be a number"},
        Wrong{"Fluid:\n  Density: 1,5", "(the decimal mark is a point)"},
        Wrong{"Fluid:\n  Density: -1", "\"Density\" is -1, but must be greater than 0"},
        Wrong{"Fluid:\n  Density: .inf", "is \".inf\", which is not a number"},
        Wrong{"Fluid:\n  Density: [1]", "is the array [1], but must be one value"},
        Wrong{"Fluid:\n  Density: {a: 1}", "\"Density\" must be a parameter (double), not a list"},
        Wrong{"Fluid:\n  Density: \"[2*R]\"", "is the string \"[2*R]\", but must be a number"},
        Wrong{"Fluid:\n  Steps: 1.0", "is \"1.0\", which is not an integer (write 1)"},
        Wrong{"Fluid:\n  Steps: 0x10", "is \"0x10\", which is not an integer"},
        Wrong{"Fluid:\n  Steps: 1_000", "is \"1_000\", which is not an integer"},
        Wrong{"Fluid:\n  Gravity: 0, 1",
              "is \"0, 1\", but an array is written in brackets: [1, 2, 3]"},
        Wrong{"Fluid:\n  Gravity: [0]", "has 1 component"},
        Wrong{"Fluid: 3", "line 1: at the top level, \"Fluid\" must be a list"},
        Wrong{"Solids:\n  Ball: 3", "line 2: in \"Solids\", \"Ball\" is a value, but this list"},
        Wrong{"Solids:\n  B: {Type: bal, Radius: 1}", "did you mean \"ball\"?"},
        Wrong{"Solids:\n  B: {Type: ball, Radius: 1, Locked: yes}",
              "\"Locked\" is \"yes\", but a bool is written true or false, without quotes"},
        Wrong{"Solids:\n  B: {Type: ball, Radius: 1, Locked: True}", "is written true or false"},
        Wrong{"Solids:\n  B: {Type: ball}", "the parameter \"Radius\" (double"}));

TEST(StrictYaml, AllMistakesAreToldTogether) {
  EXPECT_THAT(reading_yaml("a: 1\na: 2\nb:\nc: [[1]]\nd: !x 1\n"),
              testing::AllOf(HasSubstr("There are 4 mistakes"), HasSubstr("1. case.yaml, line 2"),
                             HasSubstr("2. case.yaml, line 3"), HasSubstr("3. case.yaml, line 4"),
                             HasSubstr("4. case.yaml, line 5")));
  EXPECT_THAT(validating_yaml("Scheme: x\nFluid:\n  Density: y\n  Stps: 1\n"),
              HasSubstr("There are 3 mistakes"));
}

TEST(StrictYaml, ListsAreNotNestedTooDeep) {
  std::string text;
  for (int i = 0; i < 200; ++i)
    text += std::string(i, ' ') + "a:\n";
  EXPECT_THAT(reading_yaml(text + std::string(200, ' ') + "b: 1\n"),
              HasSubstr("nested more than 100"));
  EXPECT_NE(reading_yaml(std::string(100000, '[')), "");
  EXPECT_NE(reading_yaml(std::string(100000, '{')), "");
}

TEST(StrictYaml, FormulasAreStringsInBrackets) {
  Document document = read_yaml_string(
      "Fluid:\n  Density: \"[2*R]\"\n  Gravity: [0, \"[min(R, 1)]\"]\n"
      "  Steps: \"[n]\"\n  Viscosity: \"[R], [R]\"\n  Fixed step: [\"[R]\"]\n",
      "case.yaml");
  assign_types(document.list, scene_schema(), document.source, FormulaPolicy::kept);
  ParameterList& fluid = document.list.sublist("Fluid");
  EXPECT_EQ(Teuchos::getValue<Formula>(fluid.getEntry("Density")),
            (Formula{ValueType::real, "[2*R]"}));
  EXPECT_EQ(Teuchos::getValue<Formula>(fluid.getEntry("Gravity")),
            (Formula{ValueType::reals, "{0, [min(R, 1)]}"}));
  EXPECT_EQ(Teuchos::getValue<Formula>(fluid.getEntry("Steps")),
            (Formula{ValueType::integer, "[n]"}));
  EXPECT_TRUE(fluid.getEntry("Fixed step").isType<Mistake>());
}

TEST(StrictYaml, StringsMayLookLikeAnything) {
  ParameterList valid;
  declare(valid, "Title", "", "A title.");
  declare(valid, "Files", {std::string("a")}, "Files.");
  const auto title = [&](const std::string& text) {
    Document document = read_yaml_string("Title: " + text, "case.yaml");
    validate(document, valid);
    return document.list.get<std::string>("Title");
  };
  EXPECT_EQ(title("2024"), "2024");
  EXPECT_EQ(title("\"2024\""), "2024");
  EXPECT_EQ(title("yes"), "yes");
  EXPECT_EQ(title("true"), "true");
  EXPECT_EQ(title("\"\""), "");
  EXPECT_EQ(title("|\n  one\n  two\n"), "one\ntwo\n");
  EXPECT_EQ(title("a[1] {b}"), "a[1] {b}");
  Document document = read_yaml_string("Files: [\"a, b\"]", "case.yaml");
  EXPECT_THAT(input_error([&] { validate(document, valid); }), HasSubstr("hold no comma"));
}

TEST(StrictYaml, WithoutATypeAnyOfThemSaysWhatIsMeant) {
  Document document = read_yaml_string(
      "Solids:\n  B: {Radius: 1, Size: [1, 2]}\nWeights: {Type: closest}\n", "case.yaml");
  assign_types(document.list, scene_schema(), document.source, FormulaPolicy::kept);
  const ParameterList& solid = document.list.sublist("Solids").sublist("B");
  EXPECT_EQ(solid.get<double>("Radius"), 1.);
  EXPECT_EQ(solid.get<ParameterArray<double>>("Size")[1], 2.);
  EXPECT_FALSE(has_untyped(document.list));
}

}  // namespace
}  // namespace lockstep::test
