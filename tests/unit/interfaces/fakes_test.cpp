// The fake partners keep the promises of the interfaces, so that tests can lean on them.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>

#include "conformance/fake_fluid.hpp"
#include "conformance/fake_solid.hpp"
#include "linear/symmetry_check.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

/// Every blocked face couples.
template <int dim>
struct Blocked : OpenFractionRule<dim> {
  double open_fraction(const ControlVolume<dim>& volume, bool blocked,
                       const SurfaceSnapshot<dim>&) const override {
    const auto& [below, above] = volume.sides;
    return blocked || (below.kind == SideKind::solid) != (above.kind == SideKind::solid) ? 0 : 1;
  }
};

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> no_surface() {
  return std::make_shared<const SurfaceSnapshot<dim>>(SurfaceMesh<dim>(),
                                                      std::vector<SolidDescription>());
}

template <int dim>
FakeBox<dim> open_box() {
  FakeBox<dim> box;
  box.n_cells.fill(3);
  box.n_cells[0] = 4;
  box.spacing = 0.5;
  box.density = 2;
  box.open_axis = dim - 1;
  box.gravity = Point<dim>::Unit(dim - 1) * -10;
  return box;
}

}  // namespace

template <int dim>
void check_divergence_and_projection_agree() {
  FakeFluid<dim> fluid(open_box<dim>(), Tpetra::getDefaultComm());
  fluid.set_geometry(no_surface<dim>(), Blocked<dim>());
  fluid.set_velocity([](int axis, const Point<dim>& x) { return axis + x.squaredNorm(); });
  const Momentum<dim> start = fluid.momentum();
  const auto before = make_vector(fluid.pressure_map()), after = make_vector(fluid.pressure_map());
  const auto pressure = make_vector(fluid.pressure_map());
  fluid.divergence(*before);
  pseudo_random(*pressure, 5);
  fluid.project(*pressure);
  fluid.divergence(*after);
  // V G^T (u* - G p̂ / rho) = V G^T u* - A p̂
  apply(*fluid.pressure_block(), *pressure, *before, -1, 1);
  EXPECT_LT((dense(*before) - dense(*after)).norm(), 1e-13);
  // The gain of the free faces came from the walls.
  Momentum<dim> gained = fluid.momentum() - start;
  gained -= fluid.boundary_pressure_impulse(*pressure);
  EXPECT_LT(gained.linear.norm(), 1e-13);
  EXPECT_LT(gained.angular.norm(), 1e-13);
}

TEST(FakeFluid, DivergenceAndProjectionAgree2d) {
  check_divergence_and_projection_agree<2>();
}
TEST(FakeFluid, DivergenceAndProjectionAgree3d) {
  check_divergence_and_projection_agree<3>();
}

TEST(FakeFluid, HydrostaticPressureHoldsGravity) {
  FakeFluid<2> fluid(open_box<2>(), Tpetra::getDefaultComm());
  fluid.set_geometry(no_surface<2>(), Blocked<2>());
  const Momentum<2> impulse = fluid.add_forces(0, 0.1).impulse;
  // Free upright faces: 4 columns of 2 whole dual cells and the open half: 10 dual cells of 0.5 kg.
  EXPECT_NEAR(impulse.linear.y(), -10 * 0.5 * 10 * 0.1, 1e-13);
  // p̂ = rho g dt (1.5 - y) in the rows y = 0.25, 0.75, 1.25.
  const auto pressure = make_vector(fluid.pressure_map());
  for (GlobalIndex id : pressure->getMap()->getNodeElementList())
    pressure->replaceGlobalValue(id, 2 * 10 * 0.1 * (1.25 - 0.5 * static_cast<double>(id / 4)));
  fluid.project(*pressure);
  EXPECT_LT(fluid.momentum().linear.norm(), 1e-13);
  EXPECT_EQ(fluid.regions().n_regions, 1);
  EXPECT_EQ(fluid.regions().has_dirichlet[0], 1);
}

TEST(FakeFluid, SurfaceSplitsRegionsAndCouplesFaces) {
  FakeBox<2> box = open_box<2>();
  FakeFluid<2> fluid(box, Tpetra::getDefaultComm());
  FakeBody<2> wall;
  wall.closed = false;
  wall.surface.vertices = {{1, -1}, {1, 3}};
  wall.surface.simplices = {{0, 1}};
  const FakeSolid<2> solid({wall}, {}, Tpetra::getDefaultComm());
  const auto surface = std::make_shared<const SurfaceSnapshot<2>>(solid.surface(), solid.solids());
  fluid.set_geometry(surface, Blocked<2>());
  EXPECT_EQ(fluid.regions().n_regions, 2);
  const auto mine = static_cast<GlobalIndex>(fluid.coupled_volumes().size());
  EXPECT_EQ(sum_all(Tpetra::getDefaultComm(), mine), 3);
  for (const auto& volume : fluid.coupled_volumes()) {
    EXPECT_EQ(volume.direction, 0);
    EXPECT_EQ(volume.center.x(), 1);
    EXPECT_EQ(volume.sides[1].unknown, volume.sides[0].unknown + 1);
  }
  std::vector<double> velocity(fluid.coupled_volumes().size(), 7);
  fluid.set_coupled_velocity(velocity);
  EXPECT_EQ(fluid.coupled_velocity(), velocity);
}

TEST(FakeSolid, RowsMoveThePointsThatMove) {
  FakeBody<3> body;
  body.surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.surface.simplices = {{0, 1, 2}};
  body.center = {1, 2, 3};
  body.velocity = {0.1, 0.2, 0.3};
  body.angular_velocity = {1, -2, 3};
  FakeBody<3> nodal = body;
  nodal.kind = FakeBody<3>::Kind::nodal;
  FakeSolid<3> solid({body, nodal}, {}, Tpetra::getDefaultComm());
  const double dt = 1e-3;
  for (int simplex : {0, 1}) {
    SurfacePoint<3> point;
    point.simplex = simplex;
    point.barycentric = {0.2, 0.3, 0.5};
    const auto position = [&] {
      Point<3> x = Point<3>::Zero();
      for (int k = 0; k < 3; ++k)
        x += point.barycentric[k] * solid.surface().vertices[solid.surface().simplices[simplex][k]];
      return x;
    };
    const Point<3> start = position();
    VelocityRow<3> row;
    solid.velocity_row(point, start, row);
    const Eigen::VectorXd dofs = dense(*solid.velocity());
    Point<3> velocity = Point<3>::Zero();
    for (std::size_t k = 0; k < row.dofs.size(); ++k)
      velocity += dofs[row.dofs[k]] * row.coefficients[k];
    FakeSolid<3> moved({body, nodal}, {}, Tpetra::getDefaultComm());
    moved.move(*solid.velocity(), 0, dt);
    Point<3> end = Point<3>::Zero();
    for (int k = 0; k < 3; ++k)
      end += point.barycentric[k] * moved.surface().vertices[moved.surface().simplices[simplex][k]];
    EXPECT_LT((end - start - dt * velocity).norm(), 1e-15);
    EXPECT_GT(velocity.norm(), 0.3);
  }
}

}  // namespace lockstep::test
