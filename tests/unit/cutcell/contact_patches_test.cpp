// Bodies that touch walls and each other: no rigid motion changes the volume of the
// fluid, and what the pressure gives to bodies and walls has no sum.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <type_traits>

#include "cutcell/flux_coupling.hpp"
#include "interfaces/fluid_sides.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "support/dense.hpp"
#include "unit/cutcell/bodies_in_tank.hpp"
#include "unit/mac/liquid_cases.hpp"

namespace lockstep::test {
namespace {

constexpr int n_tank_cells = 16;

/// A box of these half sizes, turned about the vertical axis in 3D.
template <int dim>
FakeBody<dim> block(const Point<dim>& center, const Point<dim>& half, double angle = 0) {
  FakeBody<dim> body;
  body.surface = box_surface<dim>(2 * half, 1);
  for (Point<dim>& x : body.surface.vertices) {
    if (dim == 3)
      x.template head<2>() = Eigen::Rotation2Dd(angle) * x.template head<2>();
    x += center;
  }
  body.center = center;
  return body;
}

template <int dim>
FakeBody<dim> ball(const Point<dim>& center, double radius) {
  FakeBody<dim> body;
  body.surface = ball_surface<dim>(radius, 0.05);
  for (Point<dim>& x : body.surface.vertices)
    x += center;
  body.center = center;
  return body;
}

/// Bodies in a closed unit tank, with mixed faces or with fluxes.
template <int dim, typename TankCoupling = MixedFaceCoupling<dim>>
struct FullTank : BodiesInTank<dim, TankCoupling> {
  using Options = std::conditional_t<std::is_same_v<TankCoupling, FluxCoupling<dim>>, FluxOptions,
                                     MixedFaceOptions>;
  explicit FullTank(const std::vector<FakeBody<dim>>& bodies)
      : BodiesInTank<dim, TankCoupling>(
            Case<dim>(cube<dim>(n_tank_cells), 1. / n_tank_cells).make(), bodies, Options()) {}
  /// The volume that a unit of each dof's velocity makes [m^dim/s].
  Eigen::VectorXd volume_rates() const {
    Vector ones(this->fluid->pressure_map()), rates(this->solids->map());
    ones.putScalar(1);
    this->coupling.coupling_transposed()->apply(ones, rates);
    return dense(rates);
  }
};

template <int dim>
std::vector<std::vector<FakeBody<dim>>> touching_bodies() {
  if constexpr (dim == 2)
    return {
        {block<2>({0.5, 0.1}, {0.2, 0.1})},
        {ball<2>({0.5, 0.15}, 0.15)},
        {block<2>({0.5, 0.107}, {0.2, 0.107}), block<2>({0.47, 0.314}, {0.15, 0.1})},
        {block<2>({0.1, 0.1}, {0.1, 0.1}), ball<2>({0.3, 0.1}, 0.1), ball<2>({0.2, 0.28}, 0.1)}};
  else
    return {{block<3>({0.5, 0.47, 0.1}, {0.15, 0.12, 0.1}, 0.3)},
            {block<3>({0.5, 0.5, 0.107}, {0.2, 0.2, 0.107}),
             block<3>({0.52, 0.47, 0.314}, {0.15, 0.12, 0.1})},
            {block<3>({0.2, 0.2, 0.1}, {0.2, 0.2, 0.1}), ball<3>({0.16, 0.13, 0.32}, 0.12)}};
}

// Each row misses what the body pushes out at the patch otherwise: 0.02 to 0.4 m^(dim-1). Open
// parts of faces are rounded to 2^-20 under flux.
template <int dim, typename TankCoupling>
void expect_no_volume(double tolerance) {
  for (const auto& bodies : touching_bodies<dim>()) {
    const FullTank<dim, TankCoupling> tank(bodies);
    // A point of a floor is none under flux: there the cells beside it have their pressures.
    const bool has_patches = std::is_same_v<TankCoupling, MixedFaceCoupling<dim>>;
    EXPECT_TRUE(tank.fluid->contact_patches() || !has_patches);
    EXPECT_LT(tank.volume_rates().template lpNorm<Eigen::Infinity>(), tolerance);
    const bool is_one = tank.fluid->regions().n_regions == 1;  // cells that are cut off lock bodies
    if (is_one && tolerance < 1e-12) {
      EXPECT_FALSE(tank.system->locks_solids());
    }
  }
}

TEST(ContactPatches, NoMotionChangesTheVolumeOfFluid) {
  expect_no_volume<2, MixedFaceCoupling<2>>(1e-14);
  expect_no_volume<3, MixedFaceCoupling<3>>(1e-14);
}

TEST(ContactPatches, NoMotionChangesTheVolumeOfFluidUnderFlux) {
  expect_no_volume<2, FluxCoupling<2>>(1e-6);
  expect_no_volume<3, FluxCoupling<3>>(1e-6);
}

/// Impulses of a wavy pressure on bodies, walls and the fluid's own faces.
template <int dim>
void expect_balance(const std::vector<FakeBody<dim>>& bodies) {
  const FullTank<dim> tank(bodies);
  const auto pressure = pressure_vector<dim>(*tank.fluid, [](const Point<dim>& x) {
    return std::sin(7 * x[0]) + std::cos(9 * x[dim - 1]) + x.prod();
  });
  const auto on_bodies = make_vector(tank.solids->map());
  tank.coupling.coupling_transposed()->apply(*pressure, *on_bodies, Teuchos::NO_TRANS, -1, 0);
  const Momentum<dim> of_bodies = tank.solids->momentum(*on_bodies);
  const auto* audit = tank.fluid->audit();
  const Momentum<dim> before = audit->momentum();
  tank.fluid->project(*pressure);
  const Momentum<dim> of_fluid = audit->momentum() - before;
  const Momentum<dim> of_walls = audit->boundary_pressure_impulse(*pressure);
  EXPECT_LT((of_bodies.linear + of_fluid.linear - of_walls.linear).norm(), 1e-13);
  EXPECT_LT((of_bodies.angular + of_fluid.angular - of_walls.angular).norm(), 1e-13);
  EXPECT_GT(of_bodies.linear.norm(), 1e-3);
}

TEST(ContactPatches, BodiesFluidAndWallsShareTheImpulse) {
  for (const auto& bodies : touching_bodies<2>())
    expect_balance<2>(bodies);
  for (const auto& bodies : touching_bodies<3>())
    expect_balance<3>(bodies);
}

// The uplift below a dam from wall to wall falls linearly from one side to the other.
TEST(ContactPatches, UpliftBelowADamIsLinear) {
  const FullTank<2> tank({block<2>({0.5, 0.25}, {0.25, 0.25})});
  const double h = 1. / n_tank_cells;
  const auto pressure = pressure_vector<2>(
      *tank.fluid, [](const Point<2>& x) { return x[0] < 0.5 && x[1] < 0.5 ? 1. : 0.; });
  const auto impulse = make_vector(tank.solids->map());
  tank.coupling.coupling_transposed()->apply(*pressure, *impulse, Teuchos::NO_TRANS, -1, 0);
  const Eigen::VectorXd given = dense(*impulse);
  EXPECT_NEAR(given[0], 0.5, 1e-14);        // the side, all along it
  EXPECT_NEAR(given[1], 0.5 * 0.5, 1e-14);  // half of its base
  // About the centre: the side by its height, the base by its triangle, whose feet are the centres
  // of the cells at the rim.
  double torque = 0.5 * 0;
  const int n = 8;
  for (int k = 1; k <= n; ++k)
    torque += h * (1 - k / (n + 1.)) * (0.25 + (k - 0.5) * h - 0.5);
  EXPECT_NEAR(given[2], torque, 1e-14);
}

// A body that goes through the wall displaces fluid as it comes in.
TEST(ContactPatches, NoneWhereABodyGoesThroughTheWall) {
  const FullTank<2> tank({block<2>({0.5, 0}, {0.2, 0.2})});
  EXPECT_FALSE(tank.fluid->contact_patches());
  EXPECT_NEAR(tank.volume_rates()[1], 6. / n_tank_cells, 1e-14);
  EXPECT_TRUE(tank.system->locks_solids());
}

}  // namespace
}  // namespace lockstep::test
