// M_F and how it is lumped.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "geometry/solid_volume.hpp"
#include "support/dense.hpp"
#include "unit/mixedface/bodies.hpp"

namespace lockstep::test {

TEST(FluidMass, DualCellMinusSolidByHand) {
  FakeBox<2> box;
  box.n_cells = {5, 4};
  box.density = 3;
  FakeBody<2> block;
  block.surface = rectangle({1.25, 0.75}, {3.25, 2.75});  // cells 1..2 x 1..2 are inside
  block.center = {2.25, 1.75};
  MixedFaceOptions options;
  CoupledCase<2> c(box, fake_solids<2>({{block}}), options);
  const GatheredFaces<2> faces = gathered_faces(c);
  ASSERT_EQ(faces.volumes.size(), 8u);
  // Width times height of the solid in the dual cells of the faces at x = 1 and 3, then y = 1
  // and 3.
  const double solid[] = {0.25 * 1,    0.75 * 1, 0.25 * 0.75, 0.75 * 0.75,
                          0.75 * 0.75, 1 * 0.75, 0.75 * 0.25, 1 * 0.25};
  for (int f = 0; f < 8; ++f)
    EXPECT_NEAR(faces.masses[f], 3 * (1 - solid[f]), 1e-13) << f;
  options.whole_cell_mass = true;
  CoupledCase<2> whole(box, fake_solids<2>({{block}}), options);
  EXPECT_LT((gathered_faces(whole).masses.array() - 3).matrix().norm(), 1e-13);
}

TEST(Lumping, ConsistentIsTheExplicitProduct) {
  FakeBody<2> sheet;
  sheet.kind = FakeBody<2>::Kind::nodal;
  sheet.closed = false;
  sheet.surface = polyline({{0.2, 0.75}, {0.5, 0.82}, {0.9, 0.78}}, false);
  MixedFaceOptions options;
  options.lumping = Lumping::consistent;
  // Both touch the faces between them.
  CoupledCase<2> c(unit_tank<2>(10), fake_solids<2>({{ball<2>(0.24, {0.5, 0.51}), sheet}}),
                   options);
  const GatheredFaces<2> faces = gathered_faces(c);
  const Eigen::MatrixXd expected =
      faces.weights.transpose() * faces.masses.asDiagonal() * faces.weights;
  const Eigen::MatrixXd added = dense(c.coupling.added_mass()).topLeftCorner(9, 9);
  EXPECT_LT((added - expected).norm(), 1e-14);
  EXPECT_GT(expected.topRightCorner(3, 6).norm(), 1e-3);  // shared rows tie the two
}

// Rows that carry rotations tie the axes, but not nodes of other dual cells.
TEST(Lumping, CarriedRowsTakeLittleMoreMemory) {
  std::array<double, 2> n_entries{};
  for (const bool carried : {false, true}) {
    MixedFaceOptions options;
    options.rule = MixedRule::every_cut_cell;
    options.lumping = Lumping::consistent;
    if (carried)
      options.soft_weights = SoftWeights::rigid_motions;
    FakeBody<3> body = ball<3>(0.3, {0.5, 0.51, 0.48}, FakeBody<3>::Kind::nodal);
    body.surface = ball_surface<3>(0.3, 0.06);
    for (auto& x : body.surface.vertices)
      x += body.center;
    CoupledCase<3> c(unit_tank<3>(10), fake_solids<3>({{body}}), options);
    n_entries[carried] = static_cast<double>(c.coupling.added_mass()->getGlobalNumEntries());
  }
  EXPECT_GT(n_entries[0], 1e4);
  EXPECT_LT(n_entries[1], 4.5 * n_entries[0]);
}

TEST(Lumping, ConsistentProductsAreSummedWhereTheyArise) {
  const CouplingWeights weights{{3, 5, 8}, {0, 2, 4}, {0, 2, 0, 1}, {0.5, 0.5, -1, 2}};
  const auto triplets = consistent_mass_triplets(weights, {4, 10});
  const std::vector<Triplet> expected{{3, 3, 11}, {3, 5, -20}, {3, 8, 1}, {5, 3, -20},
                                      {5, 5, 40}, {8, 3, 1},   {8, 8, 1}};
  ASSERT_EQ(triplets.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(triplets[i].row, expected[i].row);
    EXPECT_EQ(triplets[i].column, expected[i].column);
    EXPECT_DOUBLE_EQ(triplets[i].value, expected[i].value);
  }
}

TEST(Lumping, DiagonalConservesEachAxisMass) {
  CoupledCase<2> c(unit_tank<2>(10),
                   fake_solids<2>({{ball<2>(0.24, {0.5, 0.51}, FakeBody<2>::Kind::nodal)}}));
  const GatheredFaces<2> faces = gathered_faces(c);
  const Eigen::MatrixXd added = dense(c.coupling.added_mass());
  const int n = static_cast<int>(faces.weights.cols());
  for (int a = 0; a < 2; ++a) {
    double lumped = 0, fluid = 0;
    for (int k = a; k < n; k += 2)
      lumped += added(k, k);
    for (std::size_t f = 0; f < faces.volumes.size(); ++f)
      fluid += faces.volumes[f].direction == a ? faces.masses[static_cast<int>(f)] : 0;
    EXPECT_NEAR(lumped, fluid, 1e-13);
  }
  Eigen::MatrixXd off_diagonal = added.topLeftCorner(n, n);
  off_diagonal.diagonal().setZero();
  EXPECT_EQ(off_diagonal.norm(), 0);
}

// Bodies that stick out of the tank displace what is inside, those beyond it nothing.
TEST(HydrostaticForce, CountsWhatIsInTheDomain) {
  FakeBox<2> tank = unit_tank<2>(10);
  tank.open_axis = 1;
  tank.gravity = Point<2>(0, -9.8);
  const auto lift_of = [&](const Point<2>& lower, const Point<2>& upper) {
    FakeBody<2> body;
    body.surface = rectangle(lower, upper);
    body.center = (lower + upper) / 2;
    CoupledCase<2> c(tank, fake_solids<2>({{body}}));
    const auto impulse = make_vector(c.solids.map());
    c.coupling.hydrostatics()->add_hydrostatic_force(1, *impulse);
    return dense(*impulse)[1];
  };
  EXPECT_EQ(lift_of({0.3, 1.2}, {0.7, 1.5}), 0);    // above the open top
  EXPECT_EQ(lift_of({-0.5, 0.2}, {-0.1, 0.5}), 0);  // behind a wall
  // Between the cell centres 0.45 and 0.55 no line of them meets it.
  EXPECT_NEAR(lift_of({0.47, 0.46}, {0.53, 0.54}), tank.density * 9.8 * 0.06 * 0.08, 1e-14);
  EXPECT_NEAR(lift_of({-0.3, 0.46}, {0.02, 0.54}), tank.density * 9.8 * 0.02 * 0.08, 1e-14);
}

/// p̂ = dt rho g . x on the pressure unknowns: that of fluid at rest.
template <int dim>
RCP<Vector> pressure_at_rest(const CoupledCase<dim>& c, const FakeBox<dim>& tank, double dt) {
  const auto pressure = make_vector(c.fluid.pressure_map());
  for (const auto& face : c.fluid.faces())
    for (const auto& side : face.volume.sides)
      if (side.unknown != no_index && c.fluid.pressure_map()->isNodeGlobalElement(side.unknown))
        pressure->replaceGlobalValue(side.unknown,
                                     dt * tank.density * tank.gravity.dot(side.center));
  return pressure;
}

/// u* = dt g of the coupled volumes.
template <int dim>
std::vector<double> falling(const CoupledCase<dim>& c, const FakeBox<dim>& tank, double dt) {
  std::vector<double> velocity;
  for (const auto& volume : c.fluid.coupled_volumes())
    velocity.push_back(dt * tank.gravity[volume.direction]);
  return velocity;
}

// In fluid at rest a held body reports the buoyancy of all of its volume, not of what the grid
// makes of it.
TEST(HydrostaticForce, OfAHeldBodyIsReportedExactly) {
  FakeBox<2> tank = unit_tank<2>(12);
  tank.gravity = Point<2>(0.3, -9.8);
  const double dt = 0.1;
  for (const double radius : {0.03, 0.26})
    for (int k = 0; k < 4; ++k) {
      const FakeBody<2> body =
          ball<2>(radius, shifted_center<2>(k, tank.spacing), FakeBody<2>::Kind::prescribed);
      CoupledCase<2> c(tank, fake_solids<2>({{body}}));
      const auto properties = volume_properties<2>(body.surface);
      const auto none = make_vector(c.solids.map());
      const Momentum<2> impulse = c.coupling.hydrostatics()->add_hydrostatic_force(dt, *none).at(0);
      EXPECT_EQ(none->normInf(), 0);
      const std::vector<double> rest(c.fluid.coupled_volumes().size(), 0);
      const Momentum<2> given =
          c.coupling
              .prescribed_impulses(falling(c, tank, dt), rest, *pressure_at_rest(c, tank, dt), {})
              .at(0);
      const Point<2> lift = -dt * tank.density * properties.measure * tank.gravity;
      EXPECT_LT((impulse.linear - given.linear - lift).norm(), 1e-13) << radius << ' ' << k;
      EXPECT_NEAR(impulse.angular[0] - given.angular[0], cross<2>(properties.centroid, lift)[0],
                  1e-13)
          << radius << ' ' << k;
    }
}

/// The impulses of pressure, lumped fluid and hydrostatic force on a body in fluid at rest add up
/// to -rho V dt g at its centroid, however well the grid sees the body.
template <int dim>
void expect_exact_lift(double radius, int n_cells) {
  FakeBox<dim> tank = unit_tank<dim>(n_cells);
  tank.gravity = Point<dim>::Constant(0.3);
  tank.gravity[1] = -9.8;
  const double dt = 0.1;
  for (int k = 0; k < (dim == 2 ? 8 : 3); ++k) {
    FakeBody<dim> body = ball<dim>(radius, shifted_center<dim>(k, tank.spacing));
    const auto properties = volume_properties<dim>(body.surface);
    body.center = properties.centroid;
    CoupledCase<dim> c(tank, fake_solids<dim>({{body}}));
    const auto impulse = make_vector(c.solids.map());
    c.coupling.hydrostatics()->add_hydrostatic_force(dt, *impulse);
    const auto on_grid = make_vector(c.solids.map()), expected = make_vector(c.solids.map());
    if (!c.coupling.coupling_transposed().is_null())
      c.coupling.coupling_transposed()->apply(*pressure_at_rest(c, tank, dt), *on_grid,
                                              Teuchos::NO_TRANS, -1, 1);
    c.coupling.add_lumped_momentum(falling(c, tank, dt), *on_grid);
    c.coupling.hydrostatics()->add_impulse_at_rest(dt, *expected);  // for contact
    expected->update(-1, *on_grid, 1);
    EXPECT_LT(expected->normInf(), 1e-13) << k;
    EXPECT_GT(impulse->normInf(), 1e-6) << k;  // there was something to correct
    impulse->update(1, *on_grid, 1);
    const Eigen::VectorXd total = dense(*impulse);
    const Point<dim> lift = -dt * tank.density * properties.measure * tank.gravity;
    EXPECT_LT((total.head<dim>() - lift).norm(), 1e-13) << k;
    EXPECT_LT(total.tail(dim == 2 ? 1 : 3).norm(), 1e-13) << k;
  }
}
TEST(HydrostaticForce, IsExactHoweverTheGridSeesTheBody) {
  for (const double radius : {0.04, 0.26})
    expect_exact_lift<2>(radius, 10);
  for (const double radius : {0.05, 0.3})
    expect_exact_lift<3>(radius, 8);
}

// Where a wall hides the lower end of a body, nothing lifts it along that axis.
TEST(HydrostaticForce, DoesNotActWhereAnEndIsHidden) {
  FakeBox<2> tank = unit_tank<2>(10);
  tank.gravity = Point<2>(0.3, -9.8);
  FakeBody<2> body;
  body.surface = rectangle({0.23, -0.01}, {0.71, 0.56});
  body.center = {0.47, 0.275};
  CoupledCase<2> c(tank, fake_solids<2>({{body}}));
  const auto impulse = make_vector(c.solids.map()), on_grid = make_vector(c.solids.map());
  c.coupling.hydrostatics()->add_hydrostatic_force(1, *impulse);
  EXPECT_EQ(dense(*impulse)[1], 0);
  c.coupling.coupling_transposed()->apply(*pressure_at_rest(c, tank, 1), *on_grid,
                                          Teuchos::NO_TRANS, -1, 1);
  c.coupling.add_lumped_momentum(falling(c, tank, 1), *on_grid);
  EXPECT_NEAR((dense(*impulse) + dense(*on_grid))[0], -0.3 * tank.density * 0.48 * 0.56, 1e-13);
}

}  // namespace lockstep::test
