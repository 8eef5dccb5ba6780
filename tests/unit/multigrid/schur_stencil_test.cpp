// Soft solids in the multigrid.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>

#include "linear/conjugate_gradients.hpp"
#include "linear/matrix_rows.hpp"
#include "multigrid/pressure_layout.hpp"
#include "multigrid/schur_stencil.hpp"
#include "multigrid/through_sheets.hpp"
#include "multigrid_cases.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep::test {
namespace {

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
  sum_over_ranks(a.map->getComm(), row_of_cell);
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
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block());
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
  problem.system.set_blocks(problem.system.pressure_block(), matrix_from_rows(map, coupling, a.map),
                            as_operator(RCP<const CrsMatrix>(matrix_from_rows(map, mass))));
  const auto motions = rcp(new MultiVector(map, dim == 2 ? 3 : 6));
  motions->getVectorNonConst(0)->putScalar(1);
  problem.system.near_null_space = {motions, std::vector<int>(n_nodes, 0), 1, Teuchos::null};
  problem.system.near_null_space.mass =
      lumped_mass(*problem.system.solid_block(), problem.system.near_null_space);
  return faces;
}

/// The coefficients of A with the faces of the sheet opened as those of the fluid are, against what
/// is found.
template <int dim>
void expect_faces_to_open(const Problem<dim>& problem, const std::vector<ClosedFace>& faces) {
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block());
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
  return exact_inverse(problem.system.solid_block(), "sheet");
}

/// Iterations of conjugate gradients on A + B C^-1 B^T of the sheet.
template <int dim>
int iterations_with(const Problem<dim>& problem, const PressureLayout& layout,
                    const RCP<const LinearOperator>& preconditioner) {
  const BlockSystem permuted = layout.permuted(problem.system);
  const CrsMatrix& coupling = *permuted.coupling_transposed();
  const auto inverse = solid_inverse(problem);
  Vector b(layout.map()), x(layout.map()), force(coupling.getRangeMap()), velocity(force.getMap());
  layout.to_layout(*right_hand_side(problem), b);
  const ConjugateGradientsRequest request{"test", 1e-8 * b.norm2(), 200, {}};
  return conjugate_gradients(
      [&](const Vector& u, Vector& v) {
        apply(*permuted.pressure_block(), u, v);
        coupling.apply(u, force);
        apply(*inverse, force, velocity);
        coupling.apply(velocity, v, Teuchos::TRANS, 1, 1);
      },
      [&](const Vector& u, Vector& v) { apply(*preconditioner, u, v); }, b, x, request);
}

/// A sheet of the fluid's own inertia: A + B C^-1 B^T is the operator of the box without it.
TEST(SchurStencil, ASheetThatGivesWay) {
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

TEST(SchurStencil, KernelsMultiplyByTheOperatorAlone) {
  for (const Index<3>& cells : {Index<3>{7, 13, 9}, Index<3>{17, 24, 33}}) {
    Case<3> scene(cells, 1.0 / 24);
    scene.side("x lower", "open");
    Problem<3> problem(scene, plate<3>(1.0 / 24, 5.1 / 24));
    make_sheet(problem);
    const auto layout = PressureLayout::make(problem.system, {}, nullptr);
    layout->build_schur_inverse(problem.system, *solid_inverse(problem));
    expect_products_of_the_operator(problem, *layout, layout->schur_kernels());
  }
}

TEST(SchurStencil, SolidsWithFluidOnOneSideConductNothing) {
  Case<3> scene(cube<3>(16), 1.0 / 16);
  Problem<3> problem(scene, plate<3>(1.0 / 16, 7.1 / 16));
  make_sheet(problem, 1, Sides::one);
  EXPECT_FALSE(conducting_through_sheets(problem.system, {}).has_value());
}

/// A cell beside it takes b_f sum b_g / m, in the unit of A the inverse of the relative mass.
template <int dim>
void expect_cells_to_yield(const Problem<dim>& problem, const std::vector<ClosedFace>& faces,
                           float expected_reaction) {
  const FaceCoefficients& a = *stencil_of(problem.system.pressure_block());
  const auto schur = schur_stencil(problem.system, *solid_inverse(problem), {});
  ASSERT_TRUE(schur.has_value());
  EXPECT_EQ(schur->lower, a.lower);
  std::vector<float> expected(a.row.size(), 0);
  for (const ClosedFace& face : faces)
    expected[face.upper_cell] = expected_reaction;
  EXPECT_EQ(schur->reaction, expected);
}

TEST(SchurStencil, ASolidWithFluidOnOneSideYields) {
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

TEST(SchurStencil, StiffVolumesConductNothing) {
  Case<3> scene(cube<3>(16), 1.0 / 16);
  Problem<3> problem(scene, plate<3>(1.0 / 16, 7.1 / 16));
  make_sheet(problem);
  // Springs between the nodes, which translations do not feel.
  const CrsMatrix& mass = *assembled(problem.system.solid_block());
  auto rows = rows_of(mass);
  for (std::size_t node = 0; node + 1 < rows.size(); ++node) {
    const GlobalIndex one = rows[node].front().column, other = rows[node + 1].front().column;
    const double stiffness = 1e4 * rows[node].front().value;
    rows[node].insert(rows[node].end(), {{one, stiffness}, {other, -stiffness}});
    rows[node + 1].insert(rows[node + 1].end(), {{one, -stiffness}, {other, stiffness}});
  }
  problem.system.set_blocks(
      problem.system.pressure_block(), problem.system.coupling_transposed(),
      as_operator(RCP<const CrsMatrix>(matrix_from_rows(mass.getRowMap(), rows))));
  EXPECT_FALSE(conducting_through_sheets(problem.system, {}).has_value());
}

}  // namespace
}  // namespace lockstep::test
