#include <algorithm>
#include <random>

#include "geometry/generators.hpp"
#include "transport/nearby_surface.hpp"
#include "transport_cases.hpp"

namespace lockstep::test {
namespace {

/// A tank of 16 cells along each axis, one of which is periodic, with a ball that reaches out of it
/// there.
template <int dim>
struct BallInTank {
  explicit BallInTank(double edge) {
    SurfaceMesh<dim> mesh = ball_surface<dim>(0.21, edge);
    for (Point<dim>& x : mesh.vertices) {
      x += Point<dim>::Constant(0.5);
      x[0] += 0.43;
    }
    SolidDescription solid;
    solid.vertex_end = static_cast<int>(mesh.vertices.size());
    SurfaceMesh<dim> part = mesh;
    part.simplices.clear();
    for (const auto& simplex : mesh.simplices)
      if (std::any_of(simplex.begin(), simplex.end(),
                      [&](int vertex) { return mesh.vertices[vertex][0] < 1; }))
        part.simplices.push_back(simplex);
    EXPECT_LT(part.simplices.size(), mesh.simplices.size());
    const auto snapshot_of = [](SurfaceMesh<dim> triangles, SolidDescription body) {
      body.simplex_end = static_cast<int>(triangles.simplices.size());
      return std::make_shared<const SurfaceSnapshot<dim>>(std::move(triangles),
                                                          std::vector<SolidDescription>{body});
    };
    snapshot = snapshot_of(std::move(mesh), solid);
    inside = snapshot_of(std::move(part), solid);
    GridDescription<dim> description = cube<dim>(16, false);
    description.periodic[0] = true;
    description.store_upper_face[0] = false;
    grid.emplace(description, alone());
    surface.emplace(snapshot, *grid, 6);
  }
  Point<dim> random_point(double lower, double upper) {
    std::uniform_real_distribution<double> place(lower, upper);
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = place(engine);
    return x;
  }
  /// The surface in an image: images below have nothing that lies beyond the upper side.
  const SurfaceSnapshot<dim>& image_of(int image) const { return image < 0 ? *inside : *snapshot; }
  /// All images that matter, one by one.
  std::optional<SurfacePoint<dim>> expected_hit(const Point<dim>& a, const Point<dim>& b) const {
    std::optional<SurfacePoint<dim>> first;
    for (int image = -2; image <= 2; ++image) {
      const Point<dim> shift = image * Point<dim>::Unit(0);
      const auto hit = image_of(image).first_hit(a - shift, b - shift, surface->tolerance());
      if (hit && (!first || hit->fraction < first->fraction))
        first = hit;
    }
    return first;
  }
  bool expected_touch(const Box<dim>& box) const {
    bool touches = false;
    for (int image = -2; image <= 2; ++image) {
      const Point<dim> shift = image * Point<dim>::Unit(0);
      touches = touches || image_of(image).touches(Box<dim>(box.min() - shift, box.max() - shift));
    }
    return touches;
  }

  std::mt19937 engine;
  std::shared_ptr<const SurfaceSnapshot<dim>> snapshot, inside;
  std::optional<TiledGrid<dim>> grid;
  std::optional<NearbySurface<dim>> surface;
};

template <int dim>
void expect_equal(const std::optional<SurfacePoint<dim>>& hit,
                  const std::optional<SurfacePoint<dim>>& expected) {
  ASSERT_EQ(hit.has_value(), expected.has_value());
  if (!hit)
    return;
  EXPECT_NEAR(hit->fraction, expected->fraction, 1e-9);
  EXPECT_LE((hit->position - expected->position).norm(), 1e-9);
}

/// Simplices of several cells, of less than one and of a twentieth: bins of all sizes.
constexpr double edges[] = {0.2, 0.04, 0.004};

template <int dim>
void expect_first_hits(double edge) {
  BallInTank<dim> tank(dim == 3 ? std::max(edge, 0.008) : edge);
  int n_hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Point<dim> a = tank.random_point(-0.3, 1.3);
    const double reach = i % 4 == 0 ? 0.8 : 0.1;
    const Point<dim> b = a + tank.random_point(-reach, reach);
    const Box<dim> box(a.cwiseMin(b), a.cwiseMax(b));
    if (!tank.surface->reached().contains(box))
      continue;
    const auto hit = tank.surface->first_hit(a, b);
    expect_equal<dim>(hit, tank.expected_hit(a, b));
    n_hits += hit.has_value();
    if (hit) {
      const auto corners = tank.snapshot->corners(hit->simplex);
      Point<dim> x = -hit->position;
      for (int k = 0; k < dim; ++k)
        x += hit->barycentric[k] * corners[k];
      EXPECT_LE(x.norm(), 1e-9);
    }
    EXPECT_TRUE(!hit || !tank.surface->clear(box));
    EXPECT_EQ(tank.surface->touches(box), tank.expected_touch(box));
  }
  EXPECT_GT(n_hits, 20);
}

TEST(NearbySurface, FindsTheFirstHitOfAnySegment) {
  for (const double edge : edges) {
    expect_first_hits<2>(edge);
    expect_first_hits<3>(edge);
  }
}

/// Around all corners at once or one by one: the same. Now and then the eye lies on a corner, or
/// beside it by less than the tolerance.
template <int dim>
void expect_all_around(double edge) {
  BallInTank<dim> tank(dim == 3 ? std::max(edge, 0.008) : edge);
  int n_hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Point<dim> lower = tank.random_point(0.2, 1.1);
    const Box<dim> box(lower, lower + Point<dim>::Constant(1. / 16));
    Point<dim> eye = lower + tank.random_point(0, 1. / 16);
    if (i % 10 == 0)
      eye = i % 20 == 0 ? lower : Point<dim>(lower + Point<dim>::Constant(1e-8));
    typename NearbySurface<dim>::Corners corners;
    typename NearbySurface<dim>::Hits hits;
    std::array<Point<dim>, 1 << dim> places;
    for (int k = 0; k < 1 << dim; ++k)
      for (int a = 0; a < dim; ++a)
        corners[a][k] = places[k][a] = (k >> a & 1) != 0 ? box.max()[a] : box.min()[a];
    tank.surface->look_around(eye, box, corners, hits);
    for (int k = 0; k < 1 << dim; ++k) {
      expect_equal<dim>(hits[k], tank.surface->first_hit(eye, places[k]));
      n_hits += hits[k].has_value();
    }
  }
  EXPECT_GT(n_hits, 50);
}

TEST(NearbySurface, LooksAroundAsItLooksAtOneCorner) {
  for (const double edge : edges) {
    expect_all_around<2>(edge);
    expect_all_around<3>(edge);
  }
}

/// Through an edge that two simplices share, but for round-off: it is always the same one.
TEST(NearbySurface, AnEdgeIsThatOfTheFirstOfItsSimplices) {
  BallInTank<3> tank(0.04);
  const Point<3> center(0.93, 0.5, 0.5);
  int n_edges = 0;
  for (int s = 0; s < tank.snapshot->n_simplices(); ++s) {
    const auto corners = tank.snapshot->corners(s);
    const Point<3> middle = 0.5 * (corners[0] + corners[1]);
    if (!tank.surface->reached().contains(middle) || middle[0] > 0.95)
      continue;
    ++n_edges;
    const Point<3> out = (middle - center).normalized();
    const Point<3> beside = 1e-12 * out.cross(corners[1] - corners[0]).normalized();
    std::vector<int> found;
    for (const double side : {-1., 1.}) {
      const Point<3> a = middle + 0.02 * out + side * beside, b = a - 0.04 * out;
      const auto hit = tank.surface->first_hit(a, b);
      ASSERT_TRUE(hit);
      found.push_back(hit->simplex);
      NearbySurface<3>::Corners places;
      NearbySurface<3>::Hits hits;
      for (int axis = 0; axis < 3; ++axis)
        places[axis].setConstant(b[axis]);
      tank.surface->look_around(a, Box<3>(a.cwiseMin(b), a.cwiseMax(b)), places, hits);
      ASSERT_TRUE(hits[0]);
      found.push_back(hits[0]->simplex);
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), found[0]), 4);
    EXPECT_LE(found[0], s);
  }
  EXPECT_GT(n_edges, 50);
}

/// A point on the surface is hidden from itself, whichever question is asked.
TEST(NearbySurface, APointOnTheSurfaceIsHidden) {
  BallInTank<3> tank(0.04);
  for (int s = 0; s < tank.snapshot->n_simplices(); s += 7) {
    const auto corners = tank.snapshot->corners(s);
    const Point<3> eye = (corners[0] + corners[1] + corners[2]) / 3;
    EXPECT_TRUE(tank.surface->first_hit(eye, eye));
    const Point<3> beside = eye + 1e-9 * Point<3>::Unit(s % 3);
    EXPECT_TRUE(tank.surface->first_hit(eye, beside));
    NearbySurface<3>::Corners places;
    for (int a = 0; a < 3; ++a)
      places[a].setConstant(beside[a]);
    NearbySurface<3>::Hits hits;
    tank.surface->look_around(eye, widened<3>(Box<3>(eye), 1e-3), places, hits);
    for (const auto& hit : hits)
      EXPECT_TRUE(hit);
  }
}

TEST(KeptSurface, IsMadeAnewForAnotherSurfaceOrALongerReach) {
  BallInTank<2> tank(0.04), other(0.04);
  KeptSurface<2> kept;
  const auto first = kept.of(tank.snapshot, *tank.grid, 3);
  EXPECT_EQ(kept.of(tank.snapshot, *tank.grid, 2), first);
  const auto second = kept.of(tank.snapshot, *tank.grid, 4);
  EXPECT_NE(second, first);
  const auto third = kept.of(other.snapshot, *tank.grid, 2);
  EXPECT_NE(third, second);
  // The last reach is likely to come again, and was thought of.
  EXPECT_EQ(kept.of(other.snapshot, *tank.grid, 4), third);
  EXPECT_TRUE(kept.of(nullptr, *tank.grid, 1)->empty());
}

}  // namespace
}  // namespace lockstep::test
