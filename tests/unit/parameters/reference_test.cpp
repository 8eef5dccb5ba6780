#include "parameters/reference.hpp"

#include "support.hpp"

namespace lockstep::test {
namespace {

TEST(Reference, TextShowsEverything) {
  EXPECT_EQ(reference_text(scene_schema()),
            R"(  Scheme : string = "maccormack"  [one of "maccormack", "semi-lagrangian"]
      Advection.

[Fluid]
The fluid.
  Density : double = 1000  [greater than 0]
      Mass density [kg/m^3].
  Viscosity : double = 0  [at least 0]
      Dynamic viscosity [Pa s].
  Gravity : Array(double) = {0, -9.81}  [2 components]
      Acceleration [m/s^2].
  Steps : int = 10  [at least 1]
      Number of steps.
  Fixed step : double = unset
      Step size [s].

[Solids]
The bodies.
Holds any number of lists with names of your choice. The "Type" of each decides its parameters:
  Type : string = required  [one of "ball", "box"]
      Type of this list, which decides its other parameters.

  [Solids (Type "ball")]
  A ball.
    Radius : double = required  [greater than 0]
        Radius [m].
    Locked : bool = false
        Does not move.

  [Solids (Type "box")]
  A box.
    Size : Array(double) = required  [2 components]
        Edge lengths [m].

[Weights]
Coupling weights.
Its "Type" decides its parameters:
  Type : string = "area"  [one of "area", "closest"]
      Type of this list, which decides its other parameters.

  [Weights (Type "area")]
  By area.

  [Weights (Type "closest")]
  By distance.

[Solver]
For Stratimikos.
Its content is checked by whoever reads it.
)");
}

TEST(Reference, JsonHasEveryListAndItsParameters) {
  ParameterList valid;
  declare_positive(declare_list(valid, "Time", "Time stepping."), "Step", 1e-3,
                   "A \"step\" \\ size [s].");

  EXPECT_EQ(reference_json(valid), R"([
 {
  "path": "",
  "documentation": "",
  "note": "",
  "parameters": []
 },
 {
  "path": "Time",
  "documentation": "Time stepping.",
  "note": "",
  "parameters": [
   {
    "name": "Step",
    "type": "double",
    "default": "0.001",
    "allowed": "greater than 0",
    "documentation": "A \"step\" \\ size [s]."
   }
  ]
 }
]
)");
}

TEST(Reference, FindsMissingDocstringsAtEveryDepth) {
  ParameterList valid = scene_schema();
  EXPECT_TRUE(undocumented(valid).empty());

  ParameterList element;
  declare(element, "Bare", 1, "");
  declare(declare_list(valid, "Undocumented list", " "), "Fine", 1, "Documented.");
  declare_named_sublists(valid, "Walls", "Walls.", {{"plain", "", element}});

  EXPECT_THAT(undocumented(valid),
              ::testing::ElementsAre("Undocumented list", "Walls (Type \"plain\")",
                                     "Walls (Type \"plain\")/Bare"));
}

}  // namespace
}  // namespace lockstep::test
