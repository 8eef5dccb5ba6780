// The hydrostatic force on bodies that float in water at rest: that of Archimedes to round-off, at
// any tilt of gravity, whatever cells and coupling make of the body.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "conformance/fake_solid.hpp"
#include "coupling/coupled_system.hpp"
#include "cutcell/flux_coupling.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "support/dense.hpp"
#include "unit/mac/liquid_cases.hpp"

namespace lockstep::test {
namespace {

constexpr int n_cells = 16;

/// Area and centroid of the part of a convex polygon below a height along `up`, by cutting and
/// summing triangles.
std::pair<double, Point<2>> part_below_by_hand(const std::vector<Point<2>>& polygon,
                                               const Point<2>& up, double height) {
  std::vector<Point<2>> below;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = up.dot(a) - height, over_b = up.dot(b) - height;
    if (over_a <= 0)
      below.push_back(a);
    if ((over_a < 0) != (over_b < 0))
      below.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  double area = 0;
  Point<2> moment = Point<2>::Zero();
  for (std::size_t i = 1; i + 1 < below.size(); ++i) {
    const double part = 0.5 * cross<2>(below[i] - below[0], below[i + 1] - below[0])[0];
    area += part;
    moment += part / 3 * (below[0] + below[i] + below[i + 1]);
  }
  return {area, moment / area};
}

/// A turned log in a tank of water of density one.
struct Afloat {
  Afloat(const Point<2>& gravity, double height, std::unique_ptr<Coupling<2>> how)
      : coupling(std::move(how)), up(-gravity.normalized()) {
    const double angle = 0.35;
    const Point<2> along(std::cos(angle), std::sin(angle)), across(-along[1], along[0]);
    FakeBody<2> log;
    log.center = {0.517, 0.473};
    for (const auto& [x, y] : {std::pair{-0.21, -0.13}, {0.21, -0.13}, {0.21, 0.13}, {-0.21, 0.13}})
      corners.push_back(log.center + x * along + y * across);
    for (int k = 0; k < 4; ++k) {
      log.surface.vertices.push_back(corners[k]);
      log.surface.simplices.push_back({k, (k + 1) % 4});
    }
    log.mass = 2;
    log.inertia = 0.3;
    Case<2> scene({n_cells, n_cells}, 1. / n_cells);
    scene.fluid.set("Density", 1.0).set("Gravity", components<2>(gravity));
    add_level<2>(scene, height);
    fluid = make_liquid<2>(scene);
    std::vector<std::unique_ptr<SolidModel<2>>> models;
    models.push_back(std::make_unique<FakeSolid<2>>(
        std::vector<FakeBody<2>>{log}, FakeSolidOptions<2>(), Tpetra::getDefaultComm()));
    solids = std::make_unique<SolidSystem<2>>(std::move(models), Tpetra::getDefaultComm());
    system = std::make_unique<CoupledSystem<2>>(*fluid, *solids, *coupling);
    surface = solids->snapshot();
    system->freeze(surface);
    fluid->begin_prediction();
    fluid->add_forces(0, 1);
    center = log.center;
  }
  /// Force and torque about the centre in water at rest, over a unit of time.
  Eigen::Vector3d force(const Point<2>& gravity, double height) const {
    const auto pressure = pressure_vector<2>(
        *fluid, [&](const Point<2>& x) { return gravity.norm() * (height - up.dot(x)); });
    const auto impulse = make_vector(solids->map());
    coupling->coupling_transposed()->apply(*pressure, *impulse, Teuchos::NO_TRANS, -1, 1);
    coupling->add_lumped_momentum(fluid->coupled_velocity(), *impulse);
    on_grid = dense(*impulse).head(3);
    coupling->hydrostatics()->add_hydrostatic_force(1, *impulse);
    return dense(*impulse).head(3);
  }

  std::unique_ptr<Coupling<2>> coupling;
  Point<2> up, center;
  std::vector<Point<2>> corners;
  std::unique_ptr<MacFluid<2>> fluid;
  std::unique_ptr<SolidSystem<2>> solids;
  std::unique_ptr<CoupledSystem<2>> system;
  std::shared_ptr<const SurfaceSnapshot<2>> surface;
  mutable Eigen::Vector3d on_grid;
};

void expect_archimedes(const Point<2>& gravity, bool is_flux) {
  const Point<2> up = -gravity.normalized();
  for (const double part : {-0.11, -0.02, 0.013, 0.09}) {
    const double height = up.dot(Point<2>(0.517, 0.473)) + part;
    const Afloat c(gravity, height,
                   is_flux ? std::unique_ptr<Coupling<2>>(new FluxCoupling<2>({}))
                           : std::unique_ptr<Coupling<2>>(new MixedFaceCoupling<2>({})));
    const auto [area, centroid] = part_below_by_hand(c.corners, up, height);
    Eigen::Vector3d expected;
    expected.head(2) = -area * gravity;
    expected[2] = cross<2>(centroid - c.center, expected.head<2>().eval())[0];
    const Eigen::Vector3d force = c.force(gravity, height);
    EXPECT_LT((force - expected).norm(), 1e-12 * gravity.norm()) << part << ' ' << is_flux;
    EXPECT_GT((c.on_grid - expected).norm(), 1e-5 * gravity.norm()) << part;
  }
}

TEST(Afloat, LiftAndTorqueAreExactUnderLevelWater) {
  for (const bool is_flux : {false, true})
    expect_archimedes(Point<2>(0, -9.8), is_flux);
}

TEST(Afloat, LiftAndTorqueAreExactUnderTiltedGravity) {
  for (const bool is_flux : {false, true})
    for (const Point<2>& gravity : {Point<2>(1, -9.8), Point<2>(-3, -2)})
      expect_archimedes(gravity, is_flux);
}

}  // namespace
}  // namespace lockstep::test
