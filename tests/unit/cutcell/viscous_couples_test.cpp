// The symmetric stress at turning bodies, with the staggered grid and both couplings.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "conformance/fake_solid.hpp"
#include "coupling/coupled_system.hpp"
#include "coupling/viscous_solve.hpp"
#include "cutcell/flux_coupling.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {
namespace {

constexpr double viscosity = 0.7, dt = 0.05;

template <int dim>
FakeBody<dim> turning_ball(double radius, const Point<dim>& center, double spacing) {
  FakeBody<dim> body;
  body.surface = ball_surface<dim>(radius, spacing);
  for (auto& x : body.surface.vertices)
    x += center;
  body.center = center;
  body.mass = 0.1;
  body.inertia = 0.01;
  return body;
}

template <int dim>
AngularVector<dim> spin() {
  AngularVector<dim> omega;
  for (int k = 0; k < n_rotations<dim>; ++k)
    omega[k] = 0.8 - 0.5 * k;
  return omega;
}

/// A tank with bodies, frozen at their places.
template <int dim, template <int> class Kind>
struct ViscousCase {
  ViscousCase(int n_cells, std::vector<FakeBody<dim>> bodies, bool periodic) {
    test::Case<dim> scene(test::cube<dim>(n_cells), 1. / n_cells);
    scene.fluid.set("Density", 1.3);
    scene.fluid.set("Viscosity", viscosity);
    if (periodic)
      scene.all_periodic();
    fluid = scene.make();
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(std::make_unique<FakeSolid<dim>>(std::move(bodies), FakeSolidOptions<dim>(),
                                                      Tpetra::getDefaultComm()));
    solids = std::make_unique<SolidSystem<dim>>(std::move(models), Tpetra::getDefaultComm());
    system = std::make_unique<CoupledSystem<dim>>(*fluid, *solids, coupling);
    system->freeze(solids->snapshot());
    fluid->begin_prediction();
  }
  ViscousResult<dim> solve() {
    fluid->set_coupled_velocity(coupling.velocity(*solids->velocity()));
    ViscousOptions options;
    options.tolerance = 1e-14;
    const auto viscous = fluid->viscosity()->viscous_system();
    return solve_viscous<dim>(
        {*viscous, *fluid->viscosity(), *solids, coupling, system->blocks(dt).solid_block(), {}},
        {system->lumped_momentum(*solids->explicit_momentum(0, dt)), dt, solids->reduction(),
         options});
  }
  std::unique_ptr<MacFluid<dim>> fluid;
  std::unique_ptr<SolidSystem<dim>> solids;
  Kind<dim> coupling{{}};
  std::unique_ptr<CoupledSystem<dim>> system;
};

/// Impulse of the transposed gradient on a ball in dt.
template <int dim>
double couple_scale(double radius) {
  const double volume = dim == 2 ? M_PI * radius * radius : 4. / 3 * M_PI * std::pow(radius, 3);
  return dt * 2 * viscosity * volume * spin<dim>().norm();
}

/// A ball and the fluid around it turn with a container: nothing pulls.
template <int dim, template <int> class Kind>
void expect_rigid_motion_is_free(int n_cells) {
  const Point<dim> center = Point<dim>::Constant(0.51), place = center - 0.09 * Point<dim>::Unit(0);
  FakeBody<dim> container = turning_ball<dim>(0.43, center, 0.9 / n_cells);
  container.kind = FakeBody<dim>::Kind::prescribed;
  container.closed = false;
  container.angular_velocity = spin<dim>();
  FakeBody<dim> ball = turning_ball<dim>(0.19, place, 0.7 / n_cells);
  ball.velocity = rotate<dim>(spin<dim>(), place - center);
  ball.angular_velocity = spin<dim>();
  ViscousCase<dim, Kind> c(n_cells, {ball, container}, false);
  c.fluid->set_prediction(
      [&](const Point<dim>& x) { return rotate<dim>(spin<dim>(), x - center); });
  const FaceField<dim> before = c.fluid->prediction();
  const ViscousResult<dim> result = c.solve();
  const Momentum<dim> given = c.solids->momentum(*result.solid_impulse);
  const double scale = couple_scale<dim>(0.19);
  EXPECT_LT(given.linear.norm(), 1e-11 * scale);
  EXPECT_LT(given.angular.norm(), 1e-11 * scale);
  const auto& grid = c.fluid->domain().grid;
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      const bool is_free = c.fluid->geometry().state.faces[axis][cell] == FaceState::free;
      if (is_free && (grid.face_center(axis, cell) - center).norm() < 0.43) {
        EXPECT_NEAR(c.fluid->prediction()[axis][cell], before[axis][cell], 1e-11);
      }
    });
}

/// Momentum of partly open faces counts at the centroid of the open part, forces act at the centre:
/// that couple is not one of the viscous stress.
template <int dim>
AngularVector<dim> moment_of_cuts(const MacFluid<dim>& fluid) {
  Momentum<dim> sum;
  const std::vector<double> velocity = fluid.coupled_velocity();
  for (std::size_t f = 0; f < velocity.size(); ++f) {
    const ControlVolume<dim>& volume = fluid.coupled_volumes()[f];
    const double mass = volume.density * volume.box.volume() * volume.open_fraction;
    sum.add(volume.open_center - volume.center, volume.direction, mass * velocity[f]);
  }
  return sum_over_ranks(sum, test::world()).angular;
}

/// Whatever moves, no couple comes from outside: the fluid loses what the body gains.
template <int dim, template <int> class Kind>
void expect_no_couple_from_outside(int n_cells) {
  FakeBody<dim> ball = turning_ball<dim>(0.23, Point<dim>::Constant(0.52), 0.7 / n_cells);
  ball.velocity = Point<dim>::Constant(0.4);
  ball.angular_velocity = spin<dim>();
  for (const bool prescribed : {false, true}) {
    FakeBody<dim> other = turning_ball<dim>(0.08, Point<dim>::Constant(0.13), 0.7 / n_cells);
    other.angular_velocity = -spin<dim>();
    (prescribed ? ball : other).kind = FakeBody<dim>::Kind::prescribed;
    ViscousCase<dim, Kind> c(n_cells, {ball, other}, true);
    c.fluid->set_prediction(test::wavy_velocity<dim>);
    const AngularVector<dim> before = moment_of_cuts(*c.fluid);
    const ViscousResult<dim> result = c.solve();
    AngularVector<dim> couple = result.boundary_impulse.angular + before - moment_of_cuts(*c.fluid);
    const AngularVector<dim> held = total_of(result.prescribed_impulses).angular;
    EXPECT_GT(held.norm(), 1e-4);
    couple -= held;
    EXPECT_LT(couple.norm(), 1e-11 * couple_scale<dim>(0.23));
  }
}

}  // namespace

TEST(ViscousCouples, RigidMotionIsFree) {
  expect_rigid_motion_is_free<2, MixedFaceCoupling>(24);
  expect_rigid_motion_is_free<2, FluxCoupling>(24);
  expect_rigid_motion_is_free<3, MixedFaceCoupling>(14);
  expect_rigid_motion_is_free<3, FluxCoupling>(14);
}

TEST(ViscousCouples, NoneComesFromOutside) {
  expect_no_couple_from_outside<2, MixedFaceCoupling>(24);
  expect_no_couple_from_outside<2, FluxCoupling>(24);
  expect_no_couple_from_outside<3, MixedFaceCoupling>(14);
  expect_no_couple_from_outside<3, FluxCoupling>(14);
}

}  // namespace lockstep::test
