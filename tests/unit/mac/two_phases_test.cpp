// Two incompressible phases: densities of faces, pressures, viscous links and transport beside the
// surface.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <cmath>

#include "liquid/fractions/volume_of_fluid.hpp"
#include "liquid/particles/level_set.hpp"
#include "mac/transport/interface_transport.hpp"
#include "viscous_cases.hpp"

namespace lockstep::test {
namespace {

constexpr double liquid_density = 1000;

template <int dim>
Case<dim> two_phases(int n, double gas_density, double liquid_viscosity = 0,
                     double gas_viscosity = 0) {
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  ParameterList& phases = scene.fluid.sublist("Phases");
  phases.sublist("Liquid").set("Density", liquid_density).set("Viscosity", liquid_viscosity);
  phases.sublist("Gas").set("Density", gas_density).set("Viscosity", gas_viscosity);
  return scene;
}

template <int dim>
double largest_on_free_faces(const MacFluid<dim>& fluid) {
  double largest = 0;
  for (int axis = 0; axis < dim; ++axis)
    fluid.domain().grid.for_each_owned_face(axis, [&](int cell) {
      if (fluid.geometry().state.faces[axis][cell] == FaceState::free)
        largest = std::max(largest, std::abs(fluid.prediction()[axis][cell]));
    });
  return max_all(world(), largest);
}

/// Pressures rho g.(x - x0) of both phases hold the fluid at rest on every face, wherever the
/// surface crosses it and however gravity leans.
template <int dim>
void expect_exact_hydrostatics(double ratio) {
  Case<dim> scene = two_phases<dim>(16, liquid_density / ratio);
  Point<dim> gravity = Point<dim>::Constant(-1.3);
  gravity[dim - 1] = -9.1;
  scene.fluid.set("Gravity", components<dim>(gravity));
  add_level<dim>(scene, 0.613);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  const double dt = 0.01;
  fluid->add_forces(0, dt);
  const auto pressure = make_vector(fluid->pressure_map());
  const TiledGrid<dim>& grid = fluid->domain().grid;
  const double gas_density = fluid->liquid()->gas_density();
  EXPECT_NEAR(gas_density, liquid_density / ratio, 5e-7 * liquid_density / ratio);
  {
    const auto values = pressure->getDataNonConst();
    int row = 0;
    grid.for_each_owned_cell([&](int cell) {
      const double depth = gravity.dot(grid.center(cell)) + 0.613 * gravity.norm();
      values[row++] = dt * depth * (depth > 0 ? liquid_density : gas_density);
    });
  }
  fluid->project(*pressure);
  // Densities are rounded by 6e-8.
  EXPECT_LT(largest_on_free_faces(*fluid), 2e-7 * dt * gravity.norm());
}

TEST(TwoPhases, LinearPressuresHoldBothAtRest) {
  for (const double ratio : {2.0, 833.3, 1e6}) {
    expect_exact_hydrostatics<2>(ratio);
    expect_exact_hydrostatics<3>(ratio);
  }
}

/// A is V G^T rho^-1 G to the last digits, so that a projected velocity is free of divergence.
template <int dim>
void expect_operator_of_own_gradient(double ratio) {
  Case<dim> scene = two_phases<dim>(16, liquid_density / ratio);
  add_ball<dim>(scene, Point<dim>::Constant(0.47), 0.29);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const auto pressure = make_vector(fluid->pressure_map()),
             product = make_vector(fluid->pressure_map()),
             outflow = make_vector(fluid->pressure_map()),
             ones = make_vector(fluid->pressure_map());
  pressure->randomize();
  apply(*fluid->pressure_block(), *pressure, *product);
  fluid->begin_prediction();
  fluid->project(*pressure);
  fluid->divergence(*outflow);
  const double scale = product->normInf();
  outflow->update(1, *product, 1);  // minus the outflow of -rho^-1 G p
  EXPECT_LT(outflow->normInf(), 1e-13 * scale);
  ones->putScalar(1);
  assembled(fluid->pressure_block())->apply(*ones, *product);
  EXPECT_LT(product->normInf(), 1e-15 * scale);
}

TEST(TwoPhases, TheOperatorIsThatOfItsOwnGradient) {
  for (const double ratio : {3.0, 1000.0, 1e6}) {
    expect_operator_of_own_gradient<2>(ratio);
    expect_operator_of_own_gradient<3>(ratio);
  }
}

/// Two layers that shear each other: a velocity whose slopes are as 1 : mu_liquid / mu_gas has the
/// same stress everywhere, so that nothing is pushed, wherever between two faces the surface is.
template <int dim>
void expect_uniform_shear(double level) {
  Case<dim> scene = two_phases<dim>(16, 10, 2.0, 0.25);
  scene.fluid.set("Gravity", components<dim>(Point<dim>(-9.8 * Point<dim>::Unit(dim - 1))));
  add_level<dim>(scene, level);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->set_prediction([&](const Point<dim>& x) {
    const double above = x[dim - 1] - level;
    return Point<dim>(Point<dim>::Unit(0) * (above > 0 ? 8 * above : above));
  });
  const auto system = fluid->viscosity()->viscous_system();
  Vector force(system->map);
  system->stiffness->apply(*system->velocity, force);
  const auto values = force.getData();
  int row = 0;
  double largest = 0;
  for (int axis = 0; axis < dim; ++axis)
    fluid->domain().grid.for_each_owned_face(axis, [&](int cell) {
      if (fluid->geometry().state.faces[axis][cell] != FaceState::free)
        return;
      const double value = std::abs(values[row++]);
      const Index<dim> place = fluid->domain().grid.coordinates(cell);
      const bool is_inner =
          std::all_of(place.begin(), place.end(), [](int at) { return at > 1 && at < 14; });
      largest = is_inner ? std::max(largest, value) : largest;
    });
  EXPECT_LT(max_all(world(), largest), 1e-12);
}

TEST(TwoPhases, ShearEachOtherByOneStress) {
  for (const double level : {0.5, 0.513, 0.529, 0.548}) {
    expect_uniform_shear<2>(level);
    expect_uniform_shear<3>(level);
  }
}

/// Nothing is left of the symmetric stress where both turn as a solid, and nothing gains energy.
template <int dim>
void expect_symmetric_stress() {
  Case<dim> scene = two_phases<dim>(16, 10, 0.7, 0.02);
  const Point<dim> center = Point<dim>::Constant(0.49);
  add_ball<dim>(scene, center, 0.3);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->set_prediction([&](const Point<dim>& x) {
    Point<dim> u = Point<dim>::Constant(0.3);
    u[0] -= x[1] - center[1];
    u[1] += x[0] - center[0];
    return u;
  });
  const auto system = fluid->viscosity()->viscous_system();
  Vector force(system->map), product(system->map);
  system->stiffness->apply(*system->velocity, force);
  const auto values = force.getData();
  int row = 0;
  double largest = 0;
  const TiledGrid<dim>& grid = fluid->domain().grid;
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      if (fluid->geometry().state.faces[axis][cell] != FaceState::free)
        return;
      const double value = std::abs(values[row++]);
      if ((grid.face_center(axis, cell) - center).norm() < 0.4)  // walls hold what is farther off
        largest = std::max(largest, value);
    });
  EXPECT_LT(max_all(world(), largest), 1e-13);
  for (int i = 0; i < 10; ++i) {
    force.randomize();
    system->stiffness->apply(force, product);
    EXPECT_GT(force.dot(product), 0);
  }
}

TEST(TwoPhases, NothingHoldsWhatTurns) {
  expect_symmetric_stress<2>();
  expect_symmetric_stress<3>();
}

/// By one flux: a uniform velocity stays what it is to round-off, and values stay within those of
/// the start, which the heavy fluid hardly changes and the light one does.
template <int dim>
void expect_consistent_transport() {
  Case<dim> scene = two_phases<dim>(16, 1);
  add_ball<dim>(scene, Point<dim>::Constant(0.5), 0.26);
  for (int axis = 0; axis < dim; ++axis)
    for (const char* end : {" lower", " upper"})
      scene.side(std::string(1, "xyz"[axis]) + end, "periodic");
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const MacDomain<dim>& domain = fluid->domain();
  const auto& geometry = fluid->geometry();
  CellField phi(domain.grid.n_stored_cells(), 1);
  domain.grid.for_each_stored_cell([&](int cell) {
    phi[cell] = (domain.grid.center(cell) - Point<dim>::Constant(0.5)).norm() - 0.26;
  });
  FaceField<dim> uniform, heavy_moves;
  for (int axis = 0; axis < dim; ++axis) {
    uniform[axis].assign(domain.grid.n_stored_cells(), axis == 0 ? 1.0 : 0.5);
    heavy_moves[axis] = uniform[axis];
    for (std::size_t cell = 0; cell < phi.size(); ++cell)
      heavy_moves[axis][cell] *=
          geometry.face_table(axis, static_cast<int>(cell)).density > 900 ? 1 : 0;
  }
  const double dt = 0.9 / 16;
  const InterfaceTransport<dim> transport(domain, geometry, phi, uniform, dt);
  FaceField<dim> result = uniform;
  transport.advect(uniform, result);
  double apart = 0;
  for (int axis = 0; axis < dim; ++axis)
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      apart = std::max(apart, std::abs(result[axis][cell] - uniform[axis][cell]));
    });
  EXPECT_LT(max_all(world(), apart), 1e-14);
  result = heavy_moves;
  transport.advect(heavy_moves, result);
  double least = 1, most = 0, slowest_in_drop = 1;
  domain.grid.for_each_owned_face(0, [&](int cell) {
    least = std::min(least, result[0][cell]);
    most = std::max(most, result[0][cell]);
    Point<dim> from = domain.grid.face_center(0, cell) - Point<dim>::Constant(0.5);
    for (int axis = 0; axis < dim; ++axis)
      from[axis] -= dt * uniform[axis][0];
    if (from.norm() < 0.26 - 2.0 / 16)  // the drop's fluid is there now
      slowest_in_drop = std::min(slowest_in_drop, result[0][cell]);
  });
  EXPECT_GT(least, -1e-14);
  EXPECT_LT(most, 1 + 1e-14);
  EXPECT_GT(-max_all(world(), -slowest_in_drop), 0.99);
}

TEST(TwoPhases, MomentumGoesWithMass) {
  expect_consistent_transport<2>();
  expect_consistent_transport<3>();
}

/// A bubble under tension is as much above the pressure around it as Laplace says, and next to
/// nothing moves.
TEST(TwoPhases, ARoundDropRests) {
  Case<2> scene = two_phases<2>(32, 1);
  scene.fluid.sublist("Free Surface").set("Surface Tension", 0.7);
  add_ball<2>(scene, Point<2>::Constant(0.5), 0.31);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const double dt = 1e-3;
  fluid->add_forces(0, dt);
  const double pushed = largest_on_free_faces(*fluid);
  const auto pressure = solve_and_project(*fluid);
  EXPECT_LT(largest_on_free_faces(*fluid), 0.02 * pushed);
  const auto values = pressure->getData();
  double inside = -1e300, outside = -1e300;
  int row = 0;
  fluid->domain().grid.for_each_owned_cell([&](int cell) {
    const double from_center = (fluid->domain().grid.center(cell) - Point<2>::Constant(0.5)).norm();
    const double value = values[row++] / dt;
    if (from_center < 0.03)
      inside = std::max(inside, value);
    if (from_center > 0.65)
      outside = std::max(outside, value);
  });
  const double jump = max_all(world(), inside) - max_all(world(), outside);
  EXPECT_NEAR(jump, 0.7 / 0.31, 0.03 * 0.7 / 0.31);
}

/// An interface model that is told how its surface is bent.
template <typename Model>
class OfGivenCurvature : public Model {
 public:
  using Model::Model;
  static constexpr double given = 2.7;  ///< [1/m]; that of the ball is another
  std::optional<double> curvature(int, int, int, double, const CellField&) const override {
    return given;
  }
};

template <int dim>
InterfaceRegistry<dim> interfaces_of_given_curvature() {
  InterfaceRegistry<dim> interfaces("interface model");
  using Levels = OfGivenCurvature<LevelSet<dim>>;
  using Fractions = OfGivenCurvature<VolumeOfFluid<dim>>;
  const auto levels = [](const ParameterList& list, const MacDomain<dim>& domain) {
    return std::make_unique<Levels>(domain, read_level_set_parameters(list));
  };
  interfaces.add("level set", "A distance.", level_set_parameters<dim>, levels);
  interfaces.add("volume of fluid", "Fractions.", volume_of_fluid_parameters,
                 [](const ParameterList& list, const MacDomain<dim>& domain) {
                   return std::make_unique<Fractions>(domain,
                                                      read_volume_of_fluid_parameters(list));
                 });
  return interfaces;
}

/// Tension is in balance with the pressure that is sigma kappa higher in the drop and uniform on
/// both sides: with one kappa on all of the surface, whatever moves is round-off.
template <int dim>
void expect_balance_with_given_curvature(const std::string& type, double ratio) {
  SCOPED_TRACE(type + fmt::format(", {}D, {}", dim, ratio));
  const double tension = 0.7, dt = 1e-3;
  Case<dim> scene = two_phases<dim>(16, liquid_density / ratio);
  ParameterList& surface = scene.fluid.sublist("Free Surface");
  surface.set("Surface Tension", tension).sublist("Interface").set("Type", type);
  add_ball<dim>(scene, Point<dim>(Point<dim>::Constant(0.49) + 0.02 * Point<dim>::Unit(0)), 0.31);
  const InterfaceRegistry<dim> interfaces = interfaces_of_given_curvature<dim>();
  const auto fluid = make_liquid<dim>(scene, interfaces);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->add_forces(0, dt);
  const double pushed = largest_on_free_faces(*fluid);
  EXPECT_GT(pushed, 0);
  const auto pressure = make_vector(fluid->pressure_map());
  {
    const auto values = pressure->getDataNonConst();
    const TiledGrid<dim>& grid = fluid->domain().grid;
    int row = 0;
    grid.for_each_owned_cell([&](int cell) {
      const bool is_wet = fluid->liquid()->surface_distance(grid.center(cell)) < 0;
      values[row++] = is_wet ? dt * tension * OfGivenCurvature<LevelSet<dim>>::given : 0;
    });
  }
  fluid->project(*pressure);
  EXPECT_LT(largest_on_free_faces(*fluid), 1e-14 * pushed);
}

TEST(TwoPhases, ADropOfGivenCurvatureRestsToRoundOff) {
  for (const char* type : {"level set", "volume of fluid"})
    for (const double ratio : {1.0, 1000.0, 1e6}) {
      expect_balance_with_given_curvature<2>(type, ratio);
      expect_balance_with_given_curvature<3>(type, ratio);
    }
}

TEST(TwoPhases, ContradictionsAreRefused) {
  const auto message_of = [](const std::function<void(Case<2>&)>& change) {
    Case<2> scene = two_phases<2>(8, 1);
    add_ball<2>(scene, Point<2>::Constant(0.5), 0.2);
    change(scene);
    try {
      make_liquid<2>(scene);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message_of([](Case<2>& scene) {
              scene.fluid.set("Density", 2.0);
            }).find("each phase has one"),
            std::string::npos);
  EXPECT_NE(message_of([](Case<2>& scene) {
              scene.fluid.sublist("Free Surface").set("Trapped Air", "ideal gas");
            }).find("leave out \"Trapped Air\""),
            std::string::npos);
  EXPECT_NE(message_of([](Case<2>& scene) {
              scene.fluid.remove("Free Surface");
            }).find("nothing says where each of them is"),
            std::string::npos);
}

}  // namespace
}  // namespace lockstep::test
