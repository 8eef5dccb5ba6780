#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "../mac/mac_cases.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/exact_inverse.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/null_space.hpp"
#include "linear/symmetry_check.hpp"
#include "multigrid/pressure_layout.hpp"
#include "multigrid/schur_stencil.hpp"
#include "multigrid/through_sheets.hpp"

namespace lockstep::test {
namespace {

/// A fluid with its pressure block as a system without solid.
template <int dim>
struct Problem {
  std::unique_ptr<MacFluid<dim>> fluid;
  BlockSystem system;

  Problem(Case<dim>& scene, const std::shared_ptr<const SurfaceSnapshot<dim>>& surface)
      : fluid(scene.make()) {
    fluid->set_geometry(surface, BlockedFaces<dim>());
    system.pressure_block = fluid->pressure_block();
    const PressureRegions& regions = fluid->regions();
    for (int region = 0; region < regions.n_regions; ++region) {
      if (regions.has_dirichlet[region])
        continue;
      const auto indicator = make_vector(fluid->pressure_map());
      for (std::size_t row = 0; row < regions.of_unknown.size(); ++row) {
        if (regions.of_unknown[row] == region)
          indicator->replaceLocalValue(static_cast<int>(row), 1.0);
      }
      indicator->scale(1 / indicator->norm2());
      system.pressure_null_space.push_back(indicator);
    }
    system.null_space = system.pressure_null_space;
  }
};

/// A right-hand side in the range of A with smooth and rough parts.
template <int dim>
RCP<Vector> right_hand_side(const Problem<dim>& problem) {
  const auto rhs = pressure_vector<dim>(*problem.fluid, [](const Point<dim>& x) {
    return wavy<dim>(x) + 0.3 * std::sin(1e3 * x[0] + 3e3 * x[1]) +
           0.1 * std::cos(2e3 * x[dim - 1]);
  });
  project_out(problem.system.null_space, *rhs);
  return rhs;
}

struct Solved {
  int n_iterations = 0;
  double true_residual = 0;  ///< |b - A p| / |b|, A without the layout
};

template <int dim>
Solved solve(const Problem<dim>& problem, const MultigridOptions& options = {2, true}) {
  const auto layout = PressureLayout::make(problem.system, options, nullptr);
  const BlockSystem relaid = layout->relaid(problem.system);
  const auto rhs = right_hand_side(problem);
  Vector b(layout->map()), x(layout->map());
  layout->to_layout(*rhs, b);
  ConjugateGradientsRequest request{"test", 1e-8 * rhs->norm2(), 100, {}};
  Solved result;
  result.n_iterations = conjugate_gradients(
      [&](const Vector& u, Vector& v) { apply(*relaid.pressure_block, u, v); },
      [&](const Vector& u, Vector& v) { apply(*layout->inverse(), u, v); }, b, x, request);
  Vector p(rhs->getMap()), residual(*rhs, Teuchos::Copy);
  layout->from_layout(x, p);
  apply(*problem.system.pressure_block, p, residual, -1, 1);
  result.true_residual = residual.norm2() / rhs->norm2();
  return result;
}

template <int dim>
Index<dim> cube(int n) {
  Index<dim> cells;
  cells.fill(n);
  return cells;
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> ball(double h) {
  Solids<dim> solids;
  const Point<dim> center = Point<dim>::Constant(0.43);
  solids.add(ball_surface<dim>(0.15, h), center, true);
  return solids.snapshot();
}

/// A plate along a plane of cell faces of odd number, so that it cuts coarse cells of the first
/// level, with a gap around it.
template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> plate(double h, double where) {
  Solids<dim> solids;
  Point<dim> size = Point<dim>::Constant(0.7);
  Point<dim> center = Point<dim>::Constant(0.5);
  center[0] = where;
  solids.add(plate_surface<dim>(size, 0, h), center, false);
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
  layout->to_layout(by_matrix, out);  // what was there must not matter
  apply(*layout->pressure_block(), in, out);
  layout->from_layout(out, ax);
  const auto matrix = assembled(problem.system.pressure_block);
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
  const auto matrix = assembled(problem.system.pressure_block);
  const auto diagonal = diagonal_of(*matrix);
  double n_empty = 0;
  for (const double value : diagonal->getData())
    n_empty += value == 0;
  EXPECT_EQ(sum_all(matrix->getComm(), n_empty), 1);
  expect_matvec_of_the_layout(problem);
}

template <int dim>
void expect_few_iterations(const Problem<dim>& problem, int at_most) {
  const Solved solved = solve(problem);
  EXPECT_LE(solved.n_iterations, at_most);
  EXPECT_LT(solved.true_residual, 2e-8);
  testing::Test::RecordProperty("iterations", solved.n_iterations);
}

TEST(Multigrid, ClosedBoxWithABall3D) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 8);
}

TEST(Multigrid, OpenTop3D) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  scene.side("z upper", "open");
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 8);
}

TEST(Multigrid, ClosedBoxWithABall2D) {
  Case<2> scene(cube<2>(64), 1.0 / 64);
  expect_few_iterations(Problem<2>(scene, ball<2>(1.0 / 64)), 9);
}

TEST(Multigrid, PeriodicSides) {
  Case<2> flat(cube<2>(64), 1.0 / 64);
  flat.all_periodic();
  expect_few_iterations(Problem<2>(flat, ball<2>(1.0 / 64)), 9);
  Case<3> scene(cube<3>(16), 1.0 / 16);
  scene.all_periodic();
  expect_few_iterations(Problem<3>(scene, nullptr), 8);
}

TEST(Multigrid, OddSizes) {
  Case<3> scene({27, 34, 21}, 1.0 / 32);
  scene.side("x lower", "open");
  expect_few_iterations(Problem<3>(scene, ball<3>(1.0 / 32)), 12);
}

/// Without moving the cells behind the plate this takes twice as many.
TEST(Multigrid, APlateOnOddFaces) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  expect_few_iterations(Problem<3>(scene, plate<3>(1.0 / 32, 13.1 / 32)), 12);
  Case<2> flat(cube<2>(64), 1.0 / 64);
  expect_few_iterations(Problem<2>(flat, plate<2>(1.0 / 64, 27.1 / 64)), 12);
}

TEST(Multigrid, IsSymmetricAndPositive) {
  Case<3> scene(cube<3>(24), 1.0 / 24);
  for (const auto& surface : {ball<3>(1.0 / 24), plate<3>(1.0 / 24, 11.1 / 24)}) {
    const Problem<3> problem(scene, surface);
    const auto layout = PressureLayout::make(problem.system, {}, nullptr);
    const auto u = right_hand_side(problem);
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
  expect_few_iterations(problem, 14);
}

/// A row of the pressures for every closed face across x between two cells.
struct ClosedFace {
  std::size_t upper_cell;
  GlobalIndex lower, upper;
};

std::vector<ClosedFace> closed_faces(const FaceCoefficients& a) {
  const LatticeBlocks& blocks = *a.blocks;
  Vector ids(a.map);
  std::vector<std::array<int, 3>> cells;
  for_each_cell(blocks, [&](std::size_t, const std::array<int, 3>& at) { cells.push_back(at); });
  const auto number = [&](const std::array<int, 3>& at) {
    return at[0] + blocks.n_cells[0] * (at[1] + blocks.n_cells[1] * at[2]);
  };
  std::vector<double> row_of_cell(number({0, 0, blocks.n_cells[2]}), 0);  // plus 1, on all ranks
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (a.row[cell] >= 0)
      row_of_cell[number(cells[cell])] = 1. + a.map->getGlobalElement(a.row[cell]);
  }
  sum_all(a.map->getComm(), row_of_cell.data(), static_cast<int>(row_of_cell.size()));
  std::vector<ClosedFace> faces;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (a.row[cell] < 0 || cells[cell][0] == 0 || a.lower[0][cell] != 0)
      continue;
    const auto upper = static_cast<GlobalIndex>(row_of_cell[number(cells[cell])]) - 1;
    const auto lower = static_cast<GlobalIndex>(row_of_cell[number(cells[cell]) - 1]) - 1;
    if (lower >= 0)
      faces.push_back({cell, lower, upper});
  }
  return faces;
}

enum class Sides { one, both };

/// Makes a sheet of the closed faces of a plate: every `faces_per_node` of a rank hang on a node
/// that moves along x, of such a mass that each gives way to an even jump just as the fluid does,
/// times `relative_mass`.
template <int dim>
std::vector<ClosedFace> make_sheet(Problem<dim>& problem, int faces_per_node = 1,
                                   Sides sides = Sides::both, double relative_mass = 1) {
  constexpr double b = 0.7;
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block);
  const std::vector<ClosedFace> faces = closed_faces(a);
  const int n_faces = static_cast<int>(faces.size());
  const int n_nodes = (n_faces + faces_per_node - 1) / faces_per_node;
  const auto map = make_map(n_nodes, a.map->getComm());
  std::vector<std::vector<Entry>> coupling(n_nodes), mass(n_nodes);
  for (int face = 0; face < n_faces; ++face) {
    const int node = face / faces_per_node;
    coupling[node].push_back({faces[face].upper, -b});
    if (sides == Sides::both)
      coupling[node].push_back({faces[face].lower, b});
    mass[node].push_back({map->getGlobalElement(node), relative_mass * b * b / a.unit});
  }
  problem.system.coupling_transposed = matrix_from_rows(map, coupling, a.map, map);
  problem.system.solid_block = as_operator(RCP<const CrsMatrix>(matrix_from_rows(map, mass)));
  const auto motions = rcp(new MultiVector(map, dim == 2 ? 3 : 6));
  motions->getVectorNonConst(0)->putScalar(1);
  problem.system.near_null_space = {motions, std::vector<int>(n_nodes, 0), 1, Teuchos::null};
  problem.system.near_null_space.mass =
      lumped_mass(*problem.system.solid_block, problem.system.near_null_space);
  return faces;
}

/// The coefficients of A with the faces of the sheet opened as those of the fluid are, against what
/// is found.
template <int dim>
void expect_faces_to_open(const Problem<dim>& problem, const std::vector<ClosedFace>& faces) {
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block);
  ASSERT_GT(sum_all(a.map->getComm(), static_cast<GlobalIndex>(faces.size())), 300);
  const auto conducting = conducting_through_sheets(problem.system, {});
  ASSERT_TRUE(conducting.has_value());
  FaceCoefficients expected = a;
  for (const ClosedFace& face : faces)
    expected.lower[0][face.upper_cell] = 1;
  for (int axis = 0; axis < dim; ++axis)
    EXPECT_EQ(conducting->lower[axis], expected.lower[axis]) << axis;
}

template <int dim>
RCP<const LinearOperator> solid_inverse(const Problem<dim>& problem) {
  return exact_inverse(problem.system.solid_block, "sheet");
}

/// Iterations of conjugate gradients on A + B C^-1 B^T of the sheet.
template <int dim>
int iterations_with(const Problem<dim>& problem, const PressureLayout& layout,
                    const RCP<const LinearOperator>& preconditioner) {
  const BlockSystem relaid = layout.relaid(problem.system);
  const CrsMatrix& coupling = *relaid.coupling_transposed;
  const auto inverse = solid_inverse(problem);
  Vector b(layout.map()), x(layout.map()), force(coupling.getRangeMap()), velocity(force.getMap());
  layout.to_layout(*right_hand_side(problem), b);
  const ConjugateGradientsRequest request{"test", 1e-8 * b.norm2(), 200, {}};
  return conjugate_gradients(
      [&](const Vector& u, Vector& v) {
        apply(*relaid.pressure_block, u, v);
        coupling.apply(u, force);
        apply(*inverse, force, velocity);
        coupling.apply(velocity, v, Teuchos::TRANS, 1, 1);
      },
      [&](const Vector& u, Vector& v) { apply(*preconditioner, u, v); }, b, x, request);
}

/// A sheet of the fluid's own inertia: A + B C^-1 B^T is the operator of the box without it.
TEST(Multigrid, ASheetThatGivesWay) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  Problem<3> problem(scene, plate<3>(1.0 / 32, 13.1 / 32));
  expect_faces_to_open(problem, make_sheet(problem, 2));
  expect_faces_to_open(problem, make_sheet(problem));

  const auto layout = PressureLayout::make(problem.system, {}, nullptr);
  EXPECT_FALSE(layout->has_schur_inverse());
  layout->build_schur_inverse(problem.system, *solid_inverse(problem));
  const int n_aware = iterations_with(problem, *layout, layout->schur_inverse());
  const int n_unaware = iterations_with(problem, *layout, layout->inverse());
  EXPECT_LE(n_aware, 12);
  EXPECT_GE(n_unaware, 2 * n_aware);
  EXPECT_FALSE(PressureLayout::make(problem.system, {}, layout)->has_schur_inverse());
}

TEST(Multigrid, SolidsWithFluidOnOneSideConductNothing) {
  Case<3> scene(cube<3>(16), 1.0 / 16);
  Problem<3> problem(scene, plate<3>(1.0 / 16, 7.1 / 16));
  make_sheet(problem, 1, Sides::one);
  EXPECT_FALSE(conducting_through_sheets(problem.system, {}).has_value());
}

/// A cell beside it takes b_f sum b_g / m, in the unit of A the inverse of the relative mass.
template <int dim>
void expect_cells_to_yield(const Problem<dim>& problem, const std::vector<ClosedFace>& faces,
                           float expected_reaction) {
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block);
  const auto schur = schur_stencil(problem.system, *solid_inverse(problem), {});
  ASSERT_TRUE(schur.has_value());
  EXPECT_EQ(schur->lower, a.lower);
  std::vector<float> expected(a.row.size(), 0);
  for (const ClosedFace& face : faces)
    expected[face.upper_cell] = expected_reaction;
  EXPECT_EQ(schur->reaction, expected);
}

TEST(Multigrid, ASolidWithFluidOnOneSideYields) {
  Case<3> scene(cube<3>(32), 1.0 / 32);
  Problem<3> problem(scene, plate<3>(1.0 / 32, 13.1 / 32));
  expect_cells_to_yield(problem, make_sheet(problem, 2, Sides::one), 1);
  expect_cells_to_yield(problem, make_sheet(problem, 1, Sides::one, 1. / 16), 16);

  const auto layout = PressureLayout::make(problem.system, {}, nullptr);
  layout->build_schur_inverse(problem.system, *solid_inverse(problem));
  const int n_aware = iterations_with(problem, *layout, layout->schur_inverse());
  const int n_unaware = iterations_with(problem, *layout, layout->inverse());
  EXPECT_LE(n_aware, 18);
  EXPECT_GE(n_unaware, 4 * n_aware);
  make_sheet(problem, 1, Sides::one, 16);  // another C on the same geometry
  layout->build_schur_inverse(problem.system, *solid_inverse(problem));
  EXPECT_LE(iterations_with(problem, *layout, layout->schur_inverse()), 13);

  // A rigid body is left to the Krylov method.
  auto& bodies = problem.system.near_null_space.body_of_row;
  std::fill(bodies.begin(), bodies.end(), -1);
  EXPECT_FALSE(schur_stencil(problem.system, *solid_inverse(problem), {}).has_value());
}

TEST(Multigrid, StiffVolumesConductNothing) {
  Case<3> scene(cube<3>(16), 1.0 / 16);
  Problem<3> problem(scene, plate<3>(1.0 / 16, 7.1 / 16));
  make_sheet(problem);
  // Springs between the nodes, which translations do not feel.
  const CrsMatrix& mass = *assembled(problem.system.solid_block);
  auto rows = rows_of(mass);
  for (std::size_t node = 0; node + 1 < rows.size(); ++node) {
    const GlobalIndex one = rows[node].front().column, other = rows[node + 1].front().column;
    const double stiffness = 1e4 * rows[node].front().value;
    rows[node].insert(rows[node].end(), {{one, stiffness}, {other, -stiffness}});
    rows[node + 1].insert(rows[node + 1].end(), {{one, -stiffness}, {other, stiffness}});
  }
  problem.system.solid_block =
      as_operator(RCP<const CrsMatrix>(matrix_from_rows(mass.getRowMap(), rows)));
  EXPECT_FALSE(conducting_through_sheets(problem.system, {}).has_value());
}

TEST(Multigrid, RefusesWhatItCannotHalve) {
  Case<2> scene({40, 40}, 1.0 / 40);
  scene.all_periodic();
  const Problem<2> problem(scene, nullptr);
  EXPECT_NE(PressureLayout::why_not(problem.system).find("multiple of 16"), std::string::npos);
}

}  // namespace
}  // namespace lockstep::test
