#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "mac/register_mac.hpp"
#include "mac_cases.hpp"
#include "output/frames.hpp"

namespace lockstep::test {
namespace {

template <int dim>
void make_divergence_free(MacFluid<dim>& fluid) {
  Vector rhs(fluid.pressure_map()), solution(fluid.pressure_map());
  fluid.divergence(rhs);
  if (!fluid.regions().has_dirichlet[0]) {
    Vector one(rhs.getMap());
    one.putScalar(1);
    rhs.update(-rhs.meanValue(), one, 1);
  }
  if (rhs.normInf() < 1e-14)
    return;
  const auto matrix = assembled(fluid.pressure_block());
  conjugate_gradients([&](const Vector& x, Vector& y) { matrix->apply(x, y); }, rhs, solution,
                      1e-12);
  fluid.project(solution);
}

template <int dim>
MovingSurface<dim> no_surface() {
  return {nullptr, nullptr,
          [](const SurfacePoint<dim>&) { return Point<dim>(Point<dim>::Zero()); }};
}

TEST(Fluid, BuoyancyByHand) {
  Case<2> scene({4, 4}, 0.5);
  scene.fluid.set("Density", 2.0).set("Thermal Expansion", 0.01);
  scene.fluid.set("Smoke Weight", 0.5);
  scene.fluid.set("Gravity", numbers({0.0, -10.0}));
  ParameterList& temperature = scene.fluid.sublist("Temperature").set("Ambient", 300.0);
  ParameterList& everywhere = temperature.sublist("Regions").sublist("all");
  everywhere.set("Shape", "box").set("Lower", numbers({-1.0, -1.0}));
  everywhere.set("Upper", numbers({9.0, 9.0})).set("Value", 310.0);
  scene.fluid.sublist("Smoke").set("Ambient", 0.4);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const Momentum<2> impulse = fluid->add_forces(0.0, 0.1).impulse;
  // 12 inner y faces of mass 0.5; acceleration -10 (1 - 0.01 * 10 + 0.5 * 0.4) = -11.
  EXPECT_NEAR(impulse.linear[1], 12 * 0.5 * 0.1 * -11, 1e-12);
  EXPECT_NEAR(impulse.linear[0], 0, 1e-15);
  // About the origin: the faces stand at mean x = 1.
  EXPECT_NEAR(impulse.angular[0], impulse.linear[1], 1e-12);
}

TEST(Fluid, SamplesOfALinearVelocityAreExactOnAnyRank) {
  Case<2> scene({20, 24}, 0.25);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const auto velocity = [](const Point<2>& x) { return Point<2>(1 + 2 * x[0] - x[1], 3 * x[1]); };
  fluid->set_prediction(velocity);
  std::vector<Point<2>> points{{1.234, 2.1}, {2.5, 4.75}, {4.4, 0.6}, {-1, 2}};
  const auto samples = fluid->output()->sample(points);
  for (int p = 0; p < 3; ++p) {
    EXPECT_TRUE(samples[p].in_fluid);
    EXPECT_NEAR((samples[p].velocity - velocity(points[p])).norm(), 0, 1e-13);
    EXPECT_EQ(samples[p].pressure, 0);  // none is known before the first step
  }
  EXPECT_FALSE(samples[3].in_fluid);
}

TEST(Fluid, InflowsCarryWhatIsAmbientUnlessTheySayElse) {
  Case<2> scene({4, 4}, 0.5);
  scene.side("x lower", "inflow", {1, 0}).side("x upper", "open");
  scene.fluid.sublist("Temperature").set("Ambient", 300.0);
  scene.fluid.sublist("Smoke").set("Ambient", 0.5);
  scene.domain.sublist("Sides").sublist("x lower").set("Smoke", 0.0);
  const auto fluid = scene.make();
  const BoundarySide<2>& inflow = fluid->domain().boundary.side(0, 0);
  EXPECT_EQ(inflow.temperature(0, {0, 0}, 0), 300);
  EXPECT_EQ(inflow.smoke(0, {0, 0}, 0), 0);
}

// Upper sides as well as lower ones, wherever round-off puts them: 0.1 has no exact binary.
TEST(Fluid, SidesBelongToTheCellsBesideThem) {
  Case<2> scene({12, 7}, 0.1);
  scene.domain.set("Lower", numbers({-0.3, 0.0})).set("Upper", numbers({0.9, 0.7}));
  scene.side("y upper", "open");
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  fluid->set_prediction([](const Point<2>&) { return Point<2>(0, 3); });
  const double left = -0.3, right = 0.9, top = 0.7;
  const auto samples = fluid->output()->sample({{left, 0.35},
                                                {right, 0.35},
                                                {left, 0},
                                                {right, top},
                                                {0.3, top},
                                                {right + 1e-6, 0.35},
                                                {0.3, top + 1e-6}});
  for (int p = 0; p < 5; ++p)
    EXPECT_TRUE(samples[p].in_fluid) << p;
  EXPECT_FALSE(samples[5].in_fluid);
  EXPECT_FALSE(samples[6].in_fluid);
  EXPECT_DOUBLE_EQ(samples[4].velocity[1], 3);
  const auto flows = fluid->output()->flow_across(1, {{0.3, top}, {0.3, 0}});
  EXPECT_DOUBLE_EQ(flows[0].open, 1);
  EXPECT_DOUBLE_EQ(flows[0].rate, 3);
  EXPECT_DOUBLE_EQ(flows[1].rate, 0);  // a wall
}

TEST(Fluid, PointsInSolidsAreNotInTheFluid) {
  Case<2> scene({8, 8}, 1);
  const auto fluid = scene.make();
  Solids<2> solids;  // its sides beside the centres of cells, which are fluid
  solids.add(box_surface<2>(Point<2>(2.8, 2.8), 1), Point<2>(4, 4), true);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const auto samples = fluid->output()->sample({{2.7, 4.2}, {2.55, 4.2}, {2.8, 4.2}});
  EXPECT_FALSE(samples[0].in_fluid);
  EXPECT_TRUE(samples[1].in_fluid);
  EXPECT_FALSE(samples[2].in_fluid);
}

TEST(Fluid, HistoryByHand) {
  Case<2> scene({4, 4}, 0.5);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const GridState<2>& state = fluid->geometry().state;
  const TiledGrid<2>& grid = fluid->domain().grid;
  VelocityHistory<2> history(grid);
  const auto constant = [&](double value) {
    FaceField<2> field;
    field[0].assign(grid.n_stored_cells(), value);
    field[1] = field[0];
    return field;
  };
  // The velocity goes from 1 to 3 m/s in steps of 0.1 s, 2.5 of it advected; the impulse before
  // that is left out.
  history.set_advected(constant(-50));
  history.accept(constant(-100), constant(1), state, 0.1);
  FaceField<2> untouched = constant(1);
  history.add_acceleration(1, untouched);
  history.extrapolate(1, untouched);
  history.set_advected(constant(2.5));
  history.accept(constant(1), constant(3), state, 0.1);
  FaceField<2> middle = constant(3), start = constant(3);
  history.extrapolate(0.2, middle);
  history.add_acceleration(0.1, start);
  // A jump has no rate, nor has the next step one that begins before the jump.
  history.accept(constant(3), constant(9), state, 0.1, true);
  FaceField<2> after_jump = constant(9);
  history.extrapolate(0.2, after_jump);
  history.add_acceleration(0.1, after_jump);
  EXPECT_EQ(after_jump, constant(9));
  int n_free = 0;
  for (int axis = 0; axis < 2; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      const bool free = state.faces[axis][cell] == FaceState::free;
      n_free += free;
      EXPECT_EQ(untouched[axis][cell], 1);
      const bool is_given = state.faces[axis][cell] == FaceState::prescribed;
      EXPECT_NEAR(middle[axis][cell], free || is_given ? 3 + 0.1 * 20 : 3, 1e-12);
      EXPECT_NEAR(start[axis][cell], free ? 3 + 0.1 * 5 : 3, 1e-12);
    });
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(n_free)), 24);
}

TEST(Fluid, AVortexAtRestInTheMeanStaysOneInAStep) {
  Case<2> scene({32, 32}, 1.0 / 32);
  scene.all_periodic();
  scene.fluid.set("Density", 1.0);
  scene.fluid.set("Velocity",
                  formulas({"sin(2*_pi*x)*cos(2*_pi*y)", "-cos(2*_pi*x)*sin(2*_pi*y)"}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const double energy = fluid->audit()->kinetic_energy();
  for (int step = 0; step < 4; ++step) {
    const double dt = 0.5 * fluid->smallest_length() / fluid->largest_speed();
    fluid->begin_prediction();
    make_divergence_free(*fluid);
    fluid->advect(0, dt, no_surface<2>());
    fluid->add_forces(0, dt);
    make_divergence_free(*fluid);
    Vector rhs(fluid->pressure_map());
    fluid->divergence(rhs);
    EXPECT_LT(rhs.normInf() * 32 * 32, 1e-9);
    fluid->accept();
  }
  fluid->begin_prediction();
  EXPECT_NEAR(fluid->audit()->kinetic_energy() / energy, 1, 0.03);
}

TEST(Fluid, AChannelFillsFromTheInflow) {
  Case<3> scene({16, 8, 8}, 0.125);
  scene.side("x lower", "inflow", Point<3>(1, 0, 0)).side("x upper", "open");
  for (const char* const side : {"y lower", "y upper", "z lower", "z upper"})
    scene.side(side, "slip wall");
  scene.domain.sublist("Sides").sublist("x lower").set("Velocity",
                                                       formulas({"min(t, 1)", "0", "0"}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<3>());
  for (const double end : {0.5, 2.0}) {
    fluid->begin_prediction();
    fluid->add_forces(end - 0.1, 0.1);
    make_divergence_free(*fluid);
    fluid->accept();
    const double speed = std::min(end, 1.0);
    EXPECT_NEAR(fluid->largest_speed(), speed, 1e-8);
    // 1000 kg/m^3 on 2 m^3 less the half cell at the inflow.
    EXPECT_NEAR(fluid->audit()->momentum().linear[0], 1000 * speed * (2 - 0.0625), 1e-5);
  }
}

TEST(Fluid, AJetEntersThroughItsOpeningUntilItEnds) {
  Case<2> scene({16, 8}, 0.125);
  scene.side("x lower", "inflow", Point<2>(1, 0)).side("x upper", "open");
  scene.side("y lower", "slip wall").side("y upper", "slip wall");
  ParameterList& jet = scene.domain.sublist("Sides").sublist("x lower");
  jet.set("Velocity", formulas({"t > 1 ? 0 : 6*(y - 0.25)*(0.75 - y)/0.25", "0"}));
  jet.sublist("Opening").set("Lower", numbers({0.0, 0.25})).set("Upper", numbers({0.0, 0.75}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const double flux = 0.5;  // the mean velocity, 1 m/s, through 0.5 m
  for (const double end : {0.5, 2.0}) {
    fluid->begin_prediction();
    fluid->add_forces(end - 0.1, 0.1);
    make_divergence_free(*fluid);
    fluid->accept();
    EXPECT_NEAR(fluid->audit()->momentum().linear[0], end < 1 ? 1000 * flux * (2 - 0.0625) : 0,
                1e-5);
  }
}

/// In a channel whose inflow ramps up and ends at once, what carries things with "Order in Time" 2
/// is the flow in the middle of the step, at the inflow too, and rests as soon as the inflow does.
TEST(Fluid, TheFlowThatCarriesFollowsRampsAndNoJumps) {
  Case<2> scene({16, 8}, 0.125);
  scene.side("x lower", "inflow", Point<2>(1, 0)).side("x upper", "open");
  scene.side("y lower", "slip wall").side("y upper", "slip wall");
  scene.domain.sublist("Sides").sublist("x lower").set("Velocity",
                                                       formulas({"t > 1 ? 0 : t/10", "0"}));
  scene.fluid.set("Order in Time", 2);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const TiledGrid<2>& grid = fluid->domain().grid;
  Vector divergence(fluid->pressure_map());
  constexpr double dt = 0.125;
  for (int step = 0; step < 12; ++step) {
    const double time = step * dt;
    EXPECT_TRUE(fluid->begin_advection_velocity(dt));
    fluid->divergence(divergence);
    EXPECT_LE(divergence.normInf(), 1e-8) << time;
    // The first rate is that of the second step.
    const double expected = time > 1 ? 0 : 0.1 * (step > 1 ? time + dt / 2 : time);
    grid.for_each_owned_face(0, [&](int cell) {
      if (fluid->geometry().state.faces[0][cell] != FaceState::inactive) {
        EXPECT_NEAR(fluid->prediction()[0][cell], expected, 1e-8) << time;
      }
    });
    fluid->advect(time, dt, no_surface<2>());
    fluid->populate_uncovered(no_surface<2>());
    fluid->add_forces(time, dt);
    make_divergence_free(*fluid);
    fluid->accept();
  }
}

TEST(Fluid, SidesKnowWhenTheirVelocityJumps) {
  const auto side = [](const std::string& velocity) {
    Case<2> scene({16, 8}, 0.125);
    scene.side("x lower", "inflow").side("x upper", "open");
    scene.domain.sublist("Sides").sublist("x lower").set("Velocity", formulas({velocity, "0"}));
    validate(scene.domain, domain_parameters<2>(), Source{"test", {}}, "Domain");
    return read_domain<2>(scene.domain).boundary.side(0, 0);
  };
  EXPECT_TRUE(side("t > 0.7 ? 1 : 0").jumps(0.65, 0.75));
  EXPECT_FALSE(side("t > 0.7 ? 1 : 0").jumps(0.6, 0.7));  // not yet at that time itself
  EXPECT_TRUE(side("t > 0.7 ? y : t*y").jumps(0.65, 0.75));
  EXPECT_FALSE(side("min(t, 0.7)*y").jumps(0.65, 0.75));
  EXPECT_FALSE(side("sin(100*t)").jumps(0.65, 0.75));
  EXPECT_FALSE(side("2").jumps(0.65, 0.75));
}

TEST(Fluid, TellsHowFastItsWallsAre) {
  Case<2> scene({16, 8}, 0.125);
  scene.side("x lower", "inflow", Point<2>(1, 0)).side("x upper", "open");
  scene.side("y lower", "wall", Point<2>(3, 0)).side("y upper", "slip wall");
  scene.domain.sublist("Sides").sublist("y lower").set(
      "Velocity", formulas({"t > 4 ? 0 : 3*min(t/2, 1)", "0"}));
  const auto fluid = scene.make();
  EXPECT_EQ(fluid->wall_velocity(1, 0, 1), Point<2>(1.5, 0));
  EXPECT_EQ(fluid->wall_velocity(1, 0, 4), Point<2>(3, 0));
  EXPECT_EQ(fluid->wall_velocity(1, 0, 5), Point<2>(0, 0));
  EXPECT_EQ(fluid->wall_velocity(1, 1, 1), Point<2>(0, 0));
  EXPECT_EQ(fluid->wall_velocity(0, 0, 1), Point<2>(0, 0));  // no wall
}

TEST(Fluid, AnOpeningThatEndsWithinFacesLetsInWhatWasAskedFor) {
  for (const char* const profile : {"uniform", "parabolic"}) {
    for (const double upper :
         {0.45, 0.375, 0.3}) {  // ends of openings in faces 0.125 m wide; the last is within one
      Case<2> scene({16, 8}, 0.125);
      scene.side("x lower", "inflow", Point<2>(2, 0)).side("x upper", "open");
      ParameterList& jet = scene.domain.sublist("Sides").sublist("x lower");
      const std::string to = std::to_string(upper);
      if (profile == std::string("parabolic"))
        jet.set("Velocity",
                formulas({"12*(y - 0.28)*(" + to + " - y)/(" + to + " - 0.28)^2", "0"}));
      jet.sublist("Opening").set("Lower", numbers({0.0, 0.28})).set("Upper", numbers({0.0, upper}));
      const auto fluid = scene.make();
      fluid->set_geometry(nullptr, BlockedFaces<2>());
      double rate = 0;
      for (const PrescribedFlux& flux : fluid->side_fluxes(0)) {
        EXPECT_EQ(flux.name, "the inflow \"x lower\"");
        for (const auto& entry : flux.into)
          rate += entry.second;
      }
      EXPECT_NEAR(sum_all(world(), rate), 2 * (upper - 0.28), 1e-14);
      const auto rhs = make_vector(fluid->pressure_map());
      fluid->divergence(*rhs);
      EXPECT_NEAR(rhs->meanValue() * 128, 2 * (upper - 0.28), 1e-13);
      ASSERT_EQ(fluid->output()->notes().size(), 1u);
    }
  }
}

TEST(Fluid, SourcesFeedSmokeAndAFrameShowsIt) {
  Case<2> scene({20, 12}, 0.1);
  scene.fluid.sublist("Smoke");
  ParameterList& source = scene.fluid.sublist("Sources").sublist("Vent");
  source.set("Shape", "box").set("Smoke", 0.5);
  source.set("Lower", numbers({0.5, 0.0})).set("Upper", numbers({1.0, 0.3}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  fluid->advect(0, 0.25, no_surface<2>());
  std::vector<BoxFrame> frames;
  fluid->output()->add_frame(frames);
  ASSERT_EQ(frames.size(), 1u);
  double smoke = 0, cells = 0;
  for (const BoxField& field : frames[0].fields) {
    for (std::size_t b = 0; b < frames[0].blocks.size(); ++b) {
      const auto& size = frames[0].blocks[b].size;
      std::vector<double> values(static_cast<std::size_t>(size[0]) * size[1] * field.n_components);
      field.fill(b, values.data());
      for (const double value : values) {
        smoke += field.name == "smoke" ? value : 0;
        cells += field.name == "fluid" ? value : 0;
      }
    }
  }
  EXPECT_NEAR(sum_all(world(), smoke), 5 * 3 * 0.5, 1e-13);
  EXPECT_EQ(sum_all(world(), cells), 240);
}

void expect_refused(Case<2>& scene, const std::string& part) {
  try {
    scene.make();
    FAIL() << "accepted; expected: " << part;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}
TEST(Fluid, RefusesDomainsThatCannotBe) {
  Case<2> oblong({10, 10}, 0.1);
  oblong.domain.set("Upper", numbers({1.0, 2.0}));
  expect_refused(oblong, "cells must be as long along every axis");
  Case<2> half({10, 10}, 0.1);
  half.side("x lower", "periodic");
  expect_refused(half, "only one of \"x lower\" and \"x upper\" is periodic");
  Case<2> piston({10, 10}, 0.1);
  piston.side("x lower", "wall", Point<2>(1, 0));
  expect_refused(piston, "a wall cannot move along x");
  Case<2> slit({10, 10}, 0.1);
  slit.side("x lower", "inflow", Point<2>(1, 0)).side("x upper", "open");
  ParameterList& opening = slit.domain.sublist("Sides").sublist("x lower").sublist("Opening");
  opening.set("Lower", numbers({0.0, 1.5})).set("Upper", numbers({0.0, 2.0}));
  expect_refused(slit, "\"Opening\" leaves nothing of the side");
  Case<2> vent({10, 10}, 0.1);
  vent.fluid.sublist("Sources").sublist("Vent").set("Shape", "ball").set("Smoke", 1.0);
  expect_refused(vent, "feeds smoke, but the fluid carries none");
}

TEST(Fluid, IsRegistered) {
  Registry<FluidDiscretization<2>, const ParameterList&, const Communicator&> fluids("fluid");
  register_mac<2>(fluids);
  Case<2> scene({8, 8}, 0.125);
  scene.make();
  const auto fluid = fluids.create("mac", scene.fluid, scene.domain, world());
  EXPECT_EQ(fluid->name(), "mac");
  EXPECT_DOUBLE_EQ(fluid->smallest_length(), 0.125);
}

}  // namespace
}  // namespace lockstep::test
