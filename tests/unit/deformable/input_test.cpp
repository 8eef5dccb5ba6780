// Errors that a scene may contain.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "deformable/materials/material.hpp"
#include "support.hpp"

namespace lockstep::test {
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

template <int dim>
DeformableBody<dim> cloth(const std::string& content) {
  const ParameterList given = scene_list(content, cloth_parameters<dim>());
  return read_cloth<dim>("Flag", given, 0.1);
}
const std::string sheet = number("Young&apos;s Modulus", "1e4") + number("Thickness", "1e-3") +
                          number("Surface Density", "0.5");

TEST(Input, Cloth) {
  const auto message = [](const std::string& content) { return error([&] { cloth<3>(content); }); };
  EXPECT_THAT(message(geometry("sheet", numbers("Size", "1, 0, 1")) + sheet),
              HasSubstr("needs \"Normal\""));
  EXPECT_THAT(message(geometry("ball", number("Radius", "1") + text("Normal", "x")) + sheet),
              HasSubstr("has no \"Normal\""));
  EXPECT_THAT(message(geometry("ball", number("Radius", "1")) + number("Thickness", "1e-3")),
              HasSubstr("required"));
  EXPECT_THAT(message(geometry("ball", number("Radius", "1")) + sheet +
                      list("Membrane", text("Type", "springs"))),
              HasSubstr("mass-spring"));
  const auto made =
      cloth<3>(geometry("sheet", numbers("Size", "1, 0, 2") + text("Normal", "y")) + sheet +
               list("Membrane", text("Type", "mass-spring")) + number("Surface Tension", "2"));
  EXPECT_EQ(made.elements.size(), 3u);  // springs, bending, tension
  double mass = 0;
  for (const double area : made.element_measure)
    mass += made.density * area;
  EXPECT_NEAR(mass, 1, 1e-12);
  EXPECT_FALSE(made.closed);
}

TEST(Input, MassOfClothByItsThickness) {
  const std::string flag = geometry("sheet", numbers("Size", "1, 0, 2") + text("Normal", "y")) +
                           number("Young&apos;s Modulus", "1e4") + number("Thickness", "2e-3");
  const std::string surface = number("Surface Density", "1"), density = number("Density", "250");
  EXPECT_NEAR(cloth<3>(flag + density).density, 0.5, 1e-15);
  EXPECT_THAT(error([&] { cloth<3>(flag + density + surface); }),
              HasSubstr("\"Flag\" has both \"Surface Density\" and \"Density\""));
  EXPECT_THAT(error([&] { cloth<3>(flag); }), HasSubstr("\"Flag\" has no mass"));
  EXPECT_THAT(error([&] { cloth<3>(flag + number("Density", "0")); }), HasSubstr("greater than 0"));
}

TEST(Input, SubStepsAreOfExplicitForces) {
  const std::string sub_steps = R"(<Parameter name="Most Sub-Steps" type="int" value="4"/>)";
  const std::string ball = geometry("ball", number("Radius", "1"));
  EXPECT_THAT(error([&] { cloth<3>(ball + sheet + sub_steps); }),
              AllOf(HasSubstr("\"Flag\""), HasSubstr("semi-implicit or explicit")));
  EXPECT_EQ(error([&] {
              cloth<3>(ball + sheet + sub_steps + text("Time Integration", "semi-implicit"));
            }),
            "");
}

/// Elements between the faces of a box across its last axis.
template <int dim>
std::size_t elements_across(const DeformableBody<dim>& made) {
  std::set<long> places;
  for (const Point<dim>& x : made.position)
    places.insert(std::lround(1e6 * x[dim - 1]));
  return places.size() - 1;
}

// The grid's spacing is 0.1 here: linear elements of that size would lock in bending.
TEST(Input, WhatIsThinHasElementsEnoughToBend) {
  const std::string rest = number("Density", "1") + material("linear");
  const auto plate = [&](const std::string& size, const std::string& more) {
    return geometry("box", numbers("Size", size) + more) + rest;
  };
  EXPECT_EQ(elements_across(body<2>(plate("1, 0.1", ""))), 8U);
  EXPECT_EQ(elements_across(body<3>(plate("0.4, 0.4, 0.1", ""))), 4U);
  EXPECT_EQ(elements_across(body<2>(plate("1, 0.1", number("Mesh Spacing", "0.1")))), 1U);
  EXPECT_EQ(elements_across(body<2>(plate("2, 1.2", ""))), 12U);
}

// Linear elasticity takes a rotation for strain: it counts from how the body lies at the start.
TEST(Input, ALinearBodyIsAtRestHoweverItIsTurned) {
  const auto energy = [](const DeformableBody<3>& made) {
    std::vector<Point<3>> force(made.n_nodes(), Point<3>::Zero());
    return made.elements.front()->add_elastic_forces(made.position, made.n_nodes(), force);
  };
  const std::string block = box("1, 0.5, 0.5", "0.5") + number("Density", "1") +
                            material("linear") + numbers("Rotation", "0.3, -1, 0.5");
  EXPECT_LT(energy(body<3>(block)), 1e-25);
  // Stretched along its own axis by a tenth: (lambda + 2 mu) / 2 times 0.01 a volume.
  const LameConstants lame = lame_constants(100, 0.3);
  EXPECT_NEAR(energy(body<3>(block + numbers("Stretch", "1.1, 1, 1"))),
              0.25 * 0.005 * (lame.lambda + 2 * lame.mu), 1e-12);
}

TEST(Input, ClothOfAFileIsScaledWeldedAndOriented) {
  const std::string file =
      ::testing::TempDir() + "cloth" + std::to_string(world()->getRank()) + ".obj";
  std::ofstream(file) << "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1e-7 0 0\nv 2 2 1e-7\nv 0 2 0\n"
                         "f 1 2 3\nf 4 6 5\n";
  const auto made = cloth<3>(
      geometry("file", text("File", file) + number("Scale", "0.5") + number("Weld", "1e-6") +
                           "<Parameter name=\"Orient\" type=\"bool\" value=\"true\"/>") +
      sheet);
  std::filesystem::remove(file);
  EXPECT_EQ(made.n_nodes(), 4);
  EXPECT_NEAR(made.element_measure[0] + made.element_measure[1], 1, 1e-6);
  EXPECT_EQ(made.surface[1], (std::array<int, 3>{3, 0, 2}));
}

// H3: a reported condition, no division by zero.
TEST(Input, MasslessCloth) {
  const std::string massless = geometry("sheet", numbers("Size", "1, 0, 1") + text("Normal", "y") +
                                                     number("Mesh Spacing", "0.25")) +
                               number("Young&apos;s Modulus", "1e4") + number("Thickness", "1e-3") +
                               number("Surface Density", "0") + text("Bending", "none");
  const std::string refused =
      error([&] { cloth<3>(massless + text("Time Integration", "semi-implicit")); });
  EXPECT_THAT(refused, HasSubstr("fully-implicit"));
  // Impulses along edges have nothing to act on.
  const std::string limited = error([&] { cloth<3>(massless + number("Stretch Limit", "0.1")); });
  EXPECT_THAT(limited, AllOf(HasSubstr("Flag"), HasSubstr("\"Stretch Limit\"")));
  std::vector<DeformableBody<3>> bodies;
  bodies.push_back(cloth<3>(massless + numbers("Velocity", "1, 2, 3")));
  Alone<3> alone(std::make_unique<DeformableSolids<3>>("cloth", std::move(bodies),
                                                       Point<3>(0, -10, 0), world()));
  const SolidState<3> state = alone.solids.states()[0];
  EXPECT_EQ(state.mass, 0);
  EXPECT_LT((state.velocity - Point<3>(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT(state.center_of_mass.norm(), 1e-14);
  // Nothing holds a flat sheet across its plane: no fluid sees it here.
  std::string reported;
  try {
    alone.step(0.1);
  } catch (const SolveError& failure) {
    reported = failure.what();
  }
  EXPECT_THAT(reported, AllOf(HasSubstr("node without mass that no mixed face sees"),
                              HasSubstr("or \"Contact/Type\" is \"none\"")));
}

}  // namespace
}  // namespace lockstep::test
