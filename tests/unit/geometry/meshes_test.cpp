// Mesh checks, mass properties and generators against formulas.
#include <gmock/gmock.h>

#include "base/errors.hpp"
#include "geometry/mesh_repair.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/surface_parts.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;

template <typename Function>
std::string message_of(Function f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

template <int dim>
void expect_fine_and_closed(const SurfaceMesh<dim>& mesh, double spacing) {
  EXPECT_TRUE(is_closed(mesh));
  SurfaceMesh<dim> checked = mesh;
  EXPECT_NO_THROW(check_surface(checked, true, "generated"));
  EXPECT_EQ(checked.simplices, mesh.simplices);  // already outward
  for (const auto& simplex : mesh.simplices)
    for (int k = 0; k < dim; ++k)
      EXPECT_LE((mesh.vertices[simplex[k]] - mesh.vertices[simplex[(k + 1) % dim]]).norm(),
                spacing * (1 + 1e-9));
}

TEST(Generators, AreClosedOutwardAndFine) {
  expect_fine_and_closed<2>(ball_surface<2>(1, 0.2), 0.2);
  expect_fine_and_closed<2>(box_surface<2>({1, 2}, 0.3), 0.3);
  expect_fine_and_closed<2>(cylinder_surface<2>(0.5, 2, 0.3), 0.3);
  expect_fine_and_closed<2>(capsule_surface<2>(0.5, 2, 0.2), 0.2);
  expect_fine_and_closed<3>(ball_surface<3>(1, 0.2), 0.2);
  expect_fine_and_closed<3>(box_surface<3>({1, 2, 0.5}, 0.3), 0.3);
  expect_fine_and_closed<3>(cylinder_surface<3>(0.5, 2, 0.2), 0.2);
  expect_fine_and_closed<3>(capsule_surface<3>(0.5, 2, 0.2), 0.2);
  expect_fine_and_closed<3>(torus_surface<3>(1, 0.3, 0.2), 0.2);
  EXPECT_THROW(torus_surface<2>(1, 0.3, 0.2), InputError);
  EXPECT_THROW(ball_surface<3>(-1, 0.2), InputError);
  EXPECT_THROW(ball_surface<3>(1, 0), InputError);
}

TEST(Generators, OpenShells) {
  EXPECT_NEAR(shell_properties(plate_surface<3>({9, 2, 3}, 0, 0.5)).measure, 6, 1e-12);
  EXPECT_NEAR(shell_properties(plate_surface<2>({2, 9}, 1, 0.5)).measure, 2, 1e-12);
  // A boat of 1 x 2 x 3 (y up): bottom 3, sides 2 (2 + 6).
  const auto boat = open_box_surface<3>({1, 2, 3}, 0.5);
  EXPECT_NEAR(shell_properties(boat).measure, 19, 1e-12);
  EXPECT_FALSE(is_closed(boat));
  for (const auto& x : plate_surface<3>({9, 2, 3}, 0, 0.5).vertices)
    EXPECT_EQ(x[0], 0);
  EXPECT_NEAR(shell_properties(open_box_surface<2>({1, 2}, 0.5)).measure, 5, 1e-12);
}

TEST(Generators, TubesAreOpenAndFaceOutwards) {
  const auto tube = tube_surface<3>(0.5, 2, 0.1);
  EXPECT_FALSE(is_closed(tube));
  EXPECT_NEAR(shell_properties(tube).measure, 2 * pi, 0.01);
  double flux = 0, spread = 0;  // flux of the field (x, y, 0): twice the volume inside
  for (const auto& t : tube.simplices) {
    const std::array<Point<3>, 3> corners{tube.vertices[t[0]], tube.vertices[t[1]],
                                          tube.vertices[t[2]]};
    Point<3> center = (corners[0] + corners[1] + corners[2]) / 3;
    spread = std::max(spread, std::abs(center.z()));
    center.z() = 0;
    flux += area_vector<3>(corners).dot(center);
  }
  EXPECT_NEAR(flux, 2 * pi * 0.25 * 2, 1e-12);
  EXPECT_LT(spread, 1);
  auto walls = tube_surface<2>(0.5, 2, 0.3);
  EXPECT_NEAR(shell_properties(walls).measure, 4, 1e-14);
  for (const auto& s : walls.simplices) {
    const auto normal = area_vector<2>({walls.vertices[s[0]], walls.vertices[s[1]]});
    EXPECT_GT(normal.dot(walls.vertices[s[0]]), 0);
  }
  EXPECT_THROW(tube_surface<3>(1, 0, 0.1), InputError);
}

template <int dim>
void expect_open_ball(double area, double tolerance) {
  const auto shell = open_ball_surface<dim>(0.5, 0.3, 0.05);
  EXPECT_FALSE(is_closed(shell));
  EXPECT_NEAR(shell_properties(shell).measure, area, tolerance);
  int n_boundary = 0;
  for (const auto& x : shell.vertices) {
    EXPECT_NEAR(x.norm(), 0.5, 1e-14);
    EXPECT_LE(x.y(), 0.4 + 1e-14);  // sqrt(0.5^2 - 0.3^2)
    n_boundary += x.y() > 0.4 - 1e-12;
  }
  EXPECT_GE(n_boundary, dim == 2 ? 2 : 37);  // 2 pi 0.3 / 0.05
  for (const auto& s : shell.simplices) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = shell.vertices[s[k]];
    EXPECT_GT(area_vector<dim>(corners).dot(corners[0]), 0);
  }
}

TEST(Generators, OpenBallsHaveARim) {
  // The sphere without its cap: 2 pi r (r + 0.4); the arc 2 r (pi - asin 0.6).
  expect_open_ball<3>(2 * pi * 0.5 * 0.9, 0.01);
  expect_open_ball<2>(pi - std::asin(0.6), 2e-3);
  EXPECT_THROW(open_ball_surface<3>(0.5, 0.5, 0.05), InputError);
}

TEST(MassProperties, BoxIsExactWhereverItLies) {
  const Point<3> shift(100, -20, 3);
  const auto box = volume_properties(moved<3>(box_surface<3>({1, 2, 3}, 0.7), shift));
  EXPECT_NEAR(box.measure, 6, 1e-11);
  EXPECT_NEAR((box.centroid - shift).norm(), 0, 1e-11);
  const Eigen::Matrix3d expected =
      Point<3>(13, 10, 5).asDiagonal() * Eigen::Matrix3d::Identity() * 0.5;
  EXPECT_NEAR((box.inertia - expected).norm(), 0, 1e-11);
  const auto square = volume_properties(moved<2>(box_surface<2>({1, 2}, 5), {7, 8}));
  EXPECT_NEAR(square.measure, 2, 1e-12);
  EXPECT_NEAR((square.centroid - Point<2>(7, 8)).norm(), 0, 1e-12);
  EXPECT_NEAR(square.inertia(0, 0), 2 * 5 / 12.0, 1e-12);
}

TEST(MassProperties, ThinBoxShell) {
  // The shell of a unit cube: area 6; about x the sides give 4 (1/12 + 1/4) + 2/6.
  const auto shell = shell_properties(box_surface<3>({1, 1, 1}, 0.6));
  EXPECT_NEAR(shell.measure, 6, 1e-12);
  EXPECT_NEAR(shell.inertia(0, 0), 2 * (1.0 / 6) + 4 * (1.0 / 12 + 1.0 / 4), 1e-12);
  EXPECT_NEAR(shell.inertia(0, 1), 0, 1e-12);
}

TEST(MassProperties, RoundBodiesConverge) {
  EXPECT_NEAR(volume_properties(ball_surface<3>(2, 0.5)).measure, 4 / 3.0 * pi * 8, 1e-11);
  EXPECT_NEAR(volume_properties(ball_surface<2>(2, 0.5)).measure, pi * 4, 1e-12);
  EXPECT_NEAR(volume_properties(cylinder_surface<3>(1, 2, 0.3)).measure, 2 * pi, 1e-12);
  double ball[2], torus[2], capsule[2], area[2];
  for (int i = 0; i < 2; ++i) {
    const double spacing = i == 0 ? 0.2 : 0.1;
    ball[i] = volume_properties(ball_surface<3>(1, spacing)).inertia(1, 1) - 8 * pi / 15;
    torus[i] = volume_properties(torus_surface<3>(1, 0.4, spacing)).measure - 2 * pi * pi * 0.16;
    capsule[i] = volume_properties(capsule_surface<3>(1, 1, spacing)).measure - 7 * pi / 3;
    area[i] = shell_properties(ball_surface<3>(1, spacing)).measure - 4 * pi;
  }
  for (const auto& error : {torus, capsule, area}) {
    EXPECT_LT(std::abs(error[0]), 0.15);
    EXPECT_NEAR(error[0] / error[1], 4, 1);  // second order
  }
  // The vertices are scaled to the exact volume, so the inertia is off by the square of the facets'
  // depth.
  EXPECT_LT(std::abs(ball[0]), 1e-3);
  EXPECT_NEAR(ball[0] / ball[1], 16, 4);
}

TEST(CheckSurface, TurnsInwardSurfacesAround) {
  auto mesh = box_surface<3>({1, 1, 1}, 2);
  for (auto& t : mesh.simplices)
    std::swap(t[1], t[2]);
  check_surface(mesh, true, "box");
  EXPECT_NEAR(volume_properties(mesh).measure, 1, 1e-14);
}

TEST(CheckSurface, NamesTheDefect) {
  auto open = box_surface<3>({1, 1, 1}, 2);
  open.simplices.pop_back();
  EXPECT_THAT(message_of([&] { check_surface(open, true, "hull"); }),
              AllOf(HasSubstr("'hull'"), HasSubstr("1 hole, with 3 edges of one triangle only"),
                    HasSubstr("Thin Shell")));
  EXPECT_NO_THROW(check_surface(open, false, "hull"));
  auto twisted = box_surface<3>({1, 1, 1}, 2);
  std::swap(twisted.simplices[3][0], twisted.simplices[3][1]);
  EXPECT_THAT(message_of([&] { check_surface(twisted, true, "hull"); }),
              HasSubstr("oriented against each other"));
  auto flat = box_surface<2>({1, 1}, 2);
  flat.simplices.push_back({1, 1});
  EXPECT_THAT(message_of([&] { check_surface(flat, false, "hull"); }),
              AllOf(HasSubstr("1 segment is degenerate"), HasSubstr("segment 4")));
  flat.simplices.back() = {1, 9};
  EXPECT_THAT(message_of([&] { check_surface(flat, false, "hull"); }), HasSubstr("vertex 9"));
  flat.simplices.pop_back();
  flat.vertices[2].x() = std::nan("");
  EXPECT_THAT(message_of([&] { check_surface(flat, false, "hull"); }), HasSubstr("vertex 2"));
}

/// Message for a mesh as if it was read from a file.
template <int dim>
std::string message_of(SurfaceMesh<dim> mesh) {
  MeshNames names;
  names.file = "hull.obj";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    names.vertices.push_back(static_cast<long>(v) + 1);
  for (std::size_t s = 0; s < mesh.simplices.size(); ++s)
    names.simplex_lines.push_back(100 + static_cast<long>(s));
  return message_of([&] { check_surface(mesh, {"hull", true, true}, names); });
}

template <int dim>
void append(SurfaceMesh<dim>& mesh, const SurfaceMesh<dim>& other, bool inside_out = false) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto simplex : other.simplices) {
    for (int& v : simplex)
      v += first;
    if (inside_out)
      std::swap(simplex[0], simplex[1]);
    mesh.simplices.push_back(simplex);
  }
}

TEST(CheckSurface, CountsAndPlacesDefectsInTheFilesNumbers) {
  auto open = box_surface<3>({1, 1, 1}, 2);  // 12 triangles
  open.simplices.pop_back();
  open.simplices.erase(open.simplices.begin());
  append(open, moved<3>(open, {5, 0, 0}));
  EXPECT_THAT(
      message_of(open),
      AllOf(HasSubstr("'hull' (hull.obj)"), HasSubstr("2 holes, with 8 edges"),
            HasSubstr("from vertex 1 at (-0.5, -0.5, -0.5) to vertex 3 at (-0.5, 0.5, 0.5), "
                      "of the triangle of line 100"),
            HasSubstr("0.5"), HasSubstr("\"Weld\""), HasSubstr("\"Thin Shell\"")));
  auto line = box_surface<2>({1, 1}, 2);
  line.simplices.pop_back();
  EXPECT_THAT(message_of(line), HasSubstr("2 loose ends, the first vertex 2 at (-0.5, 0.5)"));
  auto twisted = box_surface<3>({1, 1, 1}, 2);
  std::swap(twisted.simplices[3][0], twisted.simplices[3][1]);
  EXPECT_THAT(message_of(twisted), AllOf(HasSubstr("3 edges whose two triangles are oriented"),
                                         HasSubstr("\"Orient\" turns them")));
}

template <int dim>
void expect_hole_is_seen() {
  const auto outer = box_surface<dim>(Point<dim>::Constant(2), 3);
  const auto inner = box_surface<dim>(Point<dim>::Constant(1), 3);
  const double right = std::pow(2, dim) - 1;
  SurfaceMesh<dim> mesh = outer;
  append(mesh, inner, true);
  EXPECT_EQ(message_of(mesh), "no error");
  SurfaceMesh<dim> wrong = outer;
  append(wrong, inner);
  EXPECT_THAT(message_of(wrong), AllOf(HasSubstr("1 of its 2 closed parts faces the wrong way"),
                                       HasSubstr("bounds a hole"), HasSubstr("\"Orient\"")));
  orient_surface(wrong);
  EXPECT_EQ(message_of(wrong), "no error");
  EXPECT_NEAR(volume_properties(wrong).measure, right, 1e-14);
  // A body in the hole faces out again; all of them inside out are turned around.
  append(wrong, box_surface<dim>(Point<dim>::Constant(0.5), 3));
  EXPECT_EQ(message_of(wrong), "no error");
  for (auto& simplex : wrong.simplices)
    std::swap(simplex[0], simplex[1]);
  check_surface(wrong, true, "hull");
  EXPECT_NEAR(volume_properties(wrong).measure, right + std::pow(0.5, dim), 1e-14);
}

TEST(CheckSurface, AHoleMustFaceIntoItself) {
  expect_hole_is_seen<2>();
  expect_hole_is_seen<3>();
}

TEST(CheckSurface, SelfCrossings) {
  SurfaceMesh<2> bow{{{0, 0}, {2, 1}, {2, 0}, {0, 1}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  EXPECT_THAT(message_of(bow),
              AllOf(HasSubstr("crosses itself in 1 pair of segments"), HasSubstr("line 100"),
                    HasSubstr("line 102"), HasSubstr("at (1, 0.5)")));
  auto boxes = box_surface<3>({1, 1, 1}, 2);
  append(boxes, moved<3>(box_surface<3>({1, 1, 1}, 2), {0.7, 0.1, 0.2}));
  EXPECT_THAT(message_of(boxes), HasSubstr("crosses itself"));
  auto apart = box_surface<3>({1, 1, 1}, 2);
  append(apart, moved<3>(box_surface<3>({1, 1, 1}, 2), {1, 0.1, 0.2}));  // they touch
  EXPECT_EQ(message_of(apart), "no error");
}

TEST(MeshRepair, WeldsTriangleSoup) {
  const auto box = box_surface<3>({1, 1, 1}, 2);
  SurfaceMesh<3> soup;
  MeshNames names;
  names.file = "soup.stl";
  for (const auto& triangle : box.simplices) {
    for (const int v : triangle) {
      names.vertices.push_back(static_cast<long>(soup.vertices.size()));
      soup.vertices.push_back(1000 * box.vertices[v] +
                              Point<3>::Constant(0.01 * (soup.vertices.size() % 3)));
    }
    const int n = static_cast<int>(soup.vertices.size());
    soup.simplices.push_back({n - 3, n - 2, n - 1});
    names.simplex_lines.push_back(7 * n);
  }
  soup.vertices.push_back(soup.vertices.front() + Point<3>(1e-3, 0, 0));
  soup.simplices.push_back({0, 36, 1});  // a sliver, which goes
  names.vertices.push_back(36);
  names.simplex_lines.push_back(1);
  MeshRepair repair;
  repair.scale = 1e-3;
  scale_and_weld(repair, soup.vertices, soup.simplices, names);
  EXPECT_FALSE(is_closed(soup));
  repair.scale = 1;
  repair.weld = 1e-4;
  scale_and_weld(repair, soup.vertices, soup.simplices, names);
  EXPECT_TRUE(is_closed(soup));
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_EQ(names.vertices.size(), 8u);
  EXPECT_EQ(names.simplex_lines.size(), 12u);
  EXPECT_NEAR(volume_properties(soup).measure, 1, 1e-3);
  repair.weld = 10;
  EXPECT_THAT(message_of([&] { scale_and_weld(repair, soup.vertices, soup.simplices, names); }),
              HasSubstr("\"Weld\""));
}

TEST(MeshRepair, OrientsWhatIsMixed) {
  auto ball = ball_surface<3>(1, 0.5);
  const double volume = volume_properties(ball).measure;
  std::mt19937 random(3);
  for (auto& triangle : ball.simplices)
    if (random() % 2)
      std::swap(triangle[1], triangle[2]);
  orient_surface(ball);
  EXPECT_TRUE(is_closed(ball));
  EXPECT_NEAR(volume_properties(ball).measure, volume, 1e-12);
}

}  // namespace
}  // namespace lockstep::test
