#include <random>

#include "geometry/generators.hpp"
#include "transport/box_visibility.hpp"
#include "transport_cases.hpp"

namespace lockstep::test {
namespace {

constexpr int n_cells = 16;
constexpr double h = 1. / n_cells;

/// Surfaces in a tank, asked for what random points beside them see.
template <int dim>
class Onlookers {
 public:
  explicit Onlookers(SurfaceMesh<dim> mesh, bool periodic = false)
      : grid_(cube<dim>(n_cells, periodic), alone()) {
    SolidDescription solid;
    solid.simplex_end = static_cast<int>(mesh.simplices.size());
    solid.vertex_end = static_cast<int>(mesh.vertices.size());
    snapshot_ = std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh),
                                                             std::vector<SolidDescription>{solid});
    surface_ = std::make_unique<NearbySurface<dim>>(snapshot_, grid_, 4);
  }
  const SurfaceSnapshot<dim>& snapshot() const { return *snapshot_; }

  /// Calls f(eye, sample, whether it is seen) for the samples around `n` points within a cell and a
  /// half of the surface, of all kinds, that are known without rays. Returns their number.
  template <typename Function>
  int ask(int n, const Function& f) {
    int n_known = 0;
    for (int i = 0; i < n; ++i) {
      const auto corners =
          snapshot_->corners(static_cast<int>(engine_() % snapshot_->n_simplices()));
      Point<dim> eye = corners[0];
      for (int a = 0; a < dim; ++a)
        eye[a] += 1.5 * h * (2 * share_(engine_) - 1);
      const SampleKind kind = i % (dim + 1) - 1;
      const Point<dim> x = eye / h, offset = sample_offset<dim>(kind);
      const BoxVisibility<dim>* box = surface_->visibility(kind).around(x);
      const auto seen = box ? box->seen_from(eye) : std::nullopt;
      n_known += seen.has_value();
      for (int k = 0; seen && k < 1 << dim; ++k) {
        if ((seen->unknown >> k & 1) != 0)
          continue;
        Point<dim> sample;
        for (int a = 0; a < dim; ++a)
          sample[a] = h * (std::floor(x[a] - offset[a]) + offset[a] + (k >> a & 1));
        f(eye, sample, (seen->seen >> k & 1) != 0);
      }
    }
    return n_known;
  }

 private:
  TiledGrid<dim> grid_;
  std::shared_ptr<const SurfaceSnapshot<dim>> snapshot_;
  std::unique_ptr<NearbySurface<dim>> surface_;
  std::mt19937 engine_;
  std::uniform_real_distribution<double> share_;
};

template <int dim>
SurfaceMesh<dim> moved(SurfaceMesh<dim> mesh, const Point<dim>& by) {
  for (Point<dim>& x : mesh.vertices)
    x += by;
  return mesh;
}

template <int dim>
SurfaceMesh<dim> flattened(SurfaceMesh<dim> mesh, double factor) {
  for (Point<dim>& x : mesh.vertices)
    x[dim - 1] *= factor;
  return mesh;
}

/// Off the lattice, and off the middle.
template <int dim>
Point<dim> somewhere() {
  Point<dim> x = Point<dim>::Constant(0.5);
  x[0] += 0.013;
  x[dim - 1] += 0.007;
  return x;
}

/// Outside and inside of a ball of triangles of many sizes: samples of one's own side are seen, and
/// no others.
template <int dim>
void expect_sides_of_ball(double edge) {
  Onlookers<dim> ball(moved<dim>(ball_surface<dim>(0.27, edge), somewhere<dim>()));
  const int n_known = ball.ask(20000, [&](const Point<dim>& eye, const Point<dim>& sample,
                                          bool seen) {
    ASSERT_EQ(seen, (ball.snapshot().inside(eye) >= 0) == (ball.snapshot().inside(sample) >= 0));
  });
  EXPECT_GT(n_known, 5000);
}

TEST(BoxVisibility, TellsOutsideFromInside) {
  for (const double edge : {0.2, 0.06, 0.015}) {
    expect_sides_of_ball<2>(edge);
    expect_sides_of_ball<3>(edge);
  }
}

/// A closed lens of a fifth of a cell: none of what is beyond it is seen, though the box has open
/// edges round its rim.
template <int dim>
void expect_lens_hides() {
  const double radius = 0.3, thickness = 0.2 * h;
  const Point<dim> middle = somewhere<dim>();
  Onlookers<dim> lens(moved<dim>(
      flattened<dim>(ball_surface<dim>(radius, 0.04), 0.5 * thickness / radius), middle));
  int n_across = 0;
  lens.ask(200000, [&](const Point<dim>& eye, const Point<dim>& sample, bool seen) {
    const Point<dim> from = eye - middle, to = sample - middle;
    const bool is_across = from[dim - 1] * to[dim - 1] < 0 &&
                           std::min(std::abs(from[dim - 1]), std::abs(to[dim - 1])) > thickness &&
                           lens.snapshot().first_hit(eye, sample, 0).has_value();
    n_across += is_across;
    ASSERT_FALSE(is_across && seen);
  });
  EXPECT_EQ(n_across, 0);  // a box with both of its layers is left to rays
}

TEST(BoxVisibility, IsLeftToRaysWhereALensIsThin) {
  expect_lens_hides<2>();
  expect_lens_hides<3>();
}

/// An open plate: nothing is seen through it, and what is seen round its rim only rays know.
template <int dim>
void expect_plate_hides(double angle) {
  SurfaceMesh<dim> plate = plate_surface<dim>(Point<dim>::Constant(0.5), 0, 0.07);
  for (Point<dim>& x : plate.vertices) {
    const double c = std::cos(angle), s = std::sin(angle), p = x[0], q = x[1];
    x[0] = c * p - s * q;
    x[1] = s * p + c * q;
  }
  Point<dim> normal = Point<dim>::Zero();
  normal[0] = std::cos(angle);
  normal[1] = std::sin(angle);
  const Point<dim> middle = somewhere<dim>();
  Onlookers<dim> onlookers(moved<dim>(plate, middle));
  int n_hidden = 0;
  const int n_known =
      onlookers.ask(100000, [&](const Point<dim>& eye, const Point<dim>& sample, bool seen) {
        const bool hit = onlookers.snapshot().first_hit(eye, sample, 0).has_value();
        const double height = normal.dot(eye - middle) * normal.dot(sample - middle);
        ASSERT_FALSE(seen && hit);
        ASSERT_TRUE(seen || height < 0);
        n_hidden += !seen;
      });
  EXPECT_GT(n_known, 20000);
  EXPECT_GT(n_hidden, 20000);
}

TEST(BoxVisibility, NothingIsSeenThroughAPlate) {
  for (const double angle : {0., 0.3, 0.785398}) {
    expect_plate_hides<2>(angle);
    expect_plate_hides<3>(angle);
  }
}

/// Two sheets within one box: whatever lies beyond one of them is not seen.
TEST(BoxVisibility, IsLeftToRaysBetweenTwoSheets) {
  SurfaceMesh<3> sheets = plate_surface<3>(Point<3>::Constant(0.5), 2, 0.07);
  const SurfaceMesh<3> other = sheets;
  const int n = static_cast<int>(sheets.vertices.size());
  for (const Point<3>& x : other.vertices)
    sheets.vertices.push_back(x + 0.4 * h * Point<3>::Unit(2));
  for (auto simplex : other.simplices) {
    for (int& vertex : simplex)
      vertex += n;
    sheets.simplices.push_back(simplex);
  }
  Onlookers<3> onlookers(moved<3>(sheets, somewhere<3>()));
  onlookers.ask(100000, [&](const Point<3>& eye, const Point<3>& sample, bool seen) {
    ASSERT_EQ(seen, !onlookers.snapshot().first_hit(eye, sample, 0).has_value());
  });
}

/// Beyond the last samples of a tank the last ones stand for others: what is at their place counts.
TEST(BoxVisibility, BesideSidesThePlacesOfTheLastSamplesCount) {
  const GridDescription<2> description = cube<2>(n_cells, false);
  TiledGrid<2> grid(description, alone());
  SurfaceMesh<2> line;
  line.vertices = {Point<2>(0.45 * h, -h), Point<2>(0.55 * h, 3 * h)};
  line.simplices = {{0, 1}};
  SolidDescription solid;
  solid.simplex_end = 1;
  solid.vertex_end = 2;
  NearbySurface<2> surface(std::make_shared<const SurfaceSnapshot<2>>(
                               std::move(line), std::vector<SolidDescription>{solid}),
                           grid, 4);
  // Between the line and the side: the only sample there lies on the other side of the line.
  const Point<2> x(0.2, 1);
  const auto* box = surface.visibility(cell_centers).around(x);
  ASSERT_NE(box, nullptr);
  const auto seen = box->seen_from(h * x);
  for (int k = 0; seen && k < 4; ++k) {
    const Point<2> sample(0.5 * h, (0.5 + (k >> 1)) * h);
    if ((seen->unknown >> k & 1) == 0) {
      EXPECT_EQ((seen->seen >> k & 1) != 0, !surface.first_hit(h * x, sample));
    }
  }
}

}  // namespace
}  // namespace lockstep::test
