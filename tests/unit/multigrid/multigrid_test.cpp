#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>

#include "linear/conjugate_gradients.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/symmetry_check.hpp"
#include "multigrid/pressure_layout.hpp"
#include "multigrid_cases.hpp"

namespace lockstep::test {
namespace {

struct Solved {
  int n_iterations = 0;
  double true_residual = 0;  ///< |b - A p| / |b|, A without the layout
};

template <int dim>
Solved solve(const Problem<dim>& problem, const MultigridOptions& options) {
  const auto layout = PressureLayout::make(problem.system, options, nullptr);
  const BlockSystem permuted = layout->permuted(problem.system);
  const auto rhs = right_hand_side(problem);
  Vector b(layout->map()), x(layout->map());
  layout->to_layout(*rhs, b);
  ConjugateGradientsRequest request{"test", 1e-8 * rhs->norm2(), 100, {}};
  Solved result;
  result.n_iterations = conjugate_gradients(
      [&](const Vector& u, Vector& v) { apply(*permuted.pressure_block(), u, v); },
      [&](const Vector& u, Vector& v) { apply(*layout->inverse(), u, v); }, b, x, request);
  Vector p(rhs->getMap()), residual(*rhs, Teuchos::Copy);
  layout->from_layout(x, p);
  apply(*problem.system.pressure_block(), p, residual, -1, 1);
  result.true_residual = residual.norm2() / rhs->norm2();
  return result;
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> ball(double h) {
  Solids<dim> solids;
  const Point<dim> center = Point<dim>::Constant(0.43);
  solids.add(ball_surface<dim>(0.15, h), center, true);
  return solids.snapshot();
}
template <int dim>
void expect_matvec_of_the_layout(const Problem<dim>& problem) {
  const auto layout = PressureLayout::make(problem.system, {}, nullptr);
  const auto x = pressure_vector<dim>(  // zero nowhere, not even where A has empty rows
      *problem.fluid, [](const Point<dim>& at) { return 2 + wavy<dim>(at); });
  Vector in(layout->map()), out(layout->map()), ax(x->getMap()), by_matrix(x->getMap());
  layout->to_layout(*x, in);
  by_matrix.putScalar(1e3);
  layout->to_layout(by_matrix, out);  // earlier content must not matter
  apply(*layout->pressure_block(), in, out);
  layout->from_layout(out, ax);
  const auto matrix = assembled(problem.system.pressure_block());
  matrix->apply(*x, by_matrix);
  const double scale = by_matrix.normInf();
  EXPECT_NEAR(out.norm2(), by_matrix.norm2(), 1e-13 * by_matrix.norm2());
  ax.update(-1, by_matrix, 1);
  EXPECT_LT(ax.normInf(), 1e-14 * scale);
}

template <int dim>
void expect_matvec_beside_a_plate(int n) {
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  scene.side(dim == 2 ? "y upper" : "z upper", "open");
  expect_matvec_of_the_layout(Problem<dim>(scene, plate<dim>(1.0 / n, 0.43)));
}

TEST(Multigrid, TheLayoutHasTheSameOperator2D) {
  expect_matvec_beside_a_plate<2>(64);
}
TEST(Multigrid, TheLayoutHasTheSameOperator3D) {
  expect_matvec_beside_a_plate<3>(20);
}
TEST(Multigrid, RowsThatFillTheirStorage) {
  expect_matvec_beside_a_plate<3>(32);
  expect_matvec_beside_a_plate<2>(31);  // one of the colours fills it
}

TEST(Multigrid, ACellWithoutFacesFarFromAllOthersInItsRow) {
  // A long box on the floor leaves one cell in the corner, a plate covers it: its row of A is
  // empty, and no other cell in its row of the grid is fluid before the 25th.
  constexpr int n = 32;
  constexpr double h = 1.0 / n;
  Case<2> scene(cube<2>(n), h);
  scene.side("y upper", "open");
  Solids<2> solids;
  solids.add(box_surface<2>(Point<2>(23 * h, 8 * h), h), Point<2>(12.5 * h, 4 * h), true);
  solids.add(plate_surface<2>(Point<2>(2 * h, 0), 1, h), Point<2>(0.5 * h, h), false);
  const Problem<2> problem(scene, solids.snapshot());
  const auto matrix = assembled(problem.system.pressure_block());
  const auto diagonal = diagonal_of(*matrix);
  double n_empty = 0;
  for (const double value : diagonal->getData())
    n_empty += value == 0;
  EXPECT_EQ(sum_all(matrix->getComm(), n_empty), 1);
  expect_matvec_of_the_layout(problem);
}

TEST(Multigrid, KernelsMultiplyByTheOperator) {
  for (const Index<3>& cells : {Index<3>{7, 13, 9}, Index<3>{17, 24, 33}}) {
    Case<3> scene(cells, 1.0 / 24);
    scene.side("x lower", "open");
    for (const auto& surface : {ball<3>(1.0 / 24), plate<3>(1.0 / 24, 5.1 / 24)}) {
      const Problem<3> problem(scene, surface);
      const auto layout = PressureLayout::make(problem.system, {}, nullptr);
      expect_products_of_the_operator(problem, *layout, layout->kernels());
    }
  }
}

/// Bounds of the V cycle, the default, and of the W cycle; a smoother or a transfer that is wrong
/// takes twice as many.
template <int dim>
void expect_few_iterations(const Problem<dim>& problem, int v_cycles, int w_cycles) {
  for (const bool is_w_cycle : {false, true}) {
    MultigridOptions options;
    options.is_w_cycle = is_w_cycle;
    const Solved solved = solve(problem, options);
    EXPECT_LE(solved.n_iterations, is_w_cycle ? w_cycles : v_cycles) << (is_w_cycle ? "W" : "V");
    EXPECT_LT(solved.true_residual, 2e-8);
  }
}

TEST(Multigrid, ClosedBoxWithABall3D) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 8, 8);
}

TEST(Multigrid, OpenTop3D) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  scene.side("z upper", "open");
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 10, 8);
}

TEST(Multigrid, ClosedBoxWithABall2D) {
  Case<2> scene(cube<2>(64), 1.0 / 64);
  expect_few_iterations(Problem<2>(scene, ball<2>(1.0 / 64)), 9, 9);
}

TEST(Multigrid, PeriodicSides) {
  Case<2> flat(cube<2>(64), 1.0 / 64);
  flat.all_periodic();
  expect_few_iterations(Problem<2>(flat, ball<2>(1.0 / 64)), 8, 9);
  Case<3> scene(cube<3>(16), 1.0 / 16);
  scene.all_periodic();
  expect_few_iterations(Problem<3>(scene, nullptr), 7, 8);
}

TEST(Multigrid, OddSizes) {
  Case<3> scene({27, 34, 21}, 1.0 / 32);
  scene.side("x lower", "open");
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 10, 12);
}

/// A cycle that leaves the cells behind the plate in their coarse cells takes twice as many
/// iterations.
TEST(Multigrid, APlateOnOddFaces) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  expect_few_iterations(Problem<3>(scene, plate<3>(1.0 / 32, 13.1 / 32)), 12, 12);
  Case<2> flat(cube<2>(64), 1.0 / 64);
  expect_few_iterations(Problem<2>(flat, plate<2>(1.0 / 64, 27.1 / 64)), 11, 12);
}

/// The cells behind the plate, the last ones along x, go to the coarse cells beyond the seam.
TEST(Multigrid, APlateBesideASeam) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  scene.all_periodic();
  expect_few_iterations(Problem<3>(scene, plate<3>(1.0 / 32, 31.1 / 32)), 12, 12);
  Case<2> flat(cube<2>(64), 1.0 / 64);
  flat.all_periodic();
  expect_few_iterations(Problem<2>(flat, plate<2>(1.0 / 64, 63.1 / 64)), 11, 12);
}

template <int dim>
void expect_symmetric_and_positive(const Problem<dim>& problem, const MultigridOptions& options,
                                   const RCP<Vector>& u) {
  const auto layout = PressureLayout::make(problem.system, options, nullptr);
  Vector v(u->getMap());
  pseudo_random(v, 3);
  Vector lu(layout->map()), lv(layout->map()), mu(layout->map()), mv(layout->map());
  project_out(problem.system.null_space, v);
  layout->to_layout(*u, lu);
  layout->to_layout(v, lv);
  apply(*layout->inverse(), lu, mu);
  apply(*layout->inverse(), lv, mv);
  EXPECT_GT(lu.dot(mu), 0);
  EXPECT_GT(lv.dot(mv), 0);
  EXPECT_NEAR(lu.dot(mv), lv.dot(mu), 1e-6 * std::sqrt(lu.dot(mu) * lv.dot(mv)));
}

TEST(Multigrid, IsSymmetricAndPositive) {
  Case<3> scene(cube<3>(24), 1.0 / 24);
  for (const auto& surface : {ball<3>(1.0 / 24), plate<3>(1.0 / 24, 11.1 / 24)}) {
    const Problem<3> problem(scene, surface);
    expect_symmetric_and_positive(problem, {}, right_hand_side(problem));
  }
}

/// Three cells are left along a periodic axis on the coarsest level, whose colours differ across
/// the seam.
TEST(Multigrid, AnOddCoarsestLevelThroughASeam) {
  Case<2> scene(cube<2>(48), 1.0 / 48);
  scene.all_periodic();
  for (const auto& surface : {ball<2>(1.0 / 48), plate<2>(1.0 / 48, 47.1 / 48)}) {
    const Problem<2> problem(scene, surface);
    const auto u = make_vector(problem.fluid->pressure_map());
    pseudo_random(*u, 5);
    project_out(problem.system.null_space, *u);
    expect_symmetric_and_positive(problem, {}, u);
    expect_few_iterations(problem, 9, 8);
  }
}

/// Three levels of so many cells are distributed; half sweeps that see too few ghosts differ
/// between the ranks.
TEST(Multigrid, IsSymmetricWithGhostsOnSeveralLevels) {
  constexpr int n = 448;
  for (const bool is_periodic : {false, true}) {
    Case<2> scene(cube<2>(n), 1.0 / n);
    if (is_periodic)
      scene.all_periodic();
    for (const bool is_w_cycle : {false, true}) {
      MultigridOptions options;
      options.is_w_cycle = is_w_cycle;
      const Problem<2> problem(scene, plate<2>(1.0 / n, 197.1 / n));
      // Rough, so that round-off of the smoothest parts is small beside it.
      const auto u = make_vector(problem.fluid->pressure_map());
      pseudo_random(*u, 5);
      project_out(problem.system.null_space, *u);
      expect_symmetric_and_positive(problem, options, u);
    }
  }
}

/// Two chambers that see each other through a single face. Coarse faces of half their fine ones
/// would correct them 2^level times too far apart, and the W-cycle would not be positive.
TEST(Multigrid, ChambersJoinedByAGap) {
  const double h = 1.0 / 64;
  Case<2> scene(cube<2>(64), h);
  Solids<2> solids;
  solids.add(plate_surface<2>({0, 1}, 0, h), {0.5, 0.5 - h}, false);
  const Problem<2> problem(scene, solids.snapshot());
  ASSERT_EQ(problem.fluid->regions().n_regions, 1);
  const auto layout = PressureLayout::make(problem.system, {}, nullptr);
  const auto apart =
      pressure_vector<2>(*problem.fluid, [](const Point<2>& x) { return x[0] < 0.5 ? -1. : 1.; });
  Vector u(layout->map()), mu(layout->map());
  layout->to_layout(*apart, u);
  apply(*layout->inverse(), u, mu);
  EXPECT_GT(u.dot(mu), 0);
  expect_few_iterations(problem, 9, 14);
}

TEST(Multigrid, RefusesWhatItCannotHalve) {
  Case<2> scene({40, 40}, 1.0 / 40);
  scene.all_periodic();
  const Problem<2> problem(scene, nullptr);
  EXPECT_NE(PressureLayout::why_not(problem.system).find("multiple of 16"), std::string::npos);
}

}  // namespace
}  // namespace lockstep::test
