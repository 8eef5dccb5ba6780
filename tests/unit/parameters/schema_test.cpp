#include <nlohmann/json.hpp>

#include "parameters/schema/json_schema.hpp"
#include "parameters/schema/relax_ng.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

ParameterList dimensioned(int dimension) {
  ParameterList valid = scene_schema();
  declare_between(valid, "Dimension", dimension, 2, 3, "2 or 3.");
  return valid;
}

/// The definition that a property of this list refers to.
const Json& property(const Json& schema, const Json& list, const std::string& name) {
  const std::string path = list["properties"][name]["$ref"];
  return schema.at(Json::json_pointer(path.substr(1)));
}

TEST(JsonSchema, HasTypesBoundsChoicesAndDocumentation) {
  const Json schema = Json::parse(json_schema(dimensioned(2), dimensioned(3)));
  const std::string plane = schema["then"]["$ref"];
  const Json& scene = schema.at(Json::json_pointer(plane.substr(1)));
  EXPECT_EQ(scene["additionalProperties"], false);
  const Json& fluid = property(schema, scene, "Fluid");
  const Json& density = property(schema, fluid, "Density");
  EXPECT_EQ(density["description"], "Mass density [kg/m^3].");
  EXPECT_EQ(density["default"], 1000.);
  EXPECT_EQ(density["anyOf"][0], Json({{"type", "number"}, {"exclusiveMinimum", 0.}}));
  EXPECT_EQ(density["anyOf"][1]["type"], "string");
  const Json& gravity = property(schema, fluid, "Gravity");
  EXPECT_EQ(gravity["minItems"], 2);
  EXPECT_EQ(gravity["type"], "array");
  EXPECT_EQ(property(schema, fluid, "Steps")["anyOf"][0]["type"], "integer");
  EXPECT_EQ(property(schema, scene, "Scheme")["enum"], Json({"maccormack", "semi-lagrangian"}));
  EXPECT_EQ(property(schema, scene, "Solver"),
            Json({{"type", "object"}, {"description", "For Stratimikos."}}));
}

TEST(JsonSchema, TypesChooseWhatElseIsKnown) {
  const Json schema = Json::parse(json_schema(dimensioned(2), dimensioned(2)));
  EXPECT_EQ(schema["then"], schema["else"]["then"]) << "what is alike stands there once";
  const std::string plane = schema["then"]["$ref"];
  const Json& solids = property(schema, schema.at(Json::json_pointer(plane.substr(1))), "Solids");
  const std::string element_path = solids["additionalProperties"]["$ref"];
  const Json& element = schema.at(Json::json_pointer(element_path.substr(1)));
  EXPECT_EQ(element["properties"]["Type"]["enum"], Json({"ball", "box"}));
  ASSERT_EQ(element["allOf"].size(), 3u);
  EXPECT_EQ(element["allOf"][0]["if"]["properties"]["Type"]["const"], "ball");
  EXPECT_EQ(element["allOf"][0]["if"]["required"], Json::array({"Type"}));
  const Json& untyped = element["allOf"][2]["then"]["properties"];
  EXPECT_TRUE(untyped.contains("Radius"));
  EXPECT_TRUE(untyped.contains("Size"));
}

TEST(RelaxNg, HasTypesBoundsAndChoices) {
  const std::string schema = relax_ng(dimensioned(2), dimensioned(3));
  EXPECT_THAT(schema, HasSubstr("<a:documentation>Mass density [kg/m^3].</a:documentation>"));
  EXPECT_THAT(schema, HasSubstr("<param name=\"minExclusive\">0</param>"));
  EXPECT_THAT(schema, HasSubstr("<value type=\"string\">semi-lagrangian</value>"));
  EXPECT_THAT(schema, HasSubstr("<define name=\"scene.2\">"));
  EXPECT_THAT(schema, HasSubstr("<define name=\"Solids-of-any-type.1\">"));
}

}  // namespace
}  // namespace lockstep::test
