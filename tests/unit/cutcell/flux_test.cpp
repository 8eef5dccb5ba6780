// The flux of bodies through cut cells, with the staggered grid.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "cutcell/flux_coupling.hpp"
#include "geometry/clipping.hpp"
#include "linear/symmetry_check.hpp"
#include "support/dense.hpp"
#include "unit/cutcell/bodies_in_tank.hpp"

namespace lockstep::test {
namespace {

template <int dim>
FakeBody<dim> ball(double radius, const Point<dim>& center, double spacing) {
  FakeBody<dim> body;
  body.surface = ball_surface<dim>(radius, spacing);
  for (auto& x : body.surface.vertices)
    x += center;
  body.center = center;
  body.mass = 2;
  body.inertia = 0.3;
  return body;
}

/// A unit tank of water of density one with bodies.
template <int dim>
struct FluxCase : BodiesInTank<dim, FluxCoupling<dim>> {
  FluxCase(int n_cells, std::vector<FakeBody<dim>> bodies, const FluxOptions& options = {},
           bool periodic = false)
      : BodiesInTank<dim, FluxCoupling<dim>>(tank(n_cells, periodic), std::move(bodies), options) {}
  static std::unique_ptr<MacFluid<dim>> tank(int n_cells, bool periodic) {
    Index<dim> cells;
    cells.fill(n_cells);
    test::Case<dim> scene(cells, 1. / n_cells);
    scene.fluid.set("Density", 1.0);
    scene.fluid.set("Gravity", test::numbers(dim == 2 ? std::initializer_list<double>{0.3, -2}
                                                      : std::initializer_list<double>{0.3, 0, -2}));
    if (periodic)
      scene.all_periodic();
    return scene.make();
  }
  /// B_c: what unit velocities push out of the cell with this unknown.
  Eigen::MatrixXd pushed() const { return dense(this->coupling.coupling_transposed()).transpose(); }
};

/// (int n, int r x n) over the surface inside a cell, r from the body's centre.
template <int dim>
Eigen::VectorXd surface_moments(const SurfaceSnapshot<dim>& surface, const Point<dim>& center,
                                const Box<dim>& cell) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dim + n_rotations<dim>);
  std::vector<int> touching;
  surface.touching(cell, touching);
  for (const int s : touching) {
    const auto corners = surface.corners(s);
    const auto part = clip_to_box<dim>(corners, cell);
    const Point<dim> push = part.measure * area_vector<dim>(corners).normalized();
    result.head(dim) += push;
    result.tail(n_rotations<dim>) += cross<dim>(part.centroid - center, push);
  }
  return result;
}

template <int dim>
void check_cells_against_surface(int n_cells, const FakeBody<dim>& body) {
  FluxOptions options;
  options.smallest_open_fraction = 1e-6;
  const FluxCase<dim> c(n_cells, {body}, options);
  const Eigen::MatrixXd pushed = c.pushed();
  const double area = std::pow(1. / n_cells, dim - 1);
  const auto& grid = c.fluid->domain().grid;
  int row = static_cast<int>(c.fluid->pressure_map()->getMinGlobalIndex()), n_cut = 0;
  const Point<dim> half = Point<dim>::Constant(0.5 / n_cells);
  grid.for_each_owned_cell([&](int cell) {
    if (c.fluid->geometry().state.cells[cell] != CellState::fluid)
      return;
    const Point<dim> x = grid.center(cell);
    const auto expected =
        surface_moments<dim>(*c.surface, body.center, Box<dim>(x - half, x + half));
    n_cut += expected.norm() > 0 ? 1 : 0;
    EXPECT_LT((pushed.row(row++).head(dim + n_rotations<dim>).transpose() - expected).norm(),
              3e-6 * area);
  });
  EXPECT_GT(sum_all(c.solids->comm(), GlobalIndex(n_cut)), 10);
}

}  // namespace

TEST(Flux, OfEveryCellIsThatOfTheSurfaceInsideIt) {
  check_cells_against_surface<2>(16, ball<2>(0.23, {0.52, 0.47}, 0.03));
  check_cells_against_surface<3>(12, ball<3>(0.27, {0.52, 0.47, 0.51}, 0.09));
}

TEST(Flux, OfABodyOnItsWayThroughSides) {
  check_cells_against_surface<2>(24, ball<2>(0.23, {0.93, 0.06}, 0.03));
  check_cells_against_surface<3>(12, ball<3>(0.27, {0.07, 0.91, 0.51}, 0.09));
}

// A box of 0.4 x 0.3, its corners in the middle of cells of width 0.1.
TEST(Flux, OfABoxByHand) {
  FakeBody<2> body;
  body.surface = box_surface<2>({0.4, 0.3}, 0.1);
  for (auto& x : body.surface.vertices)
    x += Point<2>(0.55, 0.5);
  body.center = {0.55, 0.5};
  const FluxCase<2> c(10, {body});
  // The box is [0.35, 0.75] x [0.35, 0.65]: half cells around 3 x 2 closed ones carry pressures.
  EXPECT_EQ(c.fluid->pressure_map()->getGlobalNumElements(), 100u - 3 * 2);
  std::map<std::pair<int, int>, int> n_faces;  // by axis and open fraction in tenths
  for (const auto& volume : c.fluid->coupled_volumes())
    ++n_faces[{volume.direction, static_cast<int>(std::lround(10 * volume.open_fraction))}];
  for (const std::pair<const std::pair<int, int>, int>& entry : n_faces) {
    // Across x: 4 columns of faces, half open in the rows of the lower and upper sides, closed in 2
    // rows, of which the outer two columns lead to fluid.
    const auto [key, mine] = entry;
    EXPECT_TRUE(key.second == 0 || key.second == 5) << mine;
  }
  const auto count = [&](int axis, int tenths) {
    return sum_all(c.solids->comm(), GlobalIndex(n_faces[{axis, tenths}]));
  };
  EXPECT_EQ(count(0, 5), 2 * 4);
  EXPECT_EQ(count(0, 0), 2 * 2);
  EXPECT_EQ(count(1, 5), 2 * 3);
  EXPECT_EQ(count(1, 0), 2 * 3);
}

TEST(Flux, LosesNoMomentumNorAngularMomentum) {
  for (const double smallest : {1e-4, 0.3}) {
    FluxOptions options;
    options.smallest_open_fraction = smallest;
    FakeBody<3> shell, kinematic = ball<3>(0.13, {0.75, 0.3, 0.72}, 0.06);
    shell.surface = plate_surface<3>({0, 0.4, 0.4}, 0, 0.1);
    for (auto& x : shell.surface.vertices)
      x += Point<3>(0.21, 0.5, 0.5);
    shell.center = {0.21, 0.5, 0.5};
    shell.closed = false;
    kinematic.kind = FakeBody<3>::Kind::prescribed;
    kinematic.velocity = {1, 2, -1};
    FluxCase<3> c(10, {ball<3>(0.24, {0.43, 0.52, 0.47}, 0.1), kinematic, shell}, options);
    c.fluid->set_prediction(test::wavy_velocity<3>);
    const auto pressure = make_vector(c.fluid->pressure_map());
    pseudo_random(*pressure, 7);
    // Row 2 of Eq. 16, and F4.
    const std::vector<double> before = c.fluid->coupled_velocity();
    const RCP<Vector> momentum = c.solids->explicit_momentum(0, 0.1);
    Momentum<3> total = c.fluid->audit()->momentum() + c.system->lumped_fluid_momentum(before);
    total += c.solids->momentum(*momentum);
    const RCP<Vector> rhs = c.system->lumped_momentum(*momentum);
    const BlockSystem& blocks = c.system->blocks(0.1);
    blocks.coupling_transposed()->apply(*pressure, *rhs, Teuchos::NO_TRANS, -1, 1);
    const auto velocity =
        distributed(dense(blocks.solid_block()).llt().solve(dense(*rhs)), c.solids->map());
    const std::vector<double> after = c.coupling.velocity(*velocity);
    total += total_of(c.coupling.prescribed_impulses(before, after, *pressure, {}));
    total += c.fluid->audit()->boundary_pressure_impulse(*pressure);
    c.fluid->project(*pressure);
    c.fluid->set_coupled_velocity(after);
    const auto gained = make_vector(c.solids->map());
    apply(*c.solids->mass(), *velocity, *gained);
    total -= c.fluid->audit()->momentum() + c.system->lumped_fluid_momentum(after);
    total -= c.solids->momentum(*gained);
    EXPECT_LT(total.linear.norm(), 1e-13) << smallest;
    EXPECT_LT(total.angular.norm(), 1e-13) << smallest;
  }
}

TEST(Flux, OfDroppedFacesGoesToTheSolid) {
  FluxOptions options;
  options.smallest_open_fraction = 0.3;
  const FluxCase<2> c(16, {ball<2>(0.23, {0.52, 0.47}, 0.03)}, options);
  // Nothing is lost: what leaves on one side enters on the other, and a spin pushes little.
  EXPECT_LT(c.pushed().colwise().sum().head(3).norm(), 1e-14);
  for (const auto& volume : c.fluid->coupled_volumes())
    EXPECT_TRUE(volume.open_fraction == 0 || volume.open_fraction >= 0.3);
}

TEST(Flux, OfABodyThatDriftsWithTheFluidIsBalanced) {
  const FluxCase<3> c(10, {ball<3>(0.24, {0.43, 0.52, 0.47}, 0.1)}, {}, true);
  const Point<3> drift(0.7, -0.4, 0.2);
  c.fluid->set_prediction([&](const Point<3>&) { return drift; });
  const auto outflow = make_vector(c.fluid->pressure_map());
  c.fluid->divergence(*outflow);
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(c.solids->map()->getGlobalNumElements());
  motion.head(3) = drift;
  c.coupling.coupling_transposed()->apply(*distributed(motion, c.solids->map()), *outflow,
                                          Teuchos::TRANS, 1, 1);
  EXPECT_LT(outflow->normInf(), 1e-15);
}

// p = -rho g x at rest lifts the weight of the displaced fluid, at its centre.
TEST(Flux, OfAFluidAtRestLiftsTheBodyExactly) {
  const FluxCase<3> c(9, {ball<3>(0.24, {0.43, 0.52, 0.47}, 0.1)});
  const Point<3> gravity = c.fluid->gravity();
  const auto pressure =
      test::pressure_vector<3>(*c.fluid, [&](const Point<3>& x) { return 0.1 * gravity.dot(x); });
  const auto impulse = make_vector(c.solids->map());
  c.coupling.hydrostatics()->add_hydrostatic_force(0.1, *impulse);
  c.coupling.coupling_transposed()->apply(*pressure, *impulse, Teuchos::NO_TRANS, -1, 1);
  const Eigen::VectorXd lift = dense(*impulse);
  const double volume = 4. / 3 * M_PI * std::pow(0.24, 3);
  EXPECT_LT((lift.head(3) + 0.1 * volume * gravity).norm(), 1e-14);
  EXPECT_LT(lift.segment(3, 3).norm(), 1e-14);
}

// A bar through a wall: the fluid lifts the part in the tank.
TEST(Flux, OfAFluidAtRestLiftsThePartInTheTank) {
  for (const double beyond : {0.4, 5.}) {
    FakeBody<3> bar;
    bar.surface = box_surface<3>({0.3 + beyond, 0.25, 0.25}, 0.1);
    for (auto& x : bar.surface.vertices)
      x += Point<3>(0.15 - beyond / 2, 0.53, 0.48);
    bar.center = {0.15, 0.53, 0.48};
    const FluxCase<3> c(9, {bar});
    const Point<3> gravity = c.fluid->gravity();
    const auto pressure =
        test::pressure_vector<3>(*c.fluid, [&](const Point<3>& x) { return 0.1 * gravity.dot(x); });
    const auto impulse = make_vector(c.solids->map());
    c.coupling.hydrostatics()->add_hydrostatic_force(0.1, *impulse);
    c.coupling.coupling_transposed()->apply(*pressure, *impulse, Teuchos::NO_TRANS, -1, 1);
    EXPECT_NEAR(dense(*impulse)[2], 0.1 * 2 * 0.3 * 0.25 * 0.25, 1e-14) << beyond;
  }
}

// The torque error of nodes, whose levers are not the fluid's, is in the ledger, to round-off.
TEST(Flux, NamesTheLeversOfNodes) {
  FakeBody<2> body = ball<2>(0.23, {0.52, 0.47}, 0.03), plate;
  body.kind = plate.kind = FakeBody<2>::Kind::nodal;
  plate.surface = box_surface<2>({0.4, 0.02}, 0.05);
  for (auto& x : plate.surface.vertices)
    x += Point<2>(0.6, 0.892);
  plate.velocity = {0.3, 1};
  FluxCase<2> c(16, {body, plate});
  c.fluid->set_prediction(test::wavy_velocity<2>);
  BlockVector solution{make_vector(c.fluid->pressure_map()), make_vector(c.solids->map())};
  pseudo_random(*solution.pressure, 7);
  const std::vector<double> before = c.fluid->coupled_velocity();
  const RCP<Vector> momentum = c.solids->explicit_momentum(0, 0.1);
  const BlockSystem& blocks = c.system->blocks(0.1);
  const RCP<Vector> rhs = c.system->lumped_momentum(*momentum);
  blocks.coupling_transposed()->apply(*solution.pressure, *rhs, Teuchos::NO_TRANS, -1, 1);
  solution.solid =
      distributed(dense(blocks.solid_block()).llt().solve(dense(*rhs)), c.solids->map());
  const std::vector<double> after = c.coupling.velocity(*solution.solid);
  Momentum<2> total = c.fluid->audit()->momentum() + c.system->lumped_fluid_momentum(before);
  total += c.solids->momentum(*momentum) +
           c.fluid->audit()->boundary_pressure_impulse(*solution.pressure);
  const AngularVector<2> levers =
      c.coupling.lumping_torque_error(*c.solids, before, after, solution, {});
  c.fluid->project(*solution.pressure);
  c.fluid->set_coupled_velocity(after);
  const auto gained = make_vector(c.solids->map());
  apply(*c.solids->mass(), *solution.solid, *gained);
  total -= c.fluid->audit()->momentum() + c.system->lumped_fluid_momentum(after);
  total -= c.solids->momentum(*gained);
  EXPECT_LT(total.linear.norm(), 1e-13);
  EXPECT_GT(levers.norm(), 1e-6);
  EXPECT_LT((total.angular + levers).norm(), 1e-13);
}

// Volume fractions displace the volume of the body without any correction.
TEST(Flux, OfVolumeFractionsLiftsTheBodyExactly) {
  FluxOptions options;
  options.weights = FaceWeights::volumes;
  options.correct_buoyancy = false;
  const FluxCase<3> c(9, {ball<3>(0.24, {0.43, 0.52, 0.47}, 0.1)}, options);
  const Point<3> gravity = c.fluid->gravity();
  const auto pressure =
      test::pressure_vector<3>(*c.fluid, [&](const Point<3>& x) { return gravity.dot(x); });
  const auto lift = make_vector(c.solids->map());
  c.coupling.coupling_transposed()->apply(*pressure, *lift, Teuchos::NO_TRANS, -1, 0);
  const double volume = 4. / 3 * M_PI * std::pow(0.24, 3);
  // Open fractions are rounded to a millionth.
  EXPECT_LT((dense(*lift).head(3) + volume * gravity).norm(), 1e-6 * volume * gravity.norm());
}

TEST(Flux, SystemIsSymmetricAndDefinite) {
  const FluxCase<2> c(14, {ball<2>(0.2, {0.507, 0.511}, 0.03)});
  const BlockSystem& blocks = c.system->blocks(0.1);
  EXPECT_TRUE(c.coupling.added_mass().is_null());  // C = M_S
  const Eigen::MatrixXd A = dense(blocks.pressure_block()), B = c.pushed();
  EXPECT_EQ((A - A.transpose()).norm(), 0);
  const Eigen::MatrixXd schur = A + B * dense(blocks.solid_block()).inverse() * B.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(schur);
  const double largest = spectrum.eigenvalues().maxCoeff();
  EXPECT_GT(spectrum.eigenvalues()[0], -1e-13 * largest);  // the constant
  EXPECT_GT(spectrum.eigenvalues()[1], 1e-5 * largest);
}

// e_x^T B^T A^+ B e_x over the displaced mass; 8 cells a diameter. Benchmark A3 for a square tank.
TEST(Flux, AddedMassOfADisc) {
  const double radius = 0.125;
  double mean = 0;
  const int n_places = 4;
  for (int k = 0; k < n_places; ++k) {
    const Point<2> place(0.5 + 0.31 * k / 32, 0.5 + 0.67 * k / 32);
    const FluxCase<2> c(32, {ball<2>(radius, place, 0.01)});
    const Eigen::MatrixXd A = dense(c.system->blocks(0.1).pressure_block());
    const Eigen::VectorXd push = c.pushed().col(0);
    // The constant is in the null space of A and B^T: a rank-one term fixes it.
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(A.rows()).normalized();
    const double added = push.dot((A + one * one.transpose()).ldlt().solve(push));
    mean += added / (M_PI * radius * radius) / n_places;
  }
  EXPECT_NEAR(mean, 1.11352, 0.02 * 1.11352);
  EXPECT_NEAR(mean, 1.11602780891, 1e-9);  // on any number of ranks
}

// A shell around the centre of one cell closes its four faces; the region inside keeps its
// pressure.
TEST(Flux, KeepsPocketsBetweenShells) {
  FakeBody<2> shell;
  shell.surface = box_surface<2>({0.11, 0.11}, 0.11);
  for (auto& x : shell.surface.vertices)
    x += Point<2>(0.45, 0.45);
  shell.closed = false;
  const FluxCase<2> c(10, {shell});
  EXPECT_EQ(c.fluid->pressure_map()->getGlobalNumElements(), 100u);
  double mass = 0;
  for (const double m : c.coupling.fluid_mass())
    mass += m;
  EXPECT_NEAR(sum_all(c.solids->comm(), mass), 4 * 0.01, 1e-14);  // whole dual cells
  EXPECT_FALSE(c.coupling.added_mass().is_null());
}

// A closed plate of a third of a cell, between the planes of the faces, is no open door.
TEST(Flux, PartsThinnerThanACellDoNotLeak) {
  FakeBody<2> plate;
  plate.surface = box_surface<2>({0.03, 1.2}, 0.1);
  for (auto& x : plate.surface.vertices)
    x += Point<2>(0.525, 0.5);
  plate.center = {0.525, 0.5};
  const FluxCase<2> c(10, {plate});
  EXPECT_EQ(c.fluid->regions().n_regions, 2);
  double pushed = 0;  // per unit of velocity, on one side
  const Eigen::VectorXd push = c.pushed().col(0);
  for (Eigen::Index row = 0; row < push.size(); ++row)
    pushed += std::max(0., push[row]);
  EXPECT_NEAR(pushed, 1, 1e-14);
}

// The fluid slips along a body at rest: faces with their centre inside the body, but open beside
// it, carry on the velocity of the fluid they see.
TEST(Flux, PartlyOpenFacesKeepTheVelocityOfTheirFluid) {
  FluxCase<2> c(16, {ball<2>(0.23, {0.52, 0.47}, 0.03)}, {}, true);
  MacFluid<2>& fluid = *c.fluid;
  fluid.set_prediction([](const Point<2>&) { return Point<2>(1, 2); });
  fluid.accept();
  const MovingSurface<2> still{c.surface, c.surface,
                               [](const SurfacePoint<2>&) { return Point<2>(0, 0); }};
  fluid.advect(0, 1e-5, still);
  fluid.set_geometry(c.surface, c.coupling);
  fluid.populate_uncovered(still);
  GlobalIndex n_inside = 0;
  const std::vector<double> velocity = fluid.coupled_velocity();
  for (std::size_t f = 0; f < velocity.size(); ++f) {
    const ControlVolume<2>& volume = fluid.coupled_volumes()[f];
    if (volume.open_fraction == 0)
      continue;
    n_inside += c.surface->inside(volume.center) >= 0 ? 1 : 0;
    EXPECT_NEAR(velocity[f], volume.direction + 1, 1e-3);
  }
  EXPECT_GT(sum_all(c.solids->comm(), n_inside), 5);
}

// The fluid turns about a disc at rest and slips along it. Jets in the faces whose centres the disc
// holds are gone when the fluid has crossed a cell; nobody else has seen them.
TEST(Flux, JetsInPartlyOpenFacesDoNotLast) {
  const Point<2> middle(0.52, 0.47);
  FluxCase<2> c(16, {ball<2>(0.23, middle, 0.03)}, {}, true);
  MacFluid<2>& fluid = *c.fluid;
  const auto turning = [&](const Point<2>& x) {
    return Point<2>(middle[1] - x[1], x[0] - middle[0]);
  };
  fluid.set_prediction(
      [&](const Point<2>& x) { return c.surface->inside(x) >= 0 ? Point<2>(9, -9) : turning(x); });
  fluid.accept();
  fluid.set_prediction(turning);
  const MovingSurface<2> still{c.surface, c.surface,
                               [](const SurfacePoint<2>&) { return Point<2>(0, 0); }};
  fluid.advect(0, 0.25, still);  // 0.23 m/s: 0.9 cells
  fluid.set_geometry(c.surface, c.coupling);
  fluid.populate_uncovered(still);
  const std::vector<double> velocity = fluid.coupled_velocity();
  for (std::size_t f = 0; f < velocity.size(); ++f) {
    const ControlVolume<2>& volume = fluid.coupled_volumes()[f];
    if (volume.open_fraction > 0) {
      // A quarter of a radian further on, and seen from a cell's distance.
      EXPECT_NEAR(velocity[f], turning(volume.open_center)[volume.direction], 0.15);
    }
  }
}

// A part of a face that two solids both fill counts twice, so that their moments may put what is
// left of it anywhere: velocities were fetched from there, far outside of the tank, too.
TEST(Flux, OpenPlacesLieInTheirFacesWhereSolidsOverlap) {
  FluxOptions options;
  options.weights = FaceWeights::volumes;
  GlobalIndex n_places = 0, n_outside = 0;
  for (int k = 0; k < 10; ++k) {
    const FluxCase<2> c(
        16, {ball<2>(0.23, {0.42, 0.47}, 0.03), ball<2>(0.2, {0.66 + 0.007 * k, 0.49}, 0.03)},
        options);
    const auto& grid = c.fluid->domain().grid;
    const Point<2> half = Point<2>::Constant(0.5 / 16 + 1e-12);
    GlobalIndex here = 0, outside = 0;
    for (int axis = 0; axis < 2; ++axis) {
      grid.for_each_owned_face(axis, [&](int face) {
        const auto& places = c.fluid->geometry().state.open_centers[axis];
        const auto place = places.find(face);
        if (place == places.end())
          return;
        const Point<2> center = grid.face_center(axis, face);
        here += 1;
        outside += Box<2>(center - half, center + half).contains(place->second) ? 0 : 1;
      });
    }
    n_places += sum_all(c.solids->comm(), here);
    n_outside += sum_all(c.solids->comm(), outside);
  }
  EXPECT_EQ(n_outside, 0);
  EXPECT_GT(n_places, 200);
}

}  // namespace lockstep::test
