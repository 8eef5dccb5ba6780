#include <gmock/gmock.h>

#include <filesystem>

#include "base/errors.hpp"
#include "liquid_cases.hpp"
#include "output/checkpoint.hpp"

namespace lockstep::test {
namespace {

/// A tall tank in which only the tiles around a box are stored.
Case<2> tall_tank(const Point<2>& lower, const Point<2>& upper, int n_across = 64) {
  Case<2> scene({n_across, 160}, 0.125);
  ParameterList& tiles = scene.fluid.sublist("Moving Tiles");
  tiles.set("Tile Margin", 4);
  ParameterList& region = tiles.sublist("Keep").sublist("Here");
  region.set("Shape", "box");
  region.set("Lower", numbers({lower[0], lower[1]}));
  region.set("Upper", numbers({upper[0], upper[1]}));
  return scene;
}

Case<2> middle_of_tall_tank() {
  return tall_tank({3, 9}, {5, 11});
}

template <int dim>
void project(MacFluid<dim>& fluid) {
  Vector rhs(fluid.pressure_map()), solution(fluid.pressure_map());
  fluid.divergence(rhs);
  const auto matrix = assembled(fluid.pressure_block());
  conjugate_gradients([&](const Vector& x, Vector& y) { matrix->apply(x, y); }, rhs, solution,
                      1e-14);
  fluid.project(solution);
}

double no_solids() {
  return 0;
}

/// Largest |u_a - velocity_a| on owned free faces.
double largest_difference(const MacFluid<2>& fluid,
                          const std::function<Point<2>(const Point<2>&)>& velocity) {
  double largest = 0;
  const TiledGrid<2>& grid = fluid.domain().grid;
  for (int axis = 0; axis < 2; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      if (fluid.geometry().state.faces[axis][cell] != FaceState::free)
        return;
      const double expected = velocity(grid.face_center(axis, cell))[axis];
      largest = std::max(largest, std::abs(fluid.prediction()[axis][cell] - expected));
    });
  return max_all(world(), largest);
}

TEST(MovingTiles, StoreOnlyWhatWasAskedFor) {
  const auto fluid = middle_of_tall_tank().make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  // Two tiles wide, two high; a rim of one cell is at rest.
  EXPECT_EQ(fluid->pressure_map()->getGlobalNumElements(), 30U * 30U);
  ASSERT_EQ(fluid->regions().n_regions, 1);
  EXPECT_TRUE(fluid->regions().has_dirichlet[0]);
}

/// Where stored tiles make an inner corner, the sides of the domain are far away: none pulls there.
TEST(MovingTiles, NoSidePullsAtInnerCorners) {
  Case<2> scene = tall_tank({3, 9}, {3.3, 11});
  ParameterList& beside = scene.fluid.sublist("Moving Tiles").sublist("Keep").sublist("Beside");
  beside.set("Shape", "box");
  beside.set("Lower", numbers({4.6, 9}));
  beside.set("Upper", numbers({4.9, 9.3}));
  scene.fluid.set("Viscosity", 3.0);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const TiledGrid<2>& grid = fluid->domain().grid;
  const auto& [begin, end] = grid.extent();
  GlobalIndex n_tiles = grid.n_owned_tiles();
  ASSERT_LT(sum_all(world(), n_tiles) * tile_volume<2>,
            GlobalIndex{end[0] - begin[0]} * (end[1] - begin[1]));
  const ViscousStencil<2> links =
      find_viscous_stencil<2>(fluid->domain(), fluid->geometry(), {3.0, 0.2, false}, {});
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(links.sides.size())), 0);
}

/// The last tile along a periodic axis is half as wide, and the first one is not there.
TEST(MovingTiles, ShortTilesAtPeriodicSidesHaveARim) {
  Case<2> scene = tall_tank({7.9, 9}, {8.4, 11}, 72);
  scene.side("x lower", "periodic").side("x upper", "periodic");
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  EXPECT_EQ(fluid->pressure_map()->getGlobalNumElements(), (16U + 8 - 2) * 30);
}

/// Hydrostatics hold without any motion, whatever the ambient scalars weigh.
TEST(MovingTiles, FluidAtRestStaysAtRest) {
  Case<2> scene = middle_of_tall_tank();
  scene.fluid.set("Density", 800.0).set("Gravity", numbers({0.0, -10.0}));
  scene.fluid.set("Body Force", numbers({3.0, 0.0})).set("Thermal Expansion", 0.01);
  scene.fluid.set("Smoke Weight", 0.5);
  scene.fluid.sublist("Temperature").set("Ambient", 310.0);
  scene.fluid.sublist("Smoke").set("Ambient", 0.4);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  fluid->add_forces(0, 0.1);
  project(*fluid);
  const auto rest = [](const Point<2>&) { return Point<2>(0, 0); };
  EXPECT_LE(largest_difference(*fluid, rest), 1e-10);
  fluid->accept();
  const auto pressure = fluid->last_scaled_pressure();
  // p̂ = dt rho f (x - x0) about the middle of the tank, f = (3, -12).
  const auto expected = pressure_vector<2>(
      *fluid, [](const Point<2>& x) { return 0.1 * 800 * (3 * (x[0] - 4) - 12 * (x[1] - 10)); });
  pressure->update(-1, *expected, 1);
  EXPECT_LE(pressure->normInf(), 1e-8);
}

/// The impulse given is what the forces and the pressure beyond the rim do.
TEST(MovingTiles, PressureBeyondTheRimCarriesTheWeight) {
  Case<2> scene = middle_of_tall_tank();
  scene.fluid.set("Density", 2.0).set("Gravity", numbers({0.0, -10.0}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const Momentum<2> before = fluid->audit()->momentum();
  const Momentum<2> given = fluid->add_forces(0, 0.1).impulse;
  const Momentum<2> after = fluid->audit()->momentum();
  EXPECT_NEAR(given.linear[1], (after - before).linear[1], 1e-12);
  EXPECT_NEAR(given.angular[0], (after - before).angular[0], 1e-10);
  EXPECT_NEAR(given.linear[1], 0, 1e-10);
}

/// Moving fluid is kept and gets room, fluid that has come to rest is forgotten.
TEST(MovingTiles, FollowTheFluid) {
  Case<2> scene = tall_tank({3, 1}, {5, 2});
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const auto n_cells = [&] { return fluid->pressure_map()->getGlobalNumElements(); };
  const auto n_at_start = n_cells();
  const auto moving = [](const Point<2>& x) {
    return x[1] < 3.5 ? Point<2>(1 + x[0], 2 - x[1]) : Point<2>(0, 0);
  };
  fluid->begin_prediction();
  fluid->set_prediction(moving);
  fluid->accept();
  EXPECT_TRUE(fluid->begin_step(0, 0.01, no_solids));
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  EXPECT_GT(n_cells(), n_at_start);
  fluid->begin_prediction();
  // The rim of the old tiles was at rest; beyond it is fluid at rest.
  const auto expected = [&](const Point<2>& x) {
    const bool was_free = x[0] > 2.1 && x[0] < 5.9 && x[1] < 3.9;
    return was_free ? moving(x) : Point<2>(0, 0);
  };
  EXPECT_EQ(largest_difference(*fluid, expected), 0);
  EXPECT_TRUE(fluid->begin_step(0, 0.01, no_solids)) << "until a step is accepted";
  fluid->accept();
  EXPECT_FALSE(fluid->begin_step(0.01, 0.01, no_solids));
  fluid->set_prediction([](const Point<2>&) { return Point<2>(0, 0); });
  fluid->accept();
  EXPECT_TRUE(fluid->begin_step(0.02, 0.01, no_solids));
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  EXPECT_EQ(n_cells(), n_at_start);
}

/// A step that a signal ends after its tiles have moved leaves u^n with a divergence there, in the
/// checkpoint as well.
TEST(MovingTiles, MovesOutliveARestart) {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("lockstep_moved_tiles_" + std::to_string(world()->getSize())))
                                 .string();
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  Case<2> scene = tall_tank({3, 1}, {5, 2});
  const auto fluid = scene.make(), restarted = scene.make();
  for (MacFluid<2>* one : {fluid.get(), restarted.get()})
    one->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  fluid->set_prediction([](const Point<2>& x) { return Point<2>(1 + x[0], 2 - x[1]); });
  fluid->accept();
  for (const bool moves : {true, false}) {
    EXPECT_EQ(fluid->begin_step(0, 0.01, no_solids), moves);
    {
      CheckpointWriter writer(world(), folder, {moves ? 1 : 2, 0, "<ParameterList/>"});
      fluid->save(writer);
      writer.finish(2);
    }
    restarted->load(CheckpointReader(world(), latest_checkpoint(folder)));
    restarted->set_geometry(nullptr, BlockedFaces<2>());
    EXPECT_EQ(restarted->begin_step(0, 0.01, no_solids), moves);
    fluid->set_geometry(nullptr, BlockedFaces<2>());
    fluid->begin_prediction();
    fluid->accept();
  }
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

TEST(MovingTiles, MakeRoomForSolids) {
  const auto fluid = tall_tank({3, 1}, {4, 2}).make();
  const auto disc_at = [](double x, double y) {
    return Solids<2>().add(ball_surface<2>(0.5, 0.1), Point<2>(x, y), true).snapshot();
  };
  fluid->set_geometry(disc_at(4, 15), BlockedFaces<2>());
  EXPECT_GT(sum_all(world(), static_cast<GlobalIndex>(fluid->coupled_volumes().size())), 20);
  EXPECT_EQ(fluid->regions().n_regions, 2);
  EXPECT_THROW(fluid->set_geometry(disc_at(4, 10), BlockedFaces<2>()), SolveError);
}

/// The work at a disc that is elsewhere in every step is shared anew every twenty steps, however
/// often each was tried, and however many of its solves were accepted.
TEST(MovingTiles, WorkIsComparedEveryTwentyAcceptedSteps) {
  const auto fluid = Case<2>({128, 128}, 1. / 128).make();
  std::vector<int> shared;
  for (int step = 0; step < 90; ++step) {
    const Point<2> place(0.5 + 0.25 * std::cos(step), 0.5 + 0.25 * std::sin(step));
    const auto disc = Solids<2>().add(ball_surface<2>(0.2, 0.02), place, true).snapshot();
    fluid->set_geometry(disc, BlockedFaces<2>());
    for (int attempt = 0; attempt < 3; ++attempt)
      if (fluid->begin_step(0.01 * step, 0.01, no_solids)) {
        shared.push_back(step);
        fluid->set_geometry(disc, BlockedFaces<2>());
      }
    for (int kick = 0; kick < 1 + step % 2; ++kick) {
      fluid->begin_prediction();
      fluid->accept();
    }
  }
  for (const int step : shared)
    EXPECT_EQ(step % 20, 0) << step;
  EXPECT_EQ(shared.size() > 1, world()->getSize() > 1);
}

/// An interface that cannot live on other tiles is refused with "Moving Tiles", before any step;
/// and without them ranks keep the tiles they have.
TEST(MovingTiles, InterfacesThatStayWhereTheyAre) {
  Case<2> scene({128, 128}, 1. / 128);
  add_ball<2>(scene, {0.6, 0.6}, 0.3);
  const auto fluid = make_liquid(scene);
  const auto disc =
      Solids<2>().add(ball_surface<2>(0.2, 0.02), Point<2>(0.25, 0.25), true).snapshot();
  fluid->set_geometry(disc, BlockedFaces<2>());
  EXPECT_FALSE(fluid->begin_step(0, 0.01, no_solids));
  scene.fluid.sublist("Moving Tiles");
  EXPECT_THROW(make_liquid(scene), InputError);
}

TEST(MovingTiles, RefuseForcesThatWouldMoveTheFluidFarAway) {
  Case<2> scene = middle_of_tall_tank().side("x lower", "periodic").side("x upper", "periodic");
  scene.fluid.set("Body Force", numbers({1.0, 0.0}));
  EXPECT_THROW(scene.make(), InputError);
}

}  // namespace
}  // namespace lockstep::test
