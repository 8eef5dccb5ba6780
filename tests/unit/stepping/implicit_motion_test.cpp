// Soft solids are judged one by one, each in its own frame.
#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>

#include "deformable/deformable_solids.hpp"
#include "deformable/reading/deformable_parameters.hpp"
#include "stepping/step/implicit_motion.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {
namespace {

/// A stiff block of so much that it turns by 0.4 in a step of `long_step`.
constexpr double long_step = 0.02;
std::string block(const std::string& position, const std::string& velocity,
                  const std::string& spin) {
  return geometry("box", numbers("Size", "0.3, 0.2") + number("Mesh Spacing", "0.06")) +
         list("Material", text("Type", "neo-hookean") + number("Young&apos;s Modulus", "1e7") +
                              number("Poisson&apos;s Ratio", "0.3")) +
         number("Density", "1000") + text("Time Integration", "fully-implicit") +
         numbers("Position", position) + numbers("Velocity", velocity) +
         number("Angular Velocity", spin);
}

std::unique_ptr<SolidSystem<2>> system_of(const std::vector<std::string>& contents) {
  std::vector<DeformableBody<2>> bodies;
  for (const auto& content : contents)
    bodies.push_back(read_deformable_body<2>(
        std::to_string(bodies.size()), scene_list(content, deformable_body_parameters<2>()), 0.1));
  std::vector<std::unique_ptr<SolidModel<2>>> models;
  models.push_back(std::make_unique<DeformableSolids<2>>("deformable body", std::move(bodies),
                                                         Point<2>::Zero(), world()));
  auto system = std::make_unique<SolidSystem<2>>(std::move(models), world());
  system->begin_step(0, 0);  // outside of steps nothing turns along
  return system;
}

RCP<Vector> predicted(const SolidSystem<2>& system, double dt) {
  return system.velocity_of(*system.explicit_momentum(0, dt), dt, system.reduction());
}

bool settles_at_once(const std::vector<std::string>& contents, double dt) {
  const auto system = system_of(contents);
  return is_settled(*system, dt, *predicted(*system, dt));
}

}  // namespace

TEST(ImplicitMotion, WhetherABodyIsSettledIsItsOwnAffair) {
  const std::string turns = block("-0.5, 0", "0, 0", "20");
  const std::string far_and_fast = block("5, 0", "0, 3000", "0");
  const std::string turns_and_flies = block("-0.5, 0", "0, 3000", "20");
  EXPECT_FALSE(settles_at_once({turns}, long_step));
  EXPECT_FALSE(settles_at_once({turns, far_and_fast}, long_step));
  EXPECT_FALSE(settles_at_once({turns_and_flies}, long_step));
  const double short_step = 1e-5;
  EXPECT_TRUE(settles_at_once({turns}, short_step));
  EXPECT_TRUE(settles_at_once({turns, far_and_fast}, short_step));
  EXPECT_TRUE(settles_at_once({far_and_fast}, long_step));
}

TEST(ImplicitMotion, SettlesTheSameInAnotherFrame) {
  const auto settled = [](const std::string& velocity) {
    const auto system = system_of({block("-0.5, 0", velocity, "20")});
    const RCP<Vector> start = predicted(*system, long_step);
    const RCP<Vector> momentum = system->explicit_momentum(0, long_step);
    StepContext<2> context;
    context.dt = context.step.dt = long_step;
    context.constraints = system->reduction();
    const auto motion = settle_motion<2>(*system, nullptr, context, {*start, *start}, *momentum);
    EXPECT_GT(system->linearisation_number(), 0u);
    EXPECT_TRUE(motion.is_settled);
    std::vector<double> own;
    const auto values = motion.velocity->getData();
    for (int row = 0; row < values.size(); ++row) {
      if (system->map()->getGlobalElement(row) < system->n_unknowns())
        own.push_back(values[row]);
    }
    return own;
  };
  const std::vector<double> rest = settled("0, 0"), moves = settled("3, 4");
  for (std::size_t row = 0; row < rest.size(); ++row)
    EXPECT_NEAR(moves[row], rest[row] + (row % 2 == 0 ? 3 : 4), 1e-4) << row;
}

}  // namespace lockstep::test
