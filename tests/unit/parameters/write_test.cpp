#include "parameters/write.hpp"

#include <limits>

#include "parameters/validate.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

TEST(Write, ReadsBackTheSameValues) {
  ParameterList list("scene");
  list.set("third", 1.0 / 3.0);
  list.set("least", std::numeric_limits<double>::denorm_min());
  list.set("largest", std::numeric_limits<double>::max());
  list.set("whole", 2.0);
  list.set("count", -3);
  list.set("yes", true);
  list.set("text", std::string("a <\"&'> b\n\tc "), "Says \"so\".");
  ParameterList& sub = list.sublist("Sub & list");
  sub.set("reals", make_array<double>({0.1, 1e-300}));
  sub.set("none", ParameterArray<int>{});
  sub.set("words", make_array<std::string>({"one", "two words"}));
  const Document back = read_xml_string(to_xml(list), "written.xml");

  EXPECT_TRUE(Teuchos::haveSameValues(list, back.list, true));
  EXPECT_EQ(back.list.getEntry("text").docString(), "Says \"so\".");
}

TEST(Write, UsedParametersValidateAgainToThemselves) {
  Document document =
      read_xml_string(file_with(R"(name="Density" type="double" value="998")"), "case.xml");
  validate(document, scene_schema());

  Document again = read_xml_string(to_xml(document.list), "used-parameters.xml");
  validate(again, scene_schema());

  EXPECT_TRUE(Teuchos::haveSameValues(document.list, again.list));
  EXPECT_EQ(again.list.sublist("Fluid").get<double>("Density"), 998);
}

TEST(Write, RefusesWhatItCouldNotReadBack) {
  ParameterList comma, infinite;
  comma.set("words", make_array<std::string>({"a,b"}));
  infinite.set("x", std::numeric_limits<double>::infinity());

  EXPECT_THROW(to_xml(comma), OutputError);
  EXPECT_THROW(to_xml(infinite), OutputError);
}

TEST(Write, DifferencesNameWhatTheUserChose) {
  Document document = read_xml_string(R"(<ParameterList>
<ParameterList name="Fluid">
<Parameter name="Density" type="double" value="998"/>
<Parameter name="Steps" type="int" value="10"/>
<Parameter name="Fixed step" type="double" value="0.5"/></ParameterList>
<ParameterList name="Solids"><ParameterList name="B"><Parameter name="Type" type="string" value="ball"/>
<Parameter name="Radius" type="double" value="2"/></ParameterList></ParameterList>
<ParameterList name="Solver"><Parameter name="Tolerance" type="double" value="1e-8"/></ParameterList>
</ParameterList>)",
                                      "case.xml");
  validate(document, scene_schema());

  EXPECT_THAT(differences_from_default(document.list, scene_schema()),
              ::testing::ElementsAre("Fluid/Density = 998 (default 1000)", "Fluid/Fixed step = 0.5",
                                     "Solids/B/Type = \"ball\"", "Solids/B/Radius = 2",
                                     "Solver/Tolerance = 1e-8"));
}

}  // namespace
}  // namespace lockstep::test
