// The solids that come with Lockstep keep the promises of SolidModel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/solid_conformance.hpp"
#include "deformable/deformable_solids.hpp"
#include "deformable/reading/deformable_parameters.hpp"
#include "rigid/rigid_bodies.hpp"
#include "rigid/rigid_parameters.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {
namespace {

using ::testing::IsEmpty;

TEST(Conformance, RigidBodies) {
  const std::string ball = geometry("ball", number("Radius", "0.2"));
  const std::vector<std::string> contents{
      ball + number("Density", "2") + numbers("Velocity", "1, 0, 0"),
      geometry("box", numbers("Size", "0.3, 0.4, 0.5")) + number("Density", "3") +
          numbers("Position", "2, 0, 1") + numbers("Angular Velocity", "1, 2, 3"),
      ball + list("Motion", text("Type", "sinusoid") + numbers("Amplitude", "0, 1, 0") +
                                number("Frequency", "0.5"))};
  std::vector<std::pair<std::string, ParameterList>> lists;
  for (const auto& content : contents)
    lists.emplace_back(std::to_string(lists.size()),
                       scene_list(content, rigid_body_parameters<3>()));
  const auto model = make_rigid_bodies<3>(lists, 0.1, {0, -9.8, 0}, world());
  EXPECT_THAT(check_solid<3>(*model), IsEmpty());
}

template <int dim>
void expect_soft_bodies_to_keep_theirs(const std::string& size, const std::string& velocity,
                                       const std::string& integration) {
  const std::string content =
      geometry("box", numbers("Size", size) + number("Mesh Spacing", "0.2")) +
      list("Material", text("Type", "neo-hookean") + number("Young&apos;s Modulus", "100") +
                           number("Poisson&apos;s Ratio", "0.3")) +
      number("Density", "2") + numbers("Velocity", velocity) +
      text("Time Integration", integration);
  std::vector<DeformableBody<dim>> bodies;
  bodies.push_back(read_deformable_body<dim>(
      "body", scene_list(content, deformable_body_parameters<dim>()), 0.1));
  DeformableSolids<dim> model("deformable body", std::move(bodies), Point<dim>::Constant(-2),
                              world());
  EXPECT_THAT(check_solid<dim>(model), IsEmpty()) << integration;
}

TEST(Conformance, DeformableBodies) {
  for (const char* const integration : {"explicit", "semi-implicit", "fully-implicit"}) {
    expect_soft_bodies_to_keep_theirs<2>("0.6, 0.4", "1, 2", integration);
    expect_soft_bodies_to_keep_theirs<3>("0.6, 0.4, 0.4", "1, 2, 3", integration);
  }
}

}  // namespace
}  // namespace lockstep::test
