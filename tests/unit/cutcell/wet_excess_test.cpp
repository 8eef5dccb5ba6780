// Excess of the hydrostatic force of water with a plane surface on a body, for any gravity.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "conformance/fake_solid.hpp"
#include "coupling/coupled_system.hpp"
#include "cutcell/flux_coupling.hpp"
#include "support/dense.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {
namespace {

constexpr int n_cells = 16;
constexpr double radius = 0.23;

/// A disc in a unit tank of density one. The grid has water everywhere; the body says where its
/// surface is.
struct Afloat {
  explicit Afloat(const Point<2>& slope) : coupling(FluxOptions()) {
    test::Case<2> scene({n_cells, n_cells}, 1. / n_cells);
    scene.fluid.set("Density", 1.0).set("Gravity", test::numbers({0., -1.}));
    fluid = scene.make();
    FakeBody<2> disc;
    disc.surface = ball_surface<2>(radius, 0.005);
    disc.center = center;
    for (auto& x : disc.surface.vertices)
      x += center;
    disc.mass = 2;
    disc.inertia = 0.3;
    std::vector<std::unique_ptr<SolidModel<2>>> models;
    models.push_back(std::make_unique<FakeSolid<2>>(
        std::vector<FakeBody<2>>{disc}, FakeSolidOptions<2>(), Tpetra::getDefaultComm()));
    solids = std::make_unique<SolidSystem<2>>(std::move(models), Tpetra::getDefaultComm());
    system = std::make_unique<CoupledSystem<2>>(*fluid, *solids, coupling);
    surface = solids->snapshot();
    system->freeze(surface);
    // Half of the disc is wet.
    body.partly = true;
    body.volume = 0.5 * M_PI * radius * radius;
    body.centroid = center - 4 * radius / (3 * M_PI) * slope.normalized();
    body.slope = slope;
    body.level = slope.dot(center);
  }
  /// On the body by the excess, weighed by gravity; with a wave there is no water near the surface
  /// on the left.
  Point<2> excess_force(const Point<2>& gravity, bool has_wave = false) const {
    std::vector<ControlVolume<2>> volumes = fluid->coupled_volumes();
    std::vector<FaceShares<2>> shares;
    for (ControlVolume<2>& volume : volumes) {
      shares.push_back(face_shares<2>(volume, *surface, FaceWeights::areas));
      for (auto& side : volume.sides)
        if (has_wave && side.center[0] < center[0] && side.center[1] > center[1] - 1.5 / n_cells)
          side.unknown = no_index;
    }
    Point<2> force = Point<2>::Zero();
    const Box<2> domain(Point<2>(0, 0), Point<2>(1, 1));
    for (const auto& excess :
         displaced_excess<2>(volumes, shares, std::vector<double>(volumes.size(), 0), *surface, 1,
                             domain, gravity, {body}, solids->comm()))
      force[excess.axis] += excess.mass * gravity[excess.axis];
    return force;
  }
  Point<2> lift(const Point<2>& gravity) const {
    const auto pressure = test::pressure_vector<2>(
        *fluid, [&](const Point<2>& x) { return gravity.norm() * body.depth(x); });
    const auto impulse = make_vector(solids->map());
    coupling.coupling_transposed()->apply(*pressure, *impulse, Teuchos::NO_TRANS, -1, 0);
    return dense(*impulse).head(2);
  }

  Point<2> center{0.52, 0.47};
  std::unique_ptr<MacFluid<2>> fluid;
  std::unique_ptr<SolidSystem<2>> solids;
  FluxCoupling<2> coupling;
  std::unique_ptr<CoupledSystem<2>> system;
  std::shared_ptr<const SurfaceSnapshot<2>> surface;
  WetBody<2> body;
};

/// The pressure and the excess together push along the slope of the water, by what is wet.
void expect_exact_lift(const Point<2>& gravity, const Point<2>& slope) {
  const Afloat c(slope);
  const Point<2> wanted = gravity.norm() * c.body.volume * slope;
  const Point<2> given = c.lift(gravity) + c.excess_force(gravity);
  EXPECT_LT((given - wanted).norm(), 1e-13 * gravity.norm()) << slope.transpose();
}

}  // namespace

TEST(WetExcess, WaterAtRestLiftsWhatIsWet) {
  const Point<2> gravity(1, -9.8);
  expect_exact_lift(gravity, -gravity.normalized());
}

TEST(WetExcess, WaterThatMovesPushesAlongItsSlope) {
  const Point<2> gravity(1, -9.8);
  for (const double slope : {0., 1e-5, -0.03, 0.3})
    expect_exact_lift(gravity, Point<2>(slope, 1));
}

// Level water, and a wave on one side of the disc: what it gives is of the size of cells.
TEST(WetExcess, LevelWaterUnderTiltedGravityGivesNoMoreThanItHas) {
  const Point<2> gravity(1, -9.8);
  for (const double slope : {1e-4, 1e-5, 1e-9}) {
    const Afloat c(Point<2>(slope, 1));
    const double of_a_cell = gravity.norm() / (n_cells * n_cells);
    EXPECT_LT(std::abs(c.excess_force(gravity)[0]), of_a_cell) << slope;
    EXPECT_LT(std::abs(c.excess_force(gravity, true)[0]), 4 * of_a_cell) << slope;
  }
}

}  // namespace lockstep::test
