// Surface tension: how the surface is bent, and what that does.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "liquid/liquid.hpp"
#include "liquid/surface/surface_tension.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

/// Largest error of the curvature of a ball, times its radius, at all lines that its surface
/// crosses; an eighth of it, so that the sides mirror the rest, or a cap that meets the lower side
/// along y at another angle [degrees], of which that side is told.
template <int dim>
double error_of_curvature(int n, double radius, double angle = 90, double told = 90) {
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  scene.domain.sublist("Sides").sublist("y lower").set("Contact Angle", told);
  const Point<dim> center = -radius * std::cos(angle * pi / 180) * Point<dim>::Unit(1);
  add_ball<dim>(scene, center, radius);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const MacDomain<dim>& domain = fluid->domain();
  CellField phi(domain.grid.n_stored_cells(), 1);
  domain.grid.for_each_stored_cell(
      [&](int c) { phi[c] = (domain.grid.center(c) - center).norm() - radius; });
  double worst = 0;
  domain.grid.for_each_owned_cell([&](int c) {
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = domain.grid.neighbor(c, i / 2, i % 2);
      if (other < 0 || phi[c] >= 0 || phi[other] < 0)
        continue;
      const double place = phi[c] / (phi[c] - phi[other]);
      const double kappa = curvature(domain, phi, c, i / 2, i % 2, place);
      worst = std::max(worst, std::abs(kappa * radius - (dim - 1)));
    }
  });
  return max_all(world(), worst);
}

TEST(SurfaceTension, FindsTheCurvatureOfABall) {
  const double coarse = error_of_curvature<2>(16, 0.61), fine = error_of_curvature<2>(32, 0.61);
  EXPECT_LT(coarse, 0.045);
  EXPECT_LT(fine, 0.5 * coarse);
  // In 3D the fit is narrower, and what is linear between two centres shows.
  EXPECT_LT(error_of_curvature<3>(16, 0.61), 0.08);
  EXPECT_LT(error_of_curvature<3>(32, 0.61), 0.08);
}

// A surface that meets a wall at its contact angle goes on beyond it, one that does not is bent
// there, so that tension pulls it to the angle.
TEST(SurfaceTension, CapsAtTheirContactAngleAreNotBentAtTheWall) {
  for (const double angle : {45., 60., 120., 135.}) {
    SCOPED_TRACE(angle);
    const double coarse = error_of_curvature<2>(16, 0.5, angle, angle);
    const double fine = error_of_curvature<2>(32, 0.5, angle, angle);
    EXPECT_LT(coarse, 0.3);
    EXPECT_LT(fine, 0.7 * coarse);
    EXPECT_LT(error_of_curvature<3>(32, 0.5, angle, angle), 0.25);
    EXPECT_GT(error_of_curvature<2>(32, 0.5, angle, 90), 1);
  }
}

/// The velocity gains what the ledger is told, and each face what its area bears.
template <int dim>
void expect_impulse_is_known() {
  const double tension = 0.7, dt = 0.01;
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Density", 3.0);
  add_ball<dim>(scene, Point<dim>::Constant(0.31), 0.38);  // cut by walls
  scene.fluid.sublist("Free Surface")
      .set("Surface Tension", tension)
      .set("Time Integration", "explicit");
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  EXPECT_NEAR(fluid->largest_stable_step().dt, 0.28 * std::sqrt(3 * std::pow(0.05, 3) / tension),
              1e-12);
  fluid->begin_prediction();
  const Momentum<dim> before = fluid->audit()->momentum();
  const ForceImpulse<dim> given = fluid->add_forces(0, dt);
  const Momentum<dim> gained = fluid->audit()->momentum() - before,
                      surface = fluid->liquid()->surface_impulse();
  EXPECT_LT((gained.linear - surface.linear).norm(), 1e-13);
  EXPECT_LT((gained.angular - surface.angular).norm(), 1e-13);
  EXPECT_EQ(given.impulse.linear, surface.linear);
  // A quarter of a disc is drawn to its corner by p_s times the width of what is open (3D alike).
  const double radius = 0.38, push = tension * (dim - 1) / radius * dt;
  EXPECT_LT(surface.linear.maxCoeff(), -0.5 * push * std::pow(radius, dim - 1));
}

TEST(SurfaceTension, ItsImpulseIsKnown) {
  expect_impulse_is_known<2>();
  expect_impulse_is_known<3>();
}

/// Two drops, or two bubbles, whose curvatures are known to a few percent: tension moves neither of
/// them, whether the gas has a mass or not. One across the corner of a periodic domain is a whole.
template <int dim>
void expect_closed_surfaces_stay(double gas_density, bool drops) {
  const double tension = 0.7, dt = 0.01, radius = 0.19;
  Case<dim> scene(cube<dim>(32), 1.0 / 32);
  for (int axis = 0; axis < dim; ++axis)
    for (const char* end : {" lower", " upper"})
      scene.side(std::string(1, "xyz"[axis]) + end, "periodic");
  ParameterList& surface = scene.fluid.sublist("Free Surface");
  surface.set("Surface Tension", tension);
  if (gas_density > 0)
    scene.fluid.sublist("Phases").sublist("Gas").set("Density", gas_density);
  if (!drops) {
    const Point<dim> lower = Point<dim>::Constant(-1), upper = Point<dim>::Constant(2);
    ParameterList& all = surface.sublist("Liquid").sublist("all");
    all.set("Type", "box").set("Lower", components<dim>(lower));
    all.set("Upper", components<dim>(upper));
  }
  for (const double place : {0.47, 0.01}) {
    const Point<dim> center = Point<dim>::Constant(place) + 0.02 * Point<dim>::Unit(0);
    ParameterList& ball =
        surface.sublist(drops ? "Liquid" : "Bubbles").sublist(fmt::format("ball {}", place));
    ball.set("Type", "ball").set("Radius", radius).set("Center", components<dim>(center));
  }
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->add_forces(0, dt);
  EXPECT_GT(fluid->audit()->kinetic_energy(), 0);
  const double push = tension * (dim - 1) / radius * dt * std::pow(radius, dim - 1);
  EXPECT_LT(fluid->liquid()->surface_impulse().linear.norm(), 1e-13 * push);
}

TEST(SurfaceTension, ClosedSurfacesStayWhereTheyAre) {
  for (const bool drops : {true, false}) {
    expect_closed_surfaces_stay<2>(1e-3, drops);
    expect_closed_surfaces_stay<3>(1e-3, drops);
  }
  expect_closed_surfaces_stay<2>(0, true);
  expect_closed_surfaces_stay<3>(0, true);
}

/// A round drop at rest: the pressure jumps by sigma (dim - 1) / R, and hardly anything moves.
template <int dim>
void expect_jump(double tolerance) {
  const double tension = 0.7, dt = 0.01, radius = 0.31;
  Case<dim> scene(cube<dim>(20), 0.05);
  add_ball<dim>(scene, Point<dim>::Constant(0.49), radius);
  scene.fluid.sublist("Free Surface").set("Surface Tension", tension);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->add_forces(0, dt);
  const double pushed = fluid->audit()->kinetic_energy();
  const auto pressure = solve_and_project<dim>(*fluid);
  const double jump = dt * tension * (dim - 1) / radius;
  const auto values = pressure->getData();
  for (int i = 0; i < static_cast<int>(values.size()); ++i)
    EXPECT_NEAR(values[i], jump, tolerance * jump);
  EXPECT_LT(fluid->audit()->kinetic_energy(), tolerance * tolerance * pushed);
}

TEST(SurfaceTension, ARoundDropRests) {
  expect_jump<2>(0.08);
  expect_jump<3>(0.08);
}

/// Work that implicit tension takes from a velocity, u . dt K u over sigma dt^2, and its couple.
template <int dim>
struct Held {
  double work = 0, asymmetry = 0;
  Momentum<dim> impulse;
};

template <int dim>
Held<dim> held_back(int n, const std::function<void(Case<dim>&)>& add_liquid,
                    const std::function<Point<dim>(const Point<dim>&)>& velocity) {
  const double tension = 0.7, dt = 0.01;
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  scene.fluid.set("Density", 3.0);
  add_liquid(scene);
  scene.fluid.sublist("Free Surface")
      .set("Surface Tension", tension)
      .set("Time Integration", "semi-implicit");
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  EXPECT_NE(fluid->viscosity(), nullptr);
  EXPECT_NEAR(fluid->largest_stable_step().dt,
              8 * 0.28 * std::sqrt(3 * std::pow(1.0 / n, 3) / tension), 1e-12);
  fluid->begin_prediction();
  fluid->add_forces(0, dt);
  fluid->set_prediction(velocity);
  const auto system = fluid->viscosity()->viscous_system();
  Vector force(system->map), other(system->map), reply(system->map);
  system->stiffness->apply(*system->velocity, force);
  for (int row = 0; row < static_cast<int>(other.getLocalLength()); ++row)
    other.replaceLocalValue(row, std::sin(double(system->map->getGlobalElement(row))));
  system->stiffness->apply(other, reply);
  Held<dim> held;
  held.work = force.dot(*system->velocity) / (tension * dt);
  held.asymmetry = std::abs(force.dot(other) - reply.dot(*system->velocity)) / force.norm2();
  const Momentum<dim> before = fluid->liquid()->surface_impulse();
  fluid->viscosity()->accept_viscous(*system->velocity, *system->velocity, dt);
  held.impulse = fluid->liquid()->surface_impulse() - before;
  held.impulse.linear /= tension * dt * dt;
  held.impulse.angular /= tension * dt * dt;
  return held;
}

/// A ball that turns: every line on it turns at the same rate, which costs its length. All that
/// moves alike costs nothing.
template <int dim>
void expect_turning_is_held_back(int n, double least) {
  const double radius = 0.31, area = dim == 2 ? 2 * M_PI * radius : 4 * M_PI * radius * radius;
  const Point<dim> center = Point<dim>::Constant(0.5);
  const auto ball = [&](Case<dim>& scene) { add_ball<dim>(scene, center, radius); };
  const Held<dim> turning = held_back<dim>(n, ball, [&](const Point<dim>& x) {
    Point<dim> u = Point<dim>::Zero();
    u[0] = -(x - center)[1];
    u[1] = (x - center)[0];
    return u;
  });
  // In 3D |grad_s u|^2 is 2 less what of the gradient is along n, 2/3 in the mean.
  const double expected = area * (dim == 2 ? 1 : 4.0 / 3);
  // The outermost part of the layer around the surface has no velocities.
  EXPECT_GT(turning.work / expected, least);
  EXPECT_LT(turning.work / expected, 1);
  EXPECT_LT(turning.asymmetry, 1e-13);
  // Power is couple times rate; linear momentum stays.
  EXPECT_NEAR(turning.impulse.angular[dim == 2 ? 0 : 2], -turning.work, 1e-9 * turning.work);
  EXPECT_LT(turning.impulse.linear.norm(), 1e-12);
  const Held<dim> uniform =
      held_back<dim>(n, ball, [](const Point<dim>&) { return Point<dim>::Constant(0.3); });
  EXPECT_LT(std::abs(uniform.work), 1e-13);
}

TEST(SurfaceTension, ItsImplicitPartHoldsBackWhatTurns) {
  expect_turning_is_held_back<2>(32, 0.77);
  expect_turning_is_held_back<3>(16, 0.7);
}

/// A slanted plane: what changes along it is held back, not what changes across it; but for a part
/// where single neighbours do not know across from along.
template <int dim>
void expect_only_what_is_along_is_held_back(int n, const Point<dim>& up, double part) {
  const Point<dim> normal = up.normalized();
  const auto plane = [&](Case<dim>& scene) {
    scene.fluid.set("Gravity", components<dim>(-normal));
    add_level<dim>(scene, normal.dot(Point<dim>::Constant(0.5)));
  };
  Point<dim> along = Point<dim>::Unit(0) - normal * normal[0];
  along.normalize();
  const auto held_along = [&](const Point<dim>& direction) {
    return held_back<dim>(n, plane,
                          [=](const Point<dim>& x) {
                            return Point<dim>(Point<dim>::Unit(0) * direction.dot(x));
                          })
        .work;
  };
  EXPECT_LT(held_along(normal), part * held_along(along));
}

TEST(SurfaceTension, ItsImplicitPartHoldsBackOnlyWhatIsAlongTheSurface) {
  expect_only_what_is_along_is_held_back<2>(32, {1, 1}, 0.005);
  expect_only_what_is_along_is_held_back<2>(32, {0.4, 1}, 0.08);
  expect_only_what_is_along_is_held_back<3>(16, {1, 1, 1}, 0.02);
}

// However far the pressure's surface is ahead of the liquid's: beyond centres of cells, faces that
// look at one from several sides would find different curvatures at next to no distance.
TEST(SurfaceTension, ThePressuresSurfaceStaysBetweenCentres) {
  Case<2> scene({16, 16}, 1.0 / 16);
  add_ball<2>(scene, Point<2>::Constant(0.49), 0.31);
  const auto fluid = make_liquid<2>(scene);
  const MacDomain<2>& domain = fluid->domain();
  const InterfaceRegistry<2> interfaces = fixed_interfaces<2>();
  const Point<2> none = Point<2>::Zero();
  Liquid<2> liquid(scene.fluid, none, none, interfaces, domain);
  liquid.begin(nullptr);
  const std::vector<StoredField> fields = liquid.fields();
  ASSERT_EQ(fields[0].name, "surface_filter_shift");
  for (const double lead : {0.0, -0.4, -2.0, 0.4, 2.0}) {
    fields[0].components[0]->assign(domain.grid.n_stored_cells(), lead / 16);
    const FreeSurface<2> surface = liquid.surface();
    domain.grid.for_each_owned_cell([&](int cell) {
      for (int i = 0; i < 4; ++i) {
        const int other = domain.grid.neighbor(cell, i / 2, i % 2);
        if (!surface.wet(cell) || other < 0 || surface.wet(other))
          continue;
        EXPECT_GT(surface.crossing(cell, other), 0) << lead;
        EXPECT_LE(surface.crossing(cell, other), 1) << lead;
      }
    });
  }
}

// Where phi is steeper than a distance, as where it jumps near solids, rows and columns agree, too.
TEST(SurfaceTension, ItsImplicitPartIsSymmetricWherePhiIsSteep) {
  const auto ball = [](Case<2>& scene) { add_ball<2>(scene, Point<2>::Constant(0.5), 0.31); };
  for (const double steepness : {2.0, 3.0, 5.0}) {
    FixedInterface<2>::steepness = steepness;
    const Held<2> held = held_back<2>(32, ball, wavy_velocity<2>);
    FixedInterface<2>::steepness = 1;
    EXPECT_GT(held.work, 0.1);
    EXPECT_LT(held.asymmetry, 1e-13);
  }
}

}  // namespace
}  // namespace lockstep::test
