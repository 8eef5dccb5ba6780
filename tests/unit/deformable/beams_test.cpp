// Beams in plane strain against published figures, without fluid.
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "deformable/elements/volume_elements.hpp"
#include "deformable/mesh/volume_generators.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

/// The flag of Turek and Hron (2006): 0.35 x 0.02 behind a cylinder of radius 0.05, to which its
/// left end is fixed; `n` elements across.
DeformableBody<2> flag(int n, double youngs_modulus, double stiffness_damping) {
  VolumeMesh<2> mesh = box_volume<2>({0.35, 0.02}, 0.02 / n);
  for (auto& x : mesh.vertices) {
    const double left = std::sqrt(0.05 * 0.05 - x.y() * x.y()), along = x.x() / 0.35 + 0.5;
    x.x() = left + along * (0.4 - left);
  }
  const LameConstants lame = lame_constants(youngs_modulus, 0.4);
  DeformableBody<2> body;
  body.name = "flag";
  body.density = 1000;
  body.integration = TimeIntegration::fully_implicit;
  body.position = mesh.vertices;
  body.velocity.assign(mesh.vertices.size(), Point<2>::Zero());
  body.force = body.velocity;
  for (const auto& x : mesh.vertices) {
    const bool fixed = std::abs(x.norm() - 0.05) < 1e-9;
    body.locked.push_back({fixed, fixed});
  }
  body.elements.push_back(
      volume_elements<2>(mesh, st_venant_kirchhoff<2>(lame),
                         {stiffness_damping * lame.mu, stiffness_damping * lame.lambda}));
  body.mass_elements = body.elements.back()->corners();
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    body.element_measure.push_back(element_volume(mesh, static_cast<int>(e)));
  const auto boundary = extract_surface(mesh, "flag");
  for (const auto& s : boundary.surface.simplices)
    body.surface.push_back({boundary.vertices[s[0]], boundary.vertices[s[1]]});
  return body;
}

std::unique_ptr<DeformableSolids<2>> falling_flag(int n, double youngs_modulus,
                                                  double stiffness_damping) {
  std::vector<DeformableBody<2>> bodies;
  bodies.push_back(flag(n, youngs_modulus, stiffness_damping));
  return std::make_unique<DeformableSolids<2>>("deformable body", std::move(bodies),
                                               Point<2>(0, -2), world());
}

/// The vertex at the middle of the free end.
struct Tip {
  explicit Tip(const SurfaceMesh<2>& surface) {
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
      if ((surface.vertices[v] - start).norm() < 1e-9)
        vertex = v;
    }
  }
  Point<2> displacement(const SurfaceMesh<2>& surface) const {
    return surface.vertices[vertex] - start;
  }
  Point<2> start{0.4, 0};
  std::size_t vertex = 0;
};

/// CSM1, CSM2: at rest in its own weight. Damping of half the step makes the steps those of Newton.
Point<2> sagging(int n, double youngs_modulus) {
  const double dt = 4;
  Alone<2> alone(falling_flag(n, youngs_modulus, dt / 2));
  const Tip tip(alone.solids.surface());
  Point<2> last = Point<2>::Constant(1);
  for (int i = 0; i < 100; ++i) {
    alone.step(dt);
    const Point<2> now = tip.displacement(alone.solids.surface());
    if ((now - last).norm() < 1e-9)
      break;
    last = now;
  }
  return last;
}

TEST(Beams, FlagsSagAsPublished) {
  if (world()->getSize() > 1)
    GTEST_SKIP() << "The same on several ranks, only slower.";
  struct Case {
    double youngs_modulus;
    Point<2> tip;  ///< [m]
  };
  for (const Case& c :
       {Case{1.4e6, {-7.187e-3, -66.10e-3}}, Case{5.6e6, {-0.4690e-3, -16.97e-3}}}) {
    // Linear triangles are too stiff in bending: extrapolated in the square of the spacing.
    const Point<2> coarse = sagging(4, c.youngs_modulus), fine = sagging(8, c.youngs_modulus);
    const Point<2> limit = fine + (fine - coarse) / 3;
    EXPECT_NEAR(limit.y() / c.tip.y(), 1, 0.01);
    EXPECT_NEAR(limit.x() / c.tip.x(), 1, 0.02);
    EXPECT_NEAR(fine.y() / c.tip.y(), 1, 0.05);
  }
}

}  // namespace
}  // namespace lockstep::test
