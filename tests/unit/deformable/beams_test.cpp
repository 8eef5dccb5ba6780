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

/// Sag of the tip of a cantilever ten times as long as thick over that of Timoshenko's beam, for
/// elements of a scene's default size or of `spacing`. The grid's is the thickness, 0.1.
template <int dim>
double sag_of_beam(const std::string& spacing = "") {
  const double youngs_modulus = 1e3, gravity = 1e-3;
  const std::string across = dim == 2 ? "0.1" : "0.1, 0.1";
  const std::string geometry_of_beam =
      geometry("box", numbers("Size", "1, " + across) +
                          (spacing.empty() ? "" : number("Mesh Spacing", spacing)));
  const std::string beyond = dim == 2 ? "1" : "1, 1", before = dim == 2 ? "-1" : "-1, -1";
  Point<dim> down = Point<dim>::Zero();
  down[1] = -gravity;
  Alone<dim> alone(
      model<dim>({geometry_of_beam + material("linear", "1000", "0") + number("Density", "1") +
                  text("Time Integration", "fully-implicit") +
                  pinned("-1, " + before, "-0.499, " + beyond, dim == 2 ? "x, y" : "x, y, z")},
                 down));
  alone.step(1e4);  // Fully implicit steps damp: it is at rest after one of 1e4 s.
  double lowest = 0;
  for (const Point<dim>& x : alone.solids.surface().vertices)
    lowest = std::min(lowest, x.y() + 0.05);
  const double bending = 1.5 * gravity / (youngs_modulus * 0.01);  // L = 1, density 1
  const double shear = gravity / (2 * 5. / 6 * youngs_modulus / 2);
  return -lowest / (bending + shear);
}

/// The figures of docs/parameters and of --explain. A mesh as fine as the grid would be of no use.
TEST(Beams, BendTheMoreTheMoreElementsAreAcross) {
  if (world()->getSize() > 1)
    GTEST_SKIP() << "The same on several ranks, only slower.";
  EXPECT_NEAR(1 / sag_of_beam<2>("0.1"), 4, 0.02);
  EXPECT_NEAR(1 / sag_of_beam<2>("0.05"), 1.75, 0.02);
  EXPECT_NEAR(1 / sag_of_beam<2>("0.025"), 1.19, 0.01);
  EXPECT_NEAR(1 / sag_of_beam<2>("0.0125"), 1.05, 0.01);
  EXPECT_NEAR(1 / sag_of_beam<3>("0.05"), 1.74, 0.02);
  EXPECT_NEAR(1 / sag_of_beam<2>(), 1.05, 0.01);
  EXPECT_NEAR(1 / sag_of_beam<3>(), 1.18, 0.01);
}

}  // namespace
}  // namespace lockstep::test
