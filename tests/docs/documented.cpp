// Every parameter, list and type that a scene may name has a docstring.
#include <gmock/gmock.h>

#include "parameters/reference.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "stepping/scene.hpp"

namespace lockstep {
namespace {

template <int dim>
std::vector<std::string> undocumented_in_scenes() {
  return undocumented(scene_parameters<dim>(shipped_plug_ins().of<dim>()));
}

TEST(Documentation, NoParameterWithoutDocstring) {
  EXPECT_THAT(undocumented_in_scenes<2>(), testing::IsEmpty());
  EXPECT_THAT(undocumented_in_scenes<3>(), testing::IsEmpty());
}

TEST(Documentation, NoPlugInWithoutDocstring) {
  const Registries<3> registries = shipped_plug_ins().space;
  const auto check = [](const auto& registry) {
    for (const auto& plugin : registry) {
      EXPECT_FALSE(plugin.documentation.empty()) << registry.kind() << " " << plugin.name;
    }
  };
  check(registries.fluids);
  check(registries.solids);
  check(registries.couplings);
  check(registries.contacts);
  check(registries.strategies);
}

}  // namespace
}  // namespace lockstep
