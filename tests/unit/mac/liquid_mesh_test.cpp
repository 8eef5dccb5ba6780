// The surface of a liquid as frames show it: closed, of the right size, the same on any number of
// ranks.
#include "liquid/surface/liquid_mesh.hpp"

#include <gtest/gtest.h>

#include <Teuchos_DefaultSerialComm.hpp>

#include "mac_cases.hpp"

namespace lockstep::test {
namespace {

struct Totals {
  double volume = 0, area = 0, unclosed = 0;
  GlobalIndex n_simplices = 0;
  int euler_number = 0;  ///< number for a mesh of triangles that is whole on one rank
};

/// Totals of the surface where a distance is 0, in n^dim cells of the unit box.
template <int dim>
Totals measure(int n, const std::function<double(const Point<dim>&)>& distance,
               const Communicator& comm) {
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  validate(scene.fluid, mac_parameters<dim>(), Source{"test", {}}, "Fluid");
  validate(scene.domain, domain_parameters<dim>(), Source{"test", {}}, "Domain");
  const MacFluid<dim> fluid(scene.fluid, scene.domain, comm);
  const TiledGrid<dim>& grid = fluid.domain().grid;
  CellField phi(grid.n_stored_cells());
  grid.for_each_stored_cell([&](int cell) { phi[cell] = distance(grid.center(cell)); });
  const SurfaceMesh<dim> mesh = liquid_mesh<dim>(fluid.domain(), phi);
  double volume = 0, area = 0;
  Point<dim> sum = Point<dim>::Zero();
  for (const auto& simplex : mesh.simplices) {
    std::array<Point<dim>, dim> corners;
    Point<dim> middle = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k) {
      corners[k] = mesh.vertices[simplex[k]];
      middle += corners[k] / dim;
    }
    const Point<dim> normal = area_vector<dim>(corners);
    volume += normal.dot(middle) / dim;
    area += normal.norm();
    sum += normal;
  }
  Totals totals;
  totals.volume = sum_all(comm, volume);
  totals.area = sum_all(comm, area);
  for (int a = 0; a < dim; ++a)
    totals.unclosed = std::max(totals.unclosed, std::abs(sum_all(comm, sum[a])));
  const auto n_simplices = static_cast<GlobalIndex>(mesh.simplices.size());
  totals.n_simplices = sum_all(comm, n_simplices);
  if (comm->getSize() == 1) {
    EXPECT_TRUE(is_closed<dim>(mesh));
    totals.euler_number =
        static_cast<int>(mesh.vertices.size()) - static_cast<int>(n_simplices) / 2;
  }
  return totals;
}

template <int dim>
Totals expect_same_on_all_ranks(int n, const std::function<double(const Point<dim>&)>& distance) {
  const Communicator alone = Teuchos::rcp(new Teuchos::SerialComm<int>);
  const Totals whole = measure<dim>(n, distance, alone), parts = measure<dim>(n, distance, world());
  EXPECT_EQ(parts.n_simplices, whole.n_simplices);
  EXPECT_NEAR(parts.volume, whole.volume, 1e-13);
  EXPECT_NEAR(parts.area, whole.area, 1e-12);
  EXPECT_LT(parts.unclosed, 1e-13);
  return whole;
}

}  // namespace

TEST(LiquidMesh, ABallIsClosedAndAsLargeAsItIs) {
  const Point<3> center(0.5, 0.493, 0.507);
  const double radius = 16.0 / 40;
  const Totals ball = expect_same_on_all_ranks<3>(
      40, [&](const Point<3>& x) { return (x - center).norm() - radius; });
  EXPECT_EQ(ball.euler_number, 2);
  EXPECT_NEAR(ball.volume / (4.0 / 3 * M_PI * std::pow(radius, 3)), 1, 0.01);
  EXPECT_NEAR(ball.area / (4 * M_PI * radius * radius), 1, 0.01);
}

TEST(LiquidMesh, APoolIsClosedAlongTheWalls) {
  const Totals plane =
      expect_same_on_all_ranks<2>(24, [](const Point<2>& x) { return x.y() - 0.47; });
  EXPECT_NEAR(plane.volume, 0.47, 0.01 * 0.47);
  const Totals space =
      expect_same_on_all_ranks<3>(24, [](const Point<3>& x) { return x.y() - 0.47; });
  EXPECT_EQ(space.euler_number, 2);
  EXPECT_NEAR(space.volume, 0.47, 0.015 * 0.47);  // edges along the walls are bevelled
}

/// A ring of water has a hole.
TEST(LiquidMesh, ARingHasAHole) {
  const Totals ring = expect_same_on_all_ranks<3>(24, [](const Point<3>& x) {
    const Point<3> from = x - Point<3>(0.5, 0.5, 0.5);
    return std::hypot(std::hypot(from.x(), from.y()) - 0.3, from.z()) - 0.12;
  });
  EXPECT_EQ(ring.euler_number, 0);
}

}  // namespace lockstep::test
