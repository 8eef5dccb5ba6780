#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <Tpetra_CrsMatrix.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
double fastest_free_face(const MacFluid<dim>& fluid) {
  double fastest = 0;
  for (int axis = 0; axis < dim; ++axis)
    fluid.domain().grid.for_each_owned_face(axis, [&](int cell) {
      if (fluid.geometry().state.faces[axis][cell] == FaceState::free)
        fastest = std::max(fastest, std::abs(fluid.prediction()[axis][cell]));
    });
  return max_all(fluid.domain().grid.comm(), fastest);
}

/// Between the centres of cells: what lies below must not move, and know its depth.
template <int dim>
void expect_rest(const Point<dim>& gravity, double height, double fastest) {
  constexpr int n = 20;
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  scene.fluid.set("Density", 3.0).set("Gravity", components<dim>(gravity));
  add_level<dim>(scene, height);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  EXPECT_EQ(fluid->regions().n_regions, 1);
  EXPECT_TRUE(fluid->regions().has_dirichlet[0]);
  const double dt = 0.1;
  fluid->begin_prediction();
  fluid->add_forces(0, dt);
  EXPECT_GT(fastest_free_face<dim>(*fluid), 0.5);
  const RCP<Vector> pressure = solve_and_project<dim>(*fluid);
  EXPECT_LT(fastest_free_face<dim>(*fluid), fastest);
  const Point<dim> up = -gravity.normalized();
  const auto expected = pressure_vector<dim>(
      *fluid, [&](const Point<dim>& x) { return dt * 3 * gravity.norm() * (height - x.dot(up)); });
  const double of_a_cell = dt * 3 * gravity.norm() / n;
  pressure->update(-1, *expected, 1);
  EXPECT_LT(pressure->normInf(), 1e-10 * of_a_cell);
}
TEST(FreeSurface, WaterRestsWithAPressureOfItsDepth) {
  expect_rest<2>({0, -9.81}, 0.5 + 0.37 / 20, 1e-12);
  expect_rest<3>({0, 0, -9.81}, 0.5 + 0.37 / 20, 1e-12);
}
/// Cells with several faces to the air have one pressure, and weights of any size.
TEST(FreeSurface, TiltedWaterRestsToo) {
  expect_rest<2>({3, -9}, 0.31, 1e-12);
  expect_rest<3>({2, -3, -9}, 0.37, 1e-12);
}

TEST(FreeSurface, FacesOfAColumnByHand) {
  Case<2> scene({4, 8}, 0.5);
  scene.fluid.set("Density", 2.0).set("Gravity", numbers({0.0, -10.0}));
  add_level<2>(scene, 1.95);  // cell 3 has its centre at 1.75, cell 4 at 2.25
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const auto& grid = fluid->domain().grid;
  const auto& geometry = fluid->geometry();
  const int wet = grid.cell({1, 3}), dry = grid.cell({1, 4});
  EXPECT_EQ(fluid->fluid_volume(), 16 * 0.25);
  if (dry < 0 || !grid.owned(dry))
    return;
  EXPECT_EQ(geometry.state.cells[wet], CellState::fluid);
  EXPECT_EQ(geometry.state.cells[dry], CellState::air);
  EXPECT_EQ(geometry.state.faces[1][dry], FaceState::free);
  EXPECT_EQ(geometry.state.faces[0][dry], FaceState::inactive);
  // theta = 0.4: two and a half times as near, and so much less mass.
  EXPECT_NEAR(geometry.face_table(1, dry).distance_factor, 2.5, 1e-12);
  EXPECT_NEAR(geometry.mass(1, dry), 2 * 0.25 / 2.5, 1e-12);
  EXPECT_NEAR(geometry.face_table(1, dry).gradient, 2.5 / (2 * 0.5), 1e-12);
}

/// The gain of the free faces is the impulse of the walls: p = 0 at the surface gives none.
template <int dim>
void expect_surface_impulses_telescope() {
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Density", 3.0);
  add_ball<dim>(scene, Point<dim>::Constant(0.3), 0.38);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const auto pressure = pressure_vector<dim>(*fluid, wavy<dim>);
  fluid->begin_prediction();
  const Momentum<dim> before = fluid->audit()->momentum();
  fluid->project(*pressure);
  Momentum<dim> gained = fluid->audit()->momentum() - before;
  const Momentum<dim> given = fluid->audit()->boundary_pressure_impulse(*pressure);
  EXPECT_LT((gained.linear - given.linear).norm(), 1e-13) << given.linear.transpose();
  EXPECT_LT((gained.angular - given.angular).norm(), 1e-13) << given.angular.transpose();
  EXPECT_GT(given.linear.norm(), 0.01);
}
TEST(FreeSurface, ImpulsesTelescope) {
  expect_surface_impulses_telescope<2>();
  expect_surface_impulses_telescope<3>();
}

template <int dim>
void expect_symmetric_positive() {
  Case<dim> scene(cube<dim>(20), 0.05);
  add_ball<dim>(scene, Point<dim>::Constant(0.43), 0.31);
  const auto fluid = make_liquid<dim>(scene);
  Solids<dim> solids;
  solids.add(ball_surface<dim>(0.171, 0.05), Point<dim>::Constant(0.62), true);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
  const auto x = pressure_vector<dim>(*fluid, wavy<dim>);
  const auto y = pressure_vector<dim>(
      *fluid, [](const Point<dim>& p) { return wavy<dim>(Point<dim>(3 * p)) - 0.2; });
  Vector ax(x->getMap()), ay(x->getMap()), with_matrix(x->getMap());
  apply(*fluid->pressure_block(), *x, ax);
  apply(*fluid->pressure_block(), *y, ay);
  EXPECT_NEAR(y->dot(ax), x->dot(ay), 1e-12 * std::abs(x->dot(ax)));
  EXPECT_GT(x->dot(ax), 0);
  assembled(fluid->pressure_block())->apply(*x, with_matrix);
  with_matrix.update(-1, ax, 1);
  EXPECT_LT(with_matrix.normInf(), 1e-13 * ax.normInf());
}
TEST(FreeSurface, PressureBlockIsSymmetricPositive) {
  expect_symmetric_positive<2>();
  expect_symmetric_positive<3>();
}

/// A diamond from a file, moved.
TEST(FreeSurface, LiquidFillsAMesh) {
  const std::string file = fmt::format("liquid-{}.obj", world()->getRank());
  std::ofstream(file) << "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nl 1 2\nl 2 3\nl 3 4\nl 4 1\n";
  Case<2> scene({48, 48}, 0.1);
  ParameterList& mesh = scene.fluid.sublist("Free Surface").sublist("Liquid").sublist("diamond");
  mesh.set("Type", "mesh").set("File", file);
  mesh.set("Position", numbers({2.4, 2.41}));
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  std::filesystem::remove(file);
  EXPECT_NEAR(fluid->fluid_volume(), 2, 0.1);
  fluid->domain().grid.for_each_owned_cell([&](int cell) {
    const Point<2> x = fluid->domain().grid.center(cell);
    const double excess = std::abs(x[0] - 2.4) + std::abs(x[1] - 2.41) - 1;
    EXPECT_EQ(fluid->geometry().state.cells[cell] == CellState::fluid, excess < 0);
  });
}

/// A box without lid in the water: nothing is in it, wherever a rank's part of it ends.
TEST(FreeSurface, TheInsideOfAHullIsDry) {
  Case<2> scene({48, 48}, 0.1);
  scene.fluid.set("Gravity", numbers({0.0, -1.0}));
  add_level<2>(scene, 3.02);
  scene.fluid.sublist("Free Surface").set("Dry Points", numbers({1.6, 2.0}));
  Solids<2> solids;
  solids.add(open_box_surface<2>(Point<2>(3.03, 2.03), 0.1), Point<2>(2.401, 2.601), false);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  // 48 x 30 cells are below the surface, 30 x 14 of them in the hull.
  EXPECT_NEAR(fluid->fluid_volume(), 0.01 * (48 * 30 - 30 * 14), 1e-12);
  const auto volume_around = [&](const ParameterArray<double>& point) {
    scene.fluid.sublist("Free Surface").set("Dry Points", point);
    const auto same = make_liquid<2>(scene);
    same->set_geometry(solids.snapshot(), BlockedFaces<2>());
    return same->fluid_volume();
  };
  // Above the bottom, at 1.586, of the hull, in a cell whose centre is in the sea below.
  EXPECT_NEAR(volume_around(numbers({1.6, 1.59})), 0.01 * (48 * 30 - 30 * 14), 1e-12);
  // Below the bottom: the sea is dried, the hull is not.
  EXPECT_NEAR(volume_around(numbers({1.6, 1.58})), 0.01 * (30 * 14), 1e-12);
  EXPECT_THROW(volume_around(numbers({1.6, 20.0})), InputError);
}

/// Both sides of a wall on a bottom are one room where the axis across it is periodic.
TEST(FreeSurface, DryRoomsGoOnBeyondPeriodicSides) {
  Case<2> scene({48, 48}, 0.1);
  scene.side("x lower", "periodic").side("x upper", "periodic");
  scene.fluid.set("Gravity", numbers({0.0, -1.0}));
  add_level<2>(scene, 3.02);
  scene.fluid.sublist("Free Surface").set("Dry Points", numbers({0.6, 2.5}));
  Solids<2> solids;
  solids.add(plate_surface<2>(Point<2>(4.82, 1), 1, 0.1), Point<2>(2.4, 2.001), false);
  solids.add(plate_surface<2>(Point<2>(1, 2.0), 0, 0.1), Point<2>(1.201, 3.001), false);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  EXPECT_NEAR(fluid->fluid_volume(), 0.01 * 48 * 20, 1e-12);
}

TEST(FreeSurface, DryPointsAndLiquidInSolidsAreRefused) {
  Solids<2> solids;
  solids.add(ball_surface<2>(0.4, 0.1), Point<2>(0.8, 0.8), true);
  const auto message = [&](const auto& add_liquid, const ParameterArray<double>& dry_point) {
    Case<2> scene({16, 16}, 0.1);
    scene.fluid.set("Gravity", numbers({0.0, -1.0}));
    add_liquid(scene);
    scene.fluid.sublist("Free Surface").set("Dry Points", dry_point);
    try {
      make_liquid<2>(scene)->set_geometry(solids.snapshot(), BlockedFaces<2>());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto pool = [](Case<2>& scene) { add_level<2>(scene, 0.6); };
  EXPECT_EQ(message(pool, {}), "");
  EXPECT_NE(message(pool, numbers({0.8, 0.7})).find("lies inside a solid"), std::string::npos);
  const auto in_the_ball = [](Case<2>& scene) { add_ball<2>(scene, {0.8, 0.8}, 0.2); };
  EXPECT_NE(message(in_the_ball, {}).find("nothing is in the domain and outside of solids"),
            std::string::npos);
}

/// Its surface stays where it is, and tells what it was asked.
struct Listener : FixedInterface<2> {
  struct Heard {
    Point<2> gravity = Point<2>::Zero();
    double displacement = 0;  ///< the largest
  };
  Listener(const MacDomain<2>& domain, Heard& heard) : FixedInterface<2>(domain), heard_(heard) {}
  void advance(const InterfaceStep<2>& step) override { heard_.gravity = step.gravity; }
  int band(double displacement) const override {
    heard_.displacement = std::max(heard_.displacement, displacement);
    return std::max(4, static_cast<int>(displacement) + 1);
  }
  Heard& heard_;
};

/// A ball of liquid in a vortex, one step on.
std::unique_ptr<MacFluid<2>> ball_in_a_vortex(const std::string& force, double speed, double dt,
                                              Listener::Heard& heard) {
  InterfaceRegistry<2> interfaces("interface model");
  interfaces.add(
      "listener", "", [] { return ParameterList(); },
      [&](const ParameterList&, const MacDomain<2>& domain) {
        return std::make_unique<Listener>(domain, heard);
      });
  Case<2> scene({20, 20}, 0.05);
  scene.fluid.set(force, numbers({0.6, -0.8}));
  scene.fluid.sublist("Free Surface").sublist("Interface").set("Type", "listener");
  const std::string u = std::to_string(speed);
  scene.fluid.set("Velocity", formulas({u + "*sin(8*_pi*x)*cos(8*_pi*y)",
                                        "-" + u + "*cos(8*_pi*x)*sin(8*_pi*y)"}));
  add_ball<2>(scene, {0.48, 0.52}, 0.3);
  validate(scene.fluid, mac_parameters<2>(&interfaces), Source{"test", {}}, "Fluid");
  validate(scene.domain, domain_parameters<2>(), Source{"test", {}}, "Domain");
  auto fluid = std::make_unique<MacFluid<2>>(scene.fluid, scene.domain, world(), &interfaces);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  fluid->advect(
      0, dt, {nullptr, nullptr, [](const SurfacePoint<2>&) { return Point<2>(Point<2>::Zero()); }});
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  return fluid;
}

/// A liquid alone cannot tell one from the other: they bound its steps alike, drops fall with
/// either, and both make short waves.
TEST(FreeSurface, ABodyForceIsFeltAsGravityIs) {
  Listener::Heard by_gravity, by_body;
  const auto heavy = ball_in_a_vortex("Gravity", 0.05, 0.1, by_gravity);
  const auto pushed = ball_in_a_vortex("Body Force", 0.05, 0.1, by_body);
  EXPECT_NEAR(pushed->largest_stable_step().dt, std::sqrt(0.05), 1e-14);
  EXPECT_EQ(heavy->largest_stable_step().dt, pushed->largest_stable_step().dt);
  EXPECT_EQ(by_gravity.gravity, Point<2>(0.6, -0.8));
  EXPECT_EQ(by_body.gravity, by_gravity.gravity);
  for (int axis = 0; axis < 2; ++axis)
    heavy->domain().grid.for_each_owned_face(axis, [&](int cell) {
      EXPECT_EQ(heavy->geometry().mass(axis, cell), pushed->geometry().mass(axis, cell));
    });
}

/// Before anything goes over as many cells: at 1e8 cells a step that would take hours.
TEST(FreeSurface, ARunThatBlowsUpEndsSoon) {
  Listener::Heard heard;
  EXPECT_THROW(ball_in_a_vortex("Gravity", 3e6, 0.1, heard), SolveError);
  EXPECT_LE(heard.displacement, 2 * 20 + 4);
}

TEST(FreeSurface, BadListsSayWhatIsWrong) {
  const auto message = [](const std::function<void(Case<2>&)>& spoil) {
    Case<2> scene({8, 8}, 0.1);
    scene.fluid.set("Gravity", numbers({0.0, -1.0}));
    spoil(scene);
    try {
      make_liquid<2>(scene)->set_geometry(nullptr, BlockedFaces<2>());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message([](Case<2>& scene) { add_level<2>(scene, 0.4); }), "");
  EXPECT_NE(
      message([](Case<2>& scene) { scene.fluid.sublist("Free Surface"); }).find("has no liquid"),
      std::string::npos);
  EXPECT_NE(message([](Case<2>& scene) {
              add_level<2>(scene, 0.4);
              scene.fluid.set("Gravity", numbers({0.0, 0.0}));
            }).find("where up"),
            std::string::npos);
  EXPECT_NE(message([](Case<2>& scene) {
              add_level<2>(scene, 0.4);
              scene.fluid.sublist("Smoke");
            }).find("carries no scalars"),
            std::string::npos);
  EXPECT_NE(message([](Case<2>& scene) {
              add_level<2>(scene, 0.4);
              scene.all_periodic();
            }).find("periodic axis y"),
            std::string::npos);
}

}  // namespace
}  // namespace lockstep::test
