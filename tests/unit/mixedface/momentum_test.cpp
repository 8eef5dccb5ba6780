// Momentum exchanged by solids and lumped fluid: equal and opposite.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <random>

#include "linear/symmetry_check.hpp"
#include "support/dense.hpp"
#include "unit/mixedface/bodies.hpp"

namespace lockstep::test {
namespace {

/// Row 2 of Eq. 16 for some pressure, velocities before and after: the change of the momentum of
/// solids and mixed faces, less what the pressure on the mixed faces and prescribed solids gave.
Momentum<2> defect_of_row_2(CoupledCase<2>& c) {
  c.fluid.set_velocity([](int axis, const Point<2>& x) {
    return axis == 0 ? 2 * x.y() - x.x() * x.x() : 1 + x.x() * x.y();
  });
  const auto pressure = make_vector(c.fluid.pressure_map());
  pseudo_random(*pressure, 7);
  const std::vector<double> before = c.fluid.coupled_velocity();
  const RCP<Vector> momentum = c.solids.explicit_momentum(0, 0.1);
  const RCP<Vector> rhs = c.system.lumped_momentum(*momentum);
  c.system.blocks(0.1).coupling_transposed()->apply(*pressure, *rhs, Teuchos::NO_TRANS, -1, 1);
  const Eigen::MatrixXd block = dense(c.system.blocks(0.1).solid_block());
  const auto velocity = distributed(block.llt().solve(dense(*rhs)), c.solids.map());
  const std::vector<double> after = c.coupling.velocity(*velocity);

  const auto final = make_vector(c.solids.map());
  apply(*c.solids.mass(), *velocity, *final);
  Momentum<2> defect = c.solids.momentum(*final) + c.system.lumped_fluid_momentum(after);
  defect -= c.solids.momentum(*momentum) + c.system.lumped_fluid_momentum(before);
  defect -= total_of(c.coupling.prescribed_impulses(before, after, *pressure, {}));
  const Eigen::VectorXd p = dense(*pressure);
  for (const auto& face : c.fluid.faces()) {
    if (face.kind != FakeFluid<2>::FaceKind::coupled)
      continue;
    double jump = 0;
    for (int side = 0; side < 2; ++side) {
      if (face.volume.sides[side].unknown != no_index)
        jump += (side == 0 ? -1 : 1) * p[face.volume.sides[side].unknown];
    }
    defect.add(face.volume.center, face.volume.direction, face.volume.area * jump);
  }
  return defect;
}

/// A shell round a rectangle and a body, with one column of fluid cells between them. The dual
/// cells between that column, x = 0.45, and the body hold both surfaces.
std::vector<FakeBody<2>> neighbours() {
  FakeBody<2> left, right;
  left.surface = rectangle({0.21, 0.33}, {0.4495, 0.72});
  left.closed = false;
  left.center = {0.35, 0.5};
  left.velocity = {1, -1};
  left.angular_velocity[0] = 0.5;
  right.surface = rectangle({0.53, 0.28}, {0.81, 0.63});
  right.center = {0.65, 0.45};
  right.mass = 3;
  return {left, right};
}

}  // namespace

TEST(SharedRows, TwoBodiesConserveMomentum) {
  for (Lumping lumping : {Lumping::diagonal, Lumping::consistent}) {
    MixedFaceOptions options;
    options.lumping = lumping;
    CoupledCase<2> c(unit_tank<2>(10), fake_solids<2>({neighbours()}), options);
    const GatheredFaces<2> faces = gathered_faces(c);
    int n_shared = 0;
    for (int f = 0; f < faces.weights.rows(); ++f)
      n_shared += faces.weights.row(f).head(3).any() && faces.weights.row(f).tail(3).any() ? 1 : 0;
    EXPECT_GE(n_shared, 3);
    const Momentum<2> defect = defect_of_row_2(c);
    EXPECT_LT(defect.linear.norm(), 1e-13);
    EXPECT_LT(defect.angular.norm(), 1e-13);
  }
}

TEST(SharedRows, BodyAndPrescribedSolidConserveMomentum) {
  for (Lumping lumping : {Lumping::diagonal, Lumping::consistent}) {
    MixedFaceOptions options;
    options.lumping = lumping;
    auto bodies = neighbours();
    bodies[1].kind = FakeBody<2>::Kind::prescribed;
    bodies[1].velocity = {-2, 0.5};
    bodies[1].angular_velocity[0] = 3;
    CoupledCase<2> c(unit_tank<2>(10), fake_solids<2>({bodies}), options);
    const Momentum<2> defect = defect_of_row_2(c);
    EXPECT_LT(defect.linear.norm(), 1e-13);
    EXPECT_LT(defect.angular.norm(), 1e-13);
  }
}

// With W that carries rotations, too, whose rows have negative entries.
TEST(SharedRows, NodesConserveLinearMomentum) {
  for (SoftWeights weights :
       {SoftWeights::barycentric, SoftWeights::area, SoftWeights::rigid_motions}) {
    for (Lumping lumping : {Lumping::diagonal, Lumping::consistent}) {
      MixedFaceOptions options;
      options.lumping = lumping;
      options.soft_weights = weights;
      auto bodies = neighbours();
      bodies[0].kind = FakeBody<2>::Kind::nodal;
      CoupledCase<2> c(unit_tank<2>(10), fake_solids<2>({bodies}), options);
      EXPECT_LT(defect_of_row_2(c).linear.norm(), 1e-13);
    }
  }
}

/// One 3D body with random faces around it: what M̃ says the momentum is, against what solid and
/// faces have. Returns the relative linear and angular defects.
template <int dim>
std::pair<double, double> lumping_defect(Lumping lumping, int seed) {
  const Communicator comm = Tpetra::getDefaultComm();
  FakeBody<dim> body = ball<dim>(0.3, Point<dim>::Constant(0.5));
  body.inertia = 0.05;
  const SolidSystem<dim> solids(fake_solids<dim>({{body}}), comm);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<ControlVolume<dim>> volumes;
  std::vector<std::vector<SurfaceShare<dim>>> shares;
  std::vector<double> masses;
  for (int f = 0; f < 30; ++f) {
    ControlVolume<dim> volume;
    volume.direction = f % dim;
    for (int a = 0; a < dim; ++a)
      volume.center[a] = unit(random);
    SurfaceShare<dim> share;
    share.weight = 1;
    share.solid = 0;
    share.point.simplex = 0;
    const double mass = 0.2 * unit(random);
    if (f % comm->getSize() != comm->getRank())
      continue;
    volumes.push_back(volume);
    shares.push_back({share});
    masses.push_back(mass);
  }
  const auto added =
      assemble_triplets(added_mass_triplets<dim>(volumes, shares, solids, masses, lumping),
                        solids.map(), solids.map());
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(solids.map()->getGlobalNumElements());
  for (int k = 0; k < dim + n_rotations<dim>; ++k)
    velocity[k] = 2 * unit(random) - 1;
  // The solve conserves M̃ V, about the body's centre.
  const Eigen::VectorXd conserved =
      (dense(solids.mass()) + dense(RCP<const CrsMatrix>(added))) * velocity;
  Point<dim> linear = body.mass * velocity.head(dim);
  AngularVector<dim> angular = body.inertia * velocity.segment(dim, n_rotations<dim>);
  Momentum<dim> lumped;
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const Point<dim> arm = volumes[f].center - body.center;
    const AngularVector<dim> spin = velocity.segment(dim, n_rotations<dim>);
    const Point<dim> v = velocity.head(dim) + rotate<dim>(spin, arm);
    lumped.add(arm, volumes[f].direction, masses[f] * v[volumes[f].direction]);
  }
  lumped = sum_over_ranks<dim>(lumped, comm);
  linear += lumped.linear;
  angular += lumped.angular;
  return {(conserved.head(dim) - linear).norm() / linear.norm(),
          (conserved.segment(dim, n_rotations<dim>) - angular).norm() / angular.norm()};
}

TEST(PaperDiagonal, LosesMomentumWhereTheFullBlockDoesNot) {
  double linear = 0, angular = 0;
  const int n = 8;
  for (int seed = 1; seed <= n; ++seed) {
    const auto full = lumping_defect<3>(Lumping::diagonal, seed);
    EXPECT_LT(full.first, 1e-14);
    EXPECT_LT(full.second, 1e-13);
    const auto full_2d = lumping_defect<2>(Lumping::diagonal, seed);
    EXPECT_LT(full_2d.first, 1e-14);
    const auto literal = lumping_defect<3>(Lumping::paper_diagonal, seed);
    linear += literal.first / n;
    angular += literal.second / n;
  }
  RecordProperty("linear defect", std::to_string(linear));
  RecordProperty("angular defect", std::to_string(angular));
  EXPECT_GT(linear, 0.02);
  EXPECT_GT(angular, 0.02);
}

// Where the cross terms vanish, by symmetry, the literal form is the full one.
TEST(PaperDiagonal, IsTheFullBlockForASymmetricBody) {
  MixedFaceOptions options;
  CoupledCase<2> full(unit_tank<2>(10), fake_solids<2>({{ball<2>(0.24, {0.5, 0.5})}}), options);
  options.lumping = Lumping::paper_diagonal;
  CoupledCase<2> literal(unit_tank<2>(10), fake_solids<2>({{ball<2>(0.24, {0.5, 0.5})}}), options);
  const Eigen::MatrixXd expected = dense(full.coupling.added_mass());
  EXPECT_LT((dense(literal.coupling.added_mass()) - expected).norm(), 1e-12 * expected.norm());
  EXPECT_EQ(dense(literal.system.blocks(0.1).solid_block()).llt().info(), Eigen::Success);
}

}  // namespace lockstep::test
