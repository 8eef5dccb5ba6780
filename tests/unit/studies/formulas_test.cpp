#include <gmock/gmock.h>

#include <map>

#include "base/errors.hpp"
#include "parameters/expression.hpp"
#include "studies/run_results.hpp"
#include "studies/study_cases.hpp"

namespace lockstep::test {

TEST(Formulas, NamesMayHoldDotsAndBodiesAreSafe) {
  EXPECT_EQ(variable_name("Ball 1"), "Ball_1");
  EXPECT_EQ(variable_name("2nd"), "_2nd");
  const Variables variables{{"Ball_1.vx", 3}, {"n", 32}, {"r", 1e-6}};
  EXPECT_EQ(evaluate("2.5*Ball_1.vx + (n > 16 ? 1 : 0)", variables, "test"), 8.5);
  EXPECT_NEAR(evaluate("sin(_pi/2) * r", variables, "test"), 1e-6, 1e-20);
}

TEST(Formulas, BracketsBecomeNumbers) {
  const Variables variables{{"n", 32}, {"r", 1e-6}};
  EXPECT_EQ(substitute("Domain/Cells={[n], [2*n]}", variables, "test"), "Domain/Cells={32, 64}");
  EXPECT_EQ(substitute("Solids/Ball/Density=[1000*r]", variables, "test"),
            "Solids/Ball/Density=0.001");
  EXPECT_THROW(substitute("Fluid/Density=[n", variables, "test"), InputError);
}

TEST(Formulas, BracketsWithWhatIsFreeKeepTheRest) {
  const Variables variables{{"U", -2}, {"t0", 1e-3}};
  const std::vector<std::string> free{"x", "t"};
  EXPECT_EQ(substitute("{[1e-3*U*x + exp(t0*t)], [2*U]}", variables, "test", free),
            "{[1e-3*(-2)*x + exp(0.001*t)], -4}");
  EXPECT_EQ(substitute("[x]", {{"x", 3}}, "test", free), "3");
  EXPECT_EQ(names_in("1e-3*U + .5e2 - f(x_1)"), (std::vector<std::string>{"U", "f", "x_1"}));
}

TEST(Formulas, ATableIsAPolygon) {
  const auto table = [](double t) {
    return evaluate("table(t, 1, 2, 3, 6, 4, 0)", {{"t", t}}, "test");
  };
  for (const auto& [t, value] : std::map<double, double>{{0, 2}, {1, 2}, {2, 4}, {3.5, 3}, {9, 0}})
    EXPECT_EQ(table(t), value) << t;
  EXPECT_THROW(evaluate("table(1, 2, 3)", {}, "test"), InputError);
  EXPECT_THROW(evaluate("table(1, 2, 3, 2, 4)", {}, "test"), InputError);
}

TEST(Formulas, MistakesAreNamed) {
  try {
    evaluate("Bal.vx", {{"Ball.vx", 1}}, "Quantity \"speed\"");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("Quantity \"speed\""));
    EXPECT_THAT(error.what(), testing::HasSubstr("Did you mean \"Ball.vx\"?"));
  }
  EXPECT_THROW(evaluate("", {}, "test"), InputError);
  EXPECT_THROW(evaluate("1/zero", {{"zero", 0}}, "test"), InputError);
  EXPECT_EQ(evaluate("max(1, 3)", {}, "test"), 3);
  try {
    evaluate("0,5", {}, "Constant \"size\"");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("Constant \"size\": \"0,5\" is 2 numbers"));
  }
}

TEST(Formulas, ColumnsThatHadAnotherNameAreExplained) {
  try {
    evaluate("abs(lever_impulse_z)/dt", {{"lumping_torque_error_z", 1}, {"dt", 1}}, "test");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(
                                  "\"lever_impulse_z\" is called \"lumping_torque_error_z\" now."));
  }
  EXPECT_EQ(evaluate("gas_pockets", {{"gas_pockets", 2}}, "test"), 2);
}

TEST(Formulas, NumbersOfTheSceneByPath) {
  ParameterList scene;
  scene.sublist("Fluid").set("Density", 998.0);
  scene.sublist("Fluid").set("Gravity", make_array<double>({0, -9.8}));
  EXPECT_EQ(scene_number(scene, "Fluid/Density"), 998);
  EXPECT_EQ(scene_number(scene, "Fluid/Gravity[1]"), -9.8);
  EXPECT_THROW(scene_number(scene, "Fluid/Gravity[2]"), InputError);
  EXPECT_THROW(scene_number(scene, "Solids/Ball/Density"), InputError);
}

TEST(Formulas, OffsetsCoverTheCell) {
  int per_quarter[4] = {0, 0, 0, 0};
  for (int k = 0; k < 16; ++k) {
    const double x = sample_offset(k, 0), y = sample_offset(k, 1);
    EXPECT_GE(x, -0.5);
    EXPECT_LT(x, 0.5);
    ++per_quarter[(x < 0 ? 0 : 1) + (y < 0 ? 0 : 2)];
  }
  EXPECT_EQ(sample_offset(0, 0), 0);
  for (const int n : per_quarter) {
    EXPECT_GE(n, 2);
    EXPECT_LE(n, 6);
  }
}

}  // namespace lockstep::test
