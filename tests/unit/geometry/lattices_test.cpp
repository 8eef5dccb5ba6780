// Crossings of lattice lines, inside tests, clipping and volumes in boxes.
#include <set>

#include "geometry/clipping.hpp"
#include "geometry/solid_volume.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Index<dim> uniform_index(int value) {
  Index<dim> index;
  index.fill(value);
  return index;
}

/// Every line alternates between entering and leaving, the crossings lie where they claim to lie,
/// and the parity at every cell centre agrees with inside().
template <int dim>
void expect_consistent(const SurfaceSnapshot<dim>& surface, const Lattice<dim>& lattice, int n) {
  const auto crossings =
      surface.cross_lattice(lattice, uniform_index<dim>(0), uniform_index<dim>(n));
  std::array<std::set<Index<dim>>, dim> marked;
  for (int axis = 0; axis < dim; ++axis) {
    for (const auto& line : crossings.lines[axis]) {
      ASSERT_EQ(line.crossings.size() % 2, 0u);
      int balance = 0;
      for (const auto& crossing : line.crossings) {
        balance += crossing.entering ? 1 : -1;
        Point<dim> x = Point<dim>::Zero(), expected = lattice.center(line.cell);
        for (int k = 0; k < dim; ++k)
          x += crossing.barycentric[k] * surface.corners(crossing.simplex)[k];
        expected[axis] = crossing.coordinate;
        ASSERT_NEAR((x - expected).norm(), 0, 1e-13);
        ASSERT_NEAR(crossing.barycentric.sum(), 1, 1e-14);
        ASSERT_GE(crossing.barycentric.minCoeff(), 0);
      }
      ASSERT_EQ(balance, 0);
      Index<dim> cell = line.cell;
      for (cell[axis] = 0; cell[axis] < n; ++cell[axis]) {
        int passed = 0;
        for (const auto& crossing : line.crossings)
          passed += crossing.coordinate <= lattice.center(cell)[axis];
        if (passed % 2 == 1)
          marked[axis].insert(cell);
      }
    }
  }
  int n_inside = 0;
  Index<dim> cell{};
  for (int i = 0; i < std::pow(n, dim); ++i) {
    int rest = i;
    for (int a = 0; a < dim; ++a, rest /= n)
      cell[a] = rest % n;
    const bool inside = surface.inside(lattice.center(cell)) >= 0;
    n_inside += inside;
    ASSERT_EQ(inside, marked[0].count(cell) == 1);
  }
  EXPECT_GT(n_inside, 0);
  for (int axis = 1; axis < dim; ++axis)
    EXPECT_EQ(marked[axis], marked[0]) << "axis " << axis;
}

TEST(CrossLattice, RotatedBallsAreWatertight) {
  for (int i = 0; i < 5; ++i) {
    expect_consistent<3>(snapshot<3>({moved<3>(ball_surface<3>(1, 0.15), {.01 * i, 0, .02}, i)}),
                         {Point<3>::Constant(-1.2), 0.1}, 24);
    expect_consistent<2>(snapshot<2>({moved<2>(ball_surface<2>(1, 0.15), {.01 * i, 0}, i)}),
                         {Point<2>::Constant(-1.2), 0.1}, 24);
  }
}

TEST(CrossLattice, PointsOnFacesEdgesAndVertices) {
  // Cell centres at multiples of 1/4: all faces, edges and vertices of the unit box are hit
  // exactly. Half-open: 4^dim centres are inside.
  const auto box3 = snapshot<3>({box_surface<3>({1, 1, 1}, 0.4)});
  expect_consistent<3>(box3, {Point<3>::Constant(-1.125), 0.25}, 9);
  const auto crossings =
      box3.cross_lattice({Point<3>::Constant(-1.125), 0.25}, {0, 0, 0}, {9, 9, 9});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(crossings.lines[axis].size(), 16u);
    for (const auto& line : crossings.lines[axis]) {
      ASSERT_EQ(line.crossings.size(), 2u);
      EXPECT_EQ(line.crossings[0].coordinate, -0.5);
      EXPECT_TRUE(line.crossings[0].entering);
      EXPECT_EQ(line.crossings[1].coordinate, 0.5);
    }
  }
  expect_consistent<2>(snapshot<2>({box_surface<2>({1, 1}, 0.3)}),
                       {Point<2>::Constant(-1.125), 0.25}, 9);
}

TEST(CrossLattice, VerticesOfAnOctahedronOnTheLattice) {
  SurfaceMesh<3> octahedron;
  octahedron.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  octahedron.simplices = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const auto surface = snapshot<3>({octahedron});
  const auto crossings =
      surface.cross_lattice({Point<3>::Constant(-1.25), 0.5}, {0, 0, 0}, {5, 5, 5});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_FALSE(crossings.lines[axis].empty());
    for (const auto& line : crossings.lines[axis])
      EXPECT_EQ(line.crossings.size() % 2, 0u);
  }
}

TEST(CrossLattice, LinesOutsideTheWantedCellsAreLeftOut) {
  const auto surface = snapshot<3>({box_surface<3>({1, 1, 1}, 2)});
  const auto crossings = surface.cross_lattice({Point<3>::Zero(), 0.2}, {0, 1, 0}, {2, 2, 2});
  EXPECT_EQ(crossings.lines[0].size(), 2u);  // y = 0.3; z = 0.1, 0.3
  EXPECT_EQ(crossings.lines[0][1].cell, (Index<3>{0, 1, 1}));
  EXPECT_EQ(crossings.lines[0][1].crossings[0].coordinate, -0.5);  // the whole line is listed
  EXPECT_EQ(crossings.lines[1].size(), 4u);
}

TEST(Inside, AgreesWithTheBall) {
  const auto surface = snapshot<3>({moved<3>(ball_surface<3>(1, 0.1), {5, 5, 5}),
                                    moved<3>(ball_surface<3>(1, 0.1), {1, 2, 3}, 1)});
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> random(-1.3, 1.3);
  for (int i = 0; i < 3000; ++i) {
    const Point<3> x(random(generator), random(generator), random(generator));
    if (std::abs(x.norm() - 1) < 0.01)
      continue;
    EXPECT_EQ(surface.inside(x + Point<3>(1, 2, 3)), x.norm() < 1 ? 1 : -1);
  }
  EXPECT_EQ(snapshot<3>({ball_surface<3>(1, 0.3)}, false).inside({0, 0, 0}), -1);  // a shell
}

template <int dim>
double clipped_sum(const std::array<Point<dim>, dim>& corners, double h, Point<dim>& moment) {
  double sum = 0;
  moment.setZero();
  for (int i = 0; i < std::pow(8, dim); ++i) {
    int rest = i;
    Point<dim> lower;
    for (int a = 0; a < dim; ++a, rest /= 8)
      lower[a] = h * (rest % 8 - 4);
    const auto part = clip_to_box<dim>(corners, {lower, lower + Point<dim>::Constant(h)});
    sum += part.measure;
    moment += part.measure * part.centroid;
    if (part.measure > 0) {
      EXPECT_NEAR(part.barycentric.sum(), 1, 1e-14);
    }
  }
  return sum;
}

template <int dim>
void expect_partition_of_unity() {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> random(-1, 1);
  for (int i = 0; i < 30; ++i) {
    std::array<Point<dim>, dim> corners;
    Point<dim> mean = Point<dim>::Zero(), moment;
    for (auto& corner : corners) {
      for (int a = 0; a < dim; ++a)
        corner[a] = random(generator);
      mean += corner / dim;
    }
    const double area = area_vector<dim>(corners).norm();
    EXPECT_NEAR(clipped_sum<dim>(corners, 0.25, moment) / area, 1, 1e-13);
    EXPECT_NEAR((moment / area - mean).norm(), 0, 1e-13);
  }
}

TEST(Clipping, PartsOfALatticeSumToTheSimplex) {
  expect_partition_of_unity<2>();
  expect_partition_of_unity<3>();
}

TEST(Clipping, ByHand) {
  // The right triangle (0,0) (1,0) (0,1) at z = 1/2 in the lower quarter: a square less nothing.
  const std::array<Point<3>, 3> triangle{{{0, 0, .5}, {1, 0, .5}, {0, 1, .5}}};
  auto part = clip_to_box<3>(triangle, {Point<3>(0, 0, 0), Point<3>(.5, .5, 1)});
  EXPECT_NEAR(part.measure, 0.25, 1e-15);
  EXPECT_NEAR((part.centroid - Point<3>(.25, .25, .5)).norm(), 0, 1e-15);
  EXPECT_NEAR((part.barycentric - Barycentric<3>(.5, .25, .25)).norm(), 0, 1e-15);
  EXPECT_EQ(clip_to_box<3>(triangle, {Point<3>(0, 0, .6), Point<3>(1, 1, 1)}).measure, 0);
  part = clip_to_box<3>({{{0, 0, .5}, {1, 0, .5}, {.5, 0, .5}}},
                        {Point<3>(0, 0, 0), Point<3>(1, 1, 1)});
  EXPECT_EQ(part.measure, 0);
  EXPECT_TRUE(part.barycentric.allFinite());
  const auto half = clip_to_box<2>({{{0, 0}, {2, 2}}}, {Point<2>(-1, -1), Point<2>(1, 3)});
  EXPECT_NEAR(half.measure, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(half.barycentric[0], 0.75, 1e-15);
}

template <int dim>
double volume_over_lattice(const SurfaceSnapshot<dim>& surface, double lower, double h, int n) {
  double sum = 0;
  for (int i = 0; i < std::pow(n, dim); ++i) {
    int rest = i;
    Point<dim> corner;
    for (int a = 0; a < dim; ++a, rest /= n)
      corner[a] = lower + h * (rest % n);
    const double volume =
        solid_volume_in_box<dim>(surface, {corner, corner + Point<dim>::Constant(h)});
    EXPECT_LE(volume, std::pow(h, dim) * (1 + 1e-14));
    sum += volume;
  }
  return sum;
}

TEST(SolidVolume, SumsToTheSolid) {
  EXPECT_NEAR(volume_over_lattice<3>(
                  snapshot<3>({moved<3>(ball_surface<3>(1, .2), {0, .03, 0}, 1)}), -1.2, 0.16, 15),
              4 * pi / 3, 1e-12);
  EXPECT_NEAR(volume_over_lattice<2>(snapshot<2>({moved<2>(ball_surface<2>(1, .2), {0, .03}, 1)}),
                                     -1.2, 0.16, 15),
              pi, 1e-12);
  // Faces that lie exactly on lattice planes, and a body with a hole.
  EXPECT_NEAR(volume_over_lattice<3>(snapshot<3>({box_surface<3>({1, 1, 1}, .3)}), -1, .25, 8), 1,
              1e-13);
  const auto torus = torus_surface<3>(1, 0.3, 0.2);
  EXPECT_NEAR(volume_over_lattice<3>(snapshot<3>({torus}), -1.5, 0.3, 10),
              volume_properties(torus).measure, 1e-12);
}

// Against the sums over the cells of a lattice, a route of its own.
TEST(SolidVolume, PartInABox) {
  const auto ball = snapshot<3>({moved<3>(ball_surface<3>(0.7, 0.2), {0.1, 0.2, -0.1}, 1)});
  const Box<3> all(Point<3>(-2, -2, -2), Point<3>(2, 2, 2)),
      corner(Point<3>(-1, 0, -0.3), Point<3>(0.3, 0.45, 2));
  const MassProperties<3> whole = volume_properties<3>(ball.mesh_of_solid(0));
  EXPECT_DOUBLE_EQ(part_of_solid<3>(ball, 0, all).volume, whole.measure);
  EXPECT_EQ(part_of_solid<3>(ball, 0, Box<3>(Point<3>(1, -2, -2), Point<3>(2, 2, 2))).volume, 0);
  const PartOfSolid<3> part = part_of_solid<3>(ball, 0, corner);
  EXPECT_NEAR(part.volume, solid_volume_in_box<3>(ball, corner), 1e-13);
  // Two halves make the whole, with their moments.
  for (int a = 0; a < 3; ++a) {
    Box<3> lower = all, upper = all;
    lower.max()[a] = upper.min()[a] = 0.17;
    const PartOfSolid<3> l = part_of_solid<3>(ball, 0, lower), u = part_of_solid<3>(ball, 0, upper);
    EXPECT_NEAR(l.volume + u.volume, whole.measure, 1e-13);
    const Point<3> moment = l.volume * l.centroid + u.volume * u.centroid;
    EXPECT_LT((moment - whole.measure * whole.centroid).norm(), 1e-13);
  }
  // A quarter of a square by hand.
  const auto square = snapshot<2>({box_surface<2>({2, 2}, 0.5)});
  const PartOfSolid<2> quarter =
      part_of_solid<2>(square, 0, Box<2>(Point<2>(0.25, -5), Point<2>(0.75, 0.5)));
  EXPECT_NEAR(quarter.volume, 0.5 * 1.5, 1e-14);
  EXPECT_LT((quarter.centroid - Point<2>(0.5, -0.25)).norm(), 1e-14);
}

TEST(SolidVolume, HalfCutBoxes) {
  const auto box = snapshot<3>({box_surface<3>({1, 1, 1}, 0.4)});
  const auto in_box = [&](const Point<3>& lower, const Point<3>& upper) {
    return solid_volume_in_box<3>(box, {lower, upper});
  };
  EXPECT_NEAR(in_box({0.4, 0, 0}, {0.6, .2, .2}), 0.004, 1e-15);    // half inside along x
  EXPECT_NEAR(in_box({0, -.6, 0}, {.2, -.4, .2}), 0.004, 1e-15);    // part along y, below
  EXPECT_NEAR(in_box({.4, .4, .4}, {.6, .6, .6}), 0.001, 1e-15);    // a corner
  EXPECT_NEAR(in_box({-.1, -.1, -.1}, {.1, .1, .1}), .008, 1e-15);  // far inside
  EXPECT_NEAR(in_box({-2, -2, -2}, {2, 2, 2}), 1, 1e-14);           // all of it
  EXPECT_EQ(in_box({.5, 0, 0}, {.7, .2, .2}), 0);                   // touching from outside
  EXPECT_NEAR(in_box({.3, 0, 0}, {.5, .2, .2}), 0.008, 1e-15);      // touching from inside
  EXPECT_NEAR(in_box({.3, 0, 0}, {.5, .7, .2}), 0.02, 1e-15);       // part cut across
  EXPECT_EQ(in_box({3, 0, 0}, {4, 1, 1}), 0);
  const auto shell = snapshot<3>({box_surface<3>({1, 1, 1}, 0.4)}, false);
  EXPECT_EQ(solid_volume_in_box<3>(shell, {Point<3>(0, 0, 0), Point<3>(1, 1, 1)}), 0);
  const auto twice = snapshot<2>({box_surface<2>({1, 1}, 2), box_surface<2>({1, 1}, 2)});
  EXPECT_EQ(solid_volume_in_box<2>(twice, {Point<2>(-.1, -.1), Point<2>(.1, .1)}), .2 * .2);
}

}  // namespace
}  // namespace lockstep::test
