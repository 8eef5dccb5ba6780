// The step F1 S1 F2 F3 S2 F4, call by call.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "recording.hpp"
#include "stepping/step/time_scheme.hpp"
#include "support/coupled_case.hpp"

namespace lockstep::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

FakeBox<2> tank(double viscosity = 0) {
  FakeBox<2> box;
  box.n_cells = {6, 4};
  box.gravity = {0, -1};
  box.viscosity = viscosity;
  box.open_axis = 1;
  return box;
}

FakeBody<2> plate() {
  FakeBody<2> body;
  body.closed = false;
  body.surface = polyline({{2, 1}, {2, 3}}, false);
  body.center = {2, 2};
  body.angular_velocity[0] = 0.1;
  return body;
}

struct Recorded {
  explicit Recorded(const FakeBox<2>& box, std::vector<FakeBody<2>> bodies = {plate()},
                    bool with_contact = true, bool with_joints = false, int order = 1) {
    const Communicator comm = Tpetra::getDefaultComm();
    components.fluid = std::make_unique<RecordingFluid>(box, comm, calls);
    Models<2> models;
    if (!bodies.empty())
      models.push_back(std::make_unique<RecordingSolid>(std::move(bodies), comm, calls));
    components.solids = std::make_unique<SolidSystem<2>>(
        std::move(models), comm, with_joints ? std::make_unique<RecordingJoints>(calls) : nullptr);
    components.coupling = std::make_unique<MixedFaceCoupling<2>>(MixedFaceOptions());
    components.strategy = std::make_unique<RecordingStrategy>(calls);
    if (with_contact)
      components.contact = std::make_unique<RecordingContact>(calls);
    StepOptions options;
    options.order = order;
    scheme = std::make_unique<TimeScheme<2>>(components, options, 3, timers);
  }
  /// The calls of a step of .5 s.
  Calls step() {
    calls.clear();
    scheme->advance(0.5);
    return calls;
  }

  Calls calls;
  StageTimers timers;
  Components<2> components;
  std::unique_ptr<TimeScheme<2>> scheme;
};

long count(const Calls& calls, const std::string& call) {
  return std::count(calls.begin(), calls.end(), call);
}

}  // namespace

TEST(StepOrder, IsThatOfSection7) {
  Recorded recorded(tank());
  for (int i = 0; i < 2; ++i) {
    const std::string begin = fmt::format("solids: step from {} over 0.5", 3 + 0.5 * i);
    const std::string contact = fmt::format("contact: step from {}", 3 + 0.5 * i);
    EXPECT_THAT(
        recorded.step(),
        ElementsAre(begin, contact, "fluid: u* = u", "fluid: forces over 0.25",  // F1
                    "solids: forces over 0.25", "solids: midpoint of 0.25",
                    "contact: positions over 0.5", "solve: S1", "contact: positions over 0.5",
                    "solids: limit over 0.5", "solids: move over 0.5",              // S1
                    "fluid: u* to advect over 0.5", "solve: F2", "fluid: project",  // F2
                    "fluid: advect over 0.5", "fluid: geometry", "fluid: populate_uncovered",
                    "fluid: forces over 0.5",  // F3
                    "solids: forces over 0.5", "contact: velocities over 0.5", "solve: S2",
                    "contact: velocities over 0.5",                    // S2
                    "fluid: project", "fluid: u = u*", "solids: V"));  // F4
  }
  EXPECT_EQ(recorded.scheme->time(), 4);
}

/// Two kicks over half of the step, each with a solve that is kept, and a drift between them.
TEST(StepOrder, OfKickDriftKick) {
  Recorded recorded(tank(), {plate()}, true, false, 2);
  for (int i = 0; i < 2; ++i) {
    const std::string begin = fmt::format("solids: step from {} over 0.5", 3 + 0.5 * i);
    const std::string contact = fmt::format("contact: step from {}", 3 + 0.5 * i);
    EXPECT_THAT(
        recorded.step(),
        ElementsAre(
            begin, contact, "fluid: u* to advect over 0.5", "fluid: forces over 0.25",  // kick
            "solids: forces over 0.25", "contact: velocities over 0.5", "solve: S1",
            "contact: velocities over 0.5", "fluid: project", "fluid: u = u*", "solids: V",
            "solids: midpoint of 0.25",  // drift
            "contact: positions over 0.5", "solids: move over 0.5", "fluid: u* = u", "solve: F2",
            "fluid: project", "fluid: advect over 0.5", "fluid: geometry",
            "fluid: populate_uncovered", "fluid: forces over 0.25",  // kick
            "solids: forces over 0.25", "contact: velocities over 0.5", "solve: S2",
            "contact: velocities over 0.5", "fluid: project", "fluid: u = u*", "solids: V"));
  }
  EXPECT_EQ(recorded.scheme->time(), 4);
}

TEST(StepOrder, ContactThatHoldsNothingIsTold) {
  Recorded recorded(tank());
  recorded.components.contact = std::make_unique<SilentContact>();
  EXPECT_THAT(
      [&] { recorded.step(); },
      ThrowsMessage<SolveError>(HasSubstr("\"silent\" pushes at 1 contacts and returns no rows")));
}

TEST(StepOrder, FluidAloneTakesOneSolve) {
  Recorded recorded(tank(), {});
  EXPECT_EQ(count(recorded.step(), "solve: F2"), 1);  // u^0 may have a divergence
  EXPECT_THAT(recorded.step(), ElementsAre("contact: step from 3.5", "fluid: u* to advect over 0.5",
                                           "fluid: advect over 0.5", "fluid: populate_uncovered",
                                           "fluid: forces over 0.5", "solve: S2", "fluid: project",
                                           "fluid: u = u*"));
}

TEST(StepOrder, PrescribedSolidsNeedNoFirstSolve) {
  FakeBody<2> moved = plate();
  moved.kind = FakeBody<2>::Kind::prescribed;
  Recorded recorded(tank(), {moved}, false);
  const Calls calls = recorded.step();
  EXPECT_EQ(count(calls, "solve: S1"), 0);
  EXPECT_EQ(count(calls, "solids: move over 0.5"), 1);
  EXPECT_EQ(count(calls, "solve: F2"), 1);
  EXPECT_EQ(count(calls, "solve: S2"), 1);
}

/// Positions follow a script by its mean velocity, velocities have that of the end.
TEST(StepOrder, HeldDofsMoveAsTheirPhaseWants) {
  FakeBody<2> held = plate();
  held.locked = {0};
  Recorded recorded(tank(), {held}, false);
  const Calls calls = recorded.step();
  const auto place = [&calls](const std::string& call) {
    return std::find(calls.begin(), calls.end(), call);
  };
  EXPECT_LT(place("solids: held from 3 to 3.5"), place("solve: S1"));
  EXPECT_LT(place("solids: move over 0.5"), place("solids: held from 3.5 to 3.5"));
  EXPECT_LT(place("solids: held from 3.5 to 3.5"), place("solve: S2"));
  EXPECT_NE(place("solve: S2"), calls.end());
}

/// The correction of S1 belongs to positions: also where the pressure is not known yet, because
/// that of the first step holds what made a flow of the start, no velocity gets it.
TEST(StepOrder, OnlyPositionsAreCorrectedForTheMidpoint) {
  Recorded recorded(tank(0.1), {plate()}, false);
  for (const bool is_known : {false, false, true}) {
    const Calls calls = recorded.step();
    EXPECT_EQ(count(calls, "fluid: viscosity"), 2);  // F1, F3
    EXPECT_EQ(count(calls, "solve: first pressure"), is_known ? 0 : 2);
    const auto advected = std::find(calls.begin(), calls.end(), "fluid: advect over 0.5");
    EXPECT_EQ(count({calls.begin(), advected}, "solids: midpoint of 0.25"), is_known ? 1 : 2);
    for (auto call = advected; call != calls.end(); ++call)
      EXPECT_THAT(*call, ::testing::Not(::testing::HasSubstr("midpoint")));
  }
}

/// Contact decides for the viscous solve, before the coupled one and after it.
TEST(StepOrder, ContactDecidesForEachSolve) {
  Recorded recorded(tank(0.1));
  const Calls calls = recorded.step();
  EXPECT_EQ(count(calls, "contact: positions over 0.5"), 3);
  EXPECT_EQ(count(calls, "contact: velocities over 0.5"), 3);
}

TEST(StepOrder, ItCanBeLeftBetweenStages) {
  struct Left {};
  Recorded recorded(tank());
  const auto leave_before_advection = [&recorded] {
    if (!recorded.calls.empty() && recorded.calls.back() == "fluid: project")
      throw Left();
  };
  EXPECT_THROW(recorded.scheme->advance(0.5, leave_before_advection), Left);
  EXPECT_EQ(recorded.calls.back(), "fluid: project");  // F2
  EXPECT_EQ(recorded.scheme->time(), 3);
}

TEST(StepOrder, ScenesNameAllTheirPlugIns) {
  Recorded recorded(tank(), {plate()}, true, true);
  std::vector<std::string> names;
  for_each_plug_in(recorded.components,
                   [&](const PlugIn& plug_in) { names.push_back(plug_in.name()); });
  EXPECT_EQ(std::count(names.begin(), names.end(), "recording"), 3);  // joints, strategy, contact
}

}  // namespace lockstep::test
