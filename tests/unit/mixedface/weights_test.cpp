// W: clipped areas by hand, and what its rows reproduce.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "support/dense.hpp"
#include "unit/mixedface/bodies.hpp"

namespace lockstep::test {

namespace {

/// x = 1.75 + (y - 0.5) / 2 from (1.75, 0.5) to (2.25, 1.5), then upright to (2.25, 2.0), in a box
/// of 4 x 3 cells of width 1.
CoupledCase<2> slanted_line(const MixedFaceOptions& options = {}) {
  FakeBox<2> box;
  box.n_cells = {4, 3};
  FakeBody<2> slant;
  slant.kind = FakeBody<2>::Kind::nodal;
  slant.closed = false;
  slant.surface = polyline({{1.75, 0.5}, {2.25, 1.5}, {2.25, 2.0}}, false);
  return CoupledCase<2>(box, fake_solids<2>({{slant}}), options);
}

}  // namespace

TEST(Weights, SlantedSegmentClippedByHand) {
  CoupledCase<2> c = slanted_line();
  const GatheredFaces<2> faces = gathered_faces(c);
  // Blocked: the lines y = 0.5 and 1.5 between x = 1.5 and 2.5.
  ASSERT_EQ(faces.volumes.size(), 2u);
  EXPECT_EQ(faces.volumes[0].center, Point<2>(2, 0.5));
  EXPECT_EQ(faces.volumes[1].center, Point<2>(2, 1.5));
  // Dual cell y in [-0.01, 1.01] (thickened by 1 %): the slanted segment from s = 0 to 0.51, whose
  // middle has s = 0.255; clipped at y = 1.01.
  Eigen::VectorXd row = Eigen::VectorXd::Zero(6);
  row[0] = 0.745;
  row[2] = 0.255;
  EXPECT_LT((faces.weights.row(0).transpose() - row).norm(), 1e-13);
  // Dual cell y in [0.99, 2.01]: slanted from s = 0.49 to 1, length 0.51 sqrt(1.25), middle 0.745;
  // upright all of its 0.5, middle between nodes 1 and 2.
  const double slanted = 0.51 * std::sqrt(1.25), upright = 0.5, total = slanted + upright;
  row << slanted * 0.255, 0, slanted * 0.745 + upright * 0.5, 0, upright * 0.5, 0;
  EXPECT_LT((faces.weights.row(1).transpose() - row / total).norm(), 1e-13);
}

// Section 5 to the letter: each node of a segment weighs by the segment's length in the dual cell,
// wherever that part of it lies.
TEST(Weights, AreaAloneWeighsBothNodesAlike) {
  MixedFaceOptions options;
  options.soft_weights = SoftWeights::area;
  CoupledCase<2> c = slanted_line(options);
  const GatheredFaces<2> faces = gathered_faces(c);
  ASSERT_EQ(faces.volumes.size(), 2u);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(6);
  row[0] = row[2] = 0.5;
  EXPECT_LT((faces.weights.row(0).transpose() - row).norm(), 1e-13);
  const double slanted = 0.51 * std::sqrt(1.25), upright = 0.5, total = slanted + upright;
  row << slanted / 2, 0, (slanted + upright) / 2, 0, upright / 2, 0;
  EXPECT_LT((faces.weights.row(1).transpose() - row / total).norm(), 1e-13);
}

template <int dim>
void check_rows_reproduce_motions(double radius) {
  const int n_cells = dim == 2 ? 12 : 6;
  const Point<dim> center = shifted_center<dim>(1, 1. / n_cells);
  for (auto rule : {MixedRule::voxel, MixedRule::every_cut_cell}) {
    MixedFaceOptions options;
    options.rule = rule;
    CoupledCase<dim> nodal(
        unit_tank<dim>(n_cells),
        fake_solids<dim>({{ball<dim>(radius, center, FakeBody<dim>::Kind::nodal)}}), options);
    const GatheredFaces<dim> nodes = gathered_faces(nodal);
    ASSERT_GT(nodes.volumes.size(), 10u);
    EXPECT_GE(nodes.weights.minCoeff(), 0);
    for (std::size_t f = 0; f < nodes.volumes.size(); ++f) {
      // Translations: only this face's axis, and the row sums to one.
      for (int a = 0; a < dim; ++a) {
        double sum = 0;
        for (int k = a; k < nodes.weights.cols(); k += dim)
          sum += nodes.weights(static_cast<int>(f), k);
        EXPECT_NEAR(sum, a == nodes.volumes[f].direction ? 1 : 0, 1e-13);
      }
    }
    CoupledCase<dim> rigid(unit_tank<dim>(n_cells), fake_solids<dim>({{ball<dim>(radius, center)}}),
                           options);
    const GatheredFaces<dim> body = gathered_faces(rigid);
    EXPECT_EQ(body.volumes.size(), nodes.volumes.size());
    Eigen::VectorXd motion(dim + n_rotations<dim>);
    for (int k = 0; k < motion.size(); ++k)
      motion[k] = 1 + 0.7 * k * k;
    const AngularVector<dim> spin = motion.template tail<n_rotations<dim>>();
    for (std::size_t f = 0; f < body.volumes.size(); ++f) {
      const auto& volume = body.volumes[f];
      const Point<dim> v = motion.template head<dim>() + rotate<dim>(spin, volume.center - center);
      EXPECT_NEAR(body.weights.row(static_cast<int>(f)).dot(motion), v[volume.direction], 1e-13);
    }
  }
}

TEST(Weights, RowsReproduceTranslationsAndRigidMotions2d) {
  check_rows_reproduce_motions<2>(0.22);
}
TEST(Weights, RowsReproduceTranslationsAndRigidMotions3d) {
  check_rows_reproduce_motions<3>(0.25);
}

/// W with local rotations: rows reproduce rigid motions at the faces' centres, and their transposes
/// hand on forces with their torques.
template <int dim>
void check_carried_rows(double radius) {
  const int n_cells = dim == 2 ? 12 : 6;
  const Point<dim> center = shifted_center<dim>(1, 1. / n_cells);
  const FakeBody<dim> body = ball<dim>(radius, center, FakeBody<dim>::Kind::nodal);
  MixedFaceOptions options;
  options.soft_weights = SoftWeights::rigid_motions;
  options.lumping = Lumping::consistent;  // then faces move by W itself
  CoupledCase<dim> c(unit_tank<dim>(n_cells), fake_solids<dim>({{body}}), options);
  const GatheredFaces<dim> faces = gathered_faces(c);
  ASSERT_GT(faces.volumes.size(), 10u);
  for (std::size_t f = 0; f < faces.volumes.size(); ++f) {
    Momentum<dim> taken;
    for (std::size_t v = 0; v < body.surface.vertices.size(); ++v) {
      taken.add(body.surface.vertices[v],
                faces.weights.row(static_cast<int>(f)).template segment<dim>(dim * v).transpose());
    }
    const auto& volume = faces.volumes[f];
    const Point<dim> unit = Point<dim>::Unit(volume.direction);
    EXPECT_LT((taken.linear - unit).norm(), 1e-12);
    EXPECT_LT((taken.angular - cross<dim>(volume.center, unit)).norm(), 1e-12);
  }
}

TEST(Weights, CarriedRowsReproduceRigidMotions2d) {
  check_carried_rows<2>(0.22);
}
TEST(Weights, CarriedRowsReproduceRigidMotions3d) {
  check_carried_rows<3>(0.25);
}

/// Moving a closed voxel surface rigidly changes no volume: B^T chi = 0 for the fluid around it.
template <int dim>
void check_voxel_surface_closes() {
  const int n_cells = dim == 2 ? 12 : 6;
  for (int k = 0; k < 4; ++k) {
    CoupledCase<dim> c(unit_tank<dim>(n_cells),
                       fake_solids<dim>({{ball<dim>(0.24, shifted_center<dim>(k, 1. / n_cells))}}));
    const auto ones = make_vector(c.fluid.pressure_map());
    ones->putScalar(1);
    const auto sums = make_vector(c.solids.map());
    c.coupling.coupling_transposed()->apply(*ones, *sums);
    EXPECT_LT(sums->normInf(), 1e-14);
    const Eigen::MatrixXd bt = dense(c.coupling.coupling_transposed());
    EXPECT_GT(bt.cwiseAbs().rowwise().sum().head(dim + n_rotations<dim>).minCoeff(), 0.03);
  }
}

TEST(Weights, ClosedVoxelSurfacePushesNothingAsAWhole2d) {
  check_voxel_surface_closes<2>();
}
TEST(Weights, ClosedVoxelSurfacePushesNothingAsAWhole3d) {
  check_voxel_surface_closes<3>();
}

// The blocks do not depend on the number of ranks: the last figure below is that of one rank.
TEST(Weights, BlocksAreTheSameOnAnyNumberOfRanks) {
  FakeBody<2> plate;
  plate.kind = FakeBody<2>::Kind::nodal;
  plate.closed = false;
  plate.surface = polyline({{0.15, 0.8}, {0.5, 0.86}, {0.93, 0.79}}, false);
  CoupledCase<2> c(unit_tank<2>(12), fake_solids<2>({{ball<2>(0.24, {0.48, 0.43})}, {plate}}));
  const Eigen::MatrixXd bt = dense(c.coupling.coupling_transposed()).topRows(9);
  const Eigen::MatrixXd added = dense(c.coupling.added_mass()).topLeftCorner(9, 9);
  // The whole product on every rank, from the gathered faces.
  const GatheredFaces<2> faces = gathered_faces(c);
  Eigen::MatrixXd expected_bt = Eigen::MatrixXd::Zero(9, bt.cols());
  Eigen::MatrixXd expected_mass = Eigen::MatrixXd::Zero(9, 9);
  for (std::size_t f = 0; f < faces.volumes.size(); ++f) {
    const Eigen::VectorXd row = faces.weights.row(static_cast<int>(f)).transpose();
    const auto& sides = faces.volumes[f].sides;
    for (int side = 0; side < 2; ++side) {
      if (sides[side].unknown != no_index)
        expected_bt.col(sides[side].unknown) += (side == 0 ? -1 : 1) * faces.volumes[f].area * row;
    }
    const double m = faces.masses[static_cast<int>(f)];
    expected_mass.topLeftCorner(3, 3) += m * row.head(3) * row.head(3).transpose();
    expected_mass.diagonal().tail(6) += m * row.tail(6);
  }
  EXPECT_LT((bt - expected_bt).norm(), 1e-14);
  EXPECT_LT((added - expected_mass).norm(), 1e-14);
  EXPECT_NEAR(bt.cwiseAbs().sum() + added.sum(), 4.1126104247090289, 1e-12);
}

}  // namespace lockstep::test
