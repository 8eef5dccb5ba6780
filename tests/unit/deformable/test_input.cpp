// What a scene may get wrong.
#include "support.hpp"

namespace lockstep {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::HasSubstr;

template <int dim>
std::string error_of(const std::string& content) {
  return error([&] { body<dim>(content, "Flag"); });
}
const std::string rest = number("Density", "1") + material("corotated");

TEST(Input, Geometry) {
  EXPECT_THAT(error_of<2>(geometry("box", "") + rest),
              AllOf(HasSubstr("Flag/Geometry"), HasSubstr("needs \"Size\"")));
  EXPECT_THAT(error_of<2>(geometry("ball", number("Radius", "1") + numbers("Size", "1, 1")) + rest),
              HasSubstr("has no \"Size\""));
  EXPECT_THAT(error_of<2>(geometry("torus", number("Radius", "1")) + rest), HasSubstr("torus"));
  EXPECT_THAT(
      error_of<3>(geometry("torus", number("Radius", "1") + number("Tube Radius", "2")) + rest),
      HasSubstr("meets itself"));
  EXPECT_THAT(error_of<3>(geometry("file", text("File", "nowhere.msh")) + rest),
              HasSubstr("nowhere.msh"));
}

TEST(Input, RequiredAndBounded) {
  const std::string disc = geometry("ball", number("Radius", "0.3"));
  EXPECT_THAT(error_of<2>(disc + material("corotated")), HasSubstr("Density"));
  EXPECT_THAT(error_of<2>(disc + number("Density", "1")), HasSubstr("Young's Modulus"));
  EXPECT_THAT(error_of<2>(disc + number("Density", "1") + material("rubber")), HasSubstr("rubber"));
  EXPECT_THAT(error_of<2>(disc + number("Density", "1") + material("linear", "1", "0.5")),
              HasSubstr("Poisson"));
  EXPECT_THAT(error_of<2>(disc + rest + text("Time Integration", "implicit")),
              HasSubstr("fully-implicit"));
  EXPECT_EQ(error_of<2>(disc + rest), "");
}

TEST(Input, RegionsHoldNodes) {
  const std::string square = box("1, 1", "0.5") + rest;
  EXPECT_THAT(error_of<2>(square + pinned("2, 2", "3, 3", "x")),
              AllOf(HasSubstr("Flag/Pinned/some"), HasSubstr("holds no node")));
  EXPECT_THAT(error_of<2>(square + pinned("1, 0", "0, 0", "x")), HasSubstr("lies above"));
  const auto made =
      body<2>(square + pinned("-0.5, -0.5", "-0.5, 0.5", "y") + numbers("Position", "7, 7"));
  int n_locked = 0;
  for (const auto& locked : made.locked) {
    EXPECT_FALSE(locked[0]);
    n_locked += locked[1];
  }
  EXPECT_EQ(n_locked, 3);
}

}  // namespace
}  // namespace lockstep
