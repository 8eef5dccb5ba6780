// The stack of solid models: numbering, padding, matrix-free models.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/solid_totals.hpp"
#include "support/coupled_case.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

FakeBody<2> sliding_plate() {
  FakeBody<2> body;
  body.name = "plate";
  body.closed = false;
  body.surface = polyline({{1, 0}, {1, 1}}, false);
  body.center = {1, 0.5};
  body.mass = 3;
  body.inertia = 0.25;
  body.velocity = {1, 2};
  body.angular_velocity[0] = 3;
  return body;
}

/// Two nodes of 1 kg each.
FakeBody<2> loose_thread() {
  FakeBody<2> body;
  body.name = "thread";
  body.kind = FakeBody<2>::Kind::nodal;
  body.closed = false;
  body.surface = polyline({{2, 0}, {2, 2}}, false);
  body.mass = 2;
  body.velocity = {-1, 5};
  return body;
}

/// A solid model with the functions that every one must write, and nothing more.
class BareSolid : public SolidModel<2> {
 public:
  explicit BareSolid(const FakeBody<2>& body) : inner_({body}, {}, Tpetra::getDefaultComm()) {}
  std::string name() const override { return "bare"; }
  const std::vector<SolidDescription>& solids() const override { return inner_.solids(); }
  const SurfaceMesh<2>& surface() const override { return inner_.surface(); }
  void velocity_row(const SurfacePoint<2>& point, const Point<2>& x,
                    VelocityRow<2>& row) const override {
    inner_.velocity_row(point, x, row);
  }
  Point<2> effective_velocity(const SurfacePoint<2>& point, const Point<2>& x) const override {
    return inner_.effective_velocity(point, x);
  }
  RCP<const Map> dof_map() const override { return inner_.dof_map(); }
  RCP<const LinearOperator> mass() const override { return inner_.mass(); }
  void explicit_momentum(double time, double dt, Vector& momentum) const override {
    inner_.explicit_momentum(time, dt, momentum);
  }
  RCP<const Vector> velocity() const override { return inner_.velocity(); }
  void set_velocity(const Vector& velocity) override { inner_.set_velocity(velocity); }
  void move(const Vector& velocity, double time, double dt) override {
    inner_.move(velocity, time, dt);
  }
  std::vector<SolidState<2>> states() const override { return inner_.states(); }

 private:
  FakeSolid<2> inner_;
};

FakeBox<2> small_tank() {
  FakeBox<2> box;
  box.n_cells = {6, 4};
  box.spacing = 0.5;
  return box;
}

}  // namespace

TEST(SolidSystem, ModelsFollowOneAnother) {
  const Communicator comm = Tpetra::getDefaultComm();
  const SolidSystem<2> solids(fake_solids<2>({{sliding_plate()}, {loose_thread()}}), comm);
  EXPECT_EQ(solids.n_unknowns(), 3 + 4);
  EXPECT_GE(solids.map()->getNodeNumElements(), 1u);
  EXPECT_EQ(solids.solids()[1].simplex_begin, 1);
  EXPECT_EQ(solids.solids()[1].vertex_begin, 2);
  EXPECT_EQ(solids.solids()[1].model, 1);
  const Eigen::VectorXd velocity = dense(*solids.velocity());
  Eigen::VectorXd expected(7);
  expected << 1, 2, 3, -1, 5, -1, 5;
  EXPECT_EQ((velocity.head(7) - expected).norm(), 0);

  // A quarter up the thread: nodes weigh 3/4 and 1/4; ids of the second model start at 3.
  SurfacePoint<2> point;
  point.simplex = 1;
  point.barycentric = {0.75, 0.25};
  VelocityRow<2> row;
  solids.velocity_row(point, {2, 0.5}, row);
  EXPECT_EQ(row.dofs, (std::vector<GlobalIndex>{3, 4, 5, 6}));
  EXPECT_EQ(row.coefficients[2], Point<2>(0.25, 0));

  // Momentum: plate 3 kg at (1, 0.5) with spin 0.25 * 3; thread 1 kg at (2, 0) and (2, 2).
  const auto momentum = solids.momentum_of_each(*solids.explicit_momentum(0, 0.1));
  EXPECT_EQ(momentum[0].linear, Point<2>(3, 6));
  EXPECT_DOUBLE_EQ(momentum[0].angular[0], 1 * 6 - 0.5 * 3 + 0.75);
  EXPECT_EQ(momentum[1].linear, Point<2>(-2, 10));
  EXPECT_DOUBLE_EQ(momentum[1].angular[0], 2 * 10 + 2 * 1);
}

TEST(SolidSystem, DoesWithoutSideInterfaces) {
  std::vector<std::unique_ptr<SolidModel<2>>> models = fake_solids<2>({{sliding_plate()}});
  EXPECT_TRUE(
      is_audited(SolidSystem<2>(fake_solids<2>({{sliding_plate()}}), Tpetra::getDefaultComm())));
  models.push_back(std::make_unique<BareSolid>(loose_thread()));
  SolidSystem<2> solids(std::move(models), Tpetra::getDefaultComm());
  EXPECT_FALSE(is_audited(solids));
  const RCP<Vector> momentum = solids.explicit_momentum(0, 0.1);
  EXPECT_EQ(momentum->norm1(), 3 * (1 + 2) + 0.25 * 3 + (1 + 5) * 2);
  const auto of_each = solids.momentum_of_each(*momentum);
  ASSERT_EQ(of_each.size(), 2u);
  EXPECT_EQ(of_each[0].linear, Point<2>(3, 6));
  EXPECT_EQ(of_each[1].linear, Point<2>(0, 0));
  EXPECT_EQ(external_impulse(solids, 0, 0.1).linear, Point<2>(0, 0));
  EXPECT_FALSE(has_implicit_forces(solids));
  EXPECT_FALSE(solids.linearise(0.1, *solids.velocity()));
  EXPECT_TRUE(linearisation(solids).is_null());
  EXPECT_TRUE(near_null_space(solids, Teuchos::null).empty());
  EXPECT_EQ(n_clamped_elements(solids), 0);
}

TEST(SolidSystem, StackedVectorsReachTheirModels) {
  const Communicator comm = Tpetra::getDefaultComm();
  SolidSystem<2> solids(fake_solids<2>({{sliding_plate()}, {loose_thread()}}), comm);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(solids.map()->getGlobalNumElements());
  values.head(7) << 1, 0, 0, 0, 2, 0, 4;
  solids.set_velocity(*distributed(values, solids.map()));
  EXPECT_EQ((dense(*solids.velocity()) - values).norm(), 0);
  EXPECT_EQ(solids.states()[0].velocity, Point<2>(1, 0));
  solids.move(*solids.velocity(), 0, 0.5);
  const auto snapshot = solids.snapshot();
  EXPECT_EQ(snapshot->mesh().vertices[0], Point<2>(1.5, 0));
  EXPECT_EQ(snapshot->mesh().vertices[3], Point<2>(2, 4));
  SurfacePoint<2> point;
  point.simplex = 1;
  point.barycentric = {0.5, 0.5};
  EXPECT_EQ(solids.effective_velocity(point, {2, 2}), Point<2>(0, 3));
}

TEST(SolidSystem, RanksWithoutDofsArePadded) {
  const Communicator comm = Tpetra::getDefaultComm();
  FakeSolidOptions<2> options;
  options.gravity = {0, -10};
  for (bool matrix_free : {false, true}) {
    options.matrix_free = matrix_free;
    const SolidSystem<2> solids(fake_solids<2>({{sliding_plate()}}, options), comm);
    // Three dofs on four ranks leave the first with none.
    const int n_padding = comm->getSize() == 4 ? 1 : 0;
    EXPECT_EQ(solids.map()->getGlobalNumElements(), 3u + n_padding);
    EXPECT_GE(solids.map()->getNodeNumElements(), 1u);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Ones(3 + n_padding);
    diagonal.head(3) << 3, 3, 0.25;
    const Eigen::MatrixXd expected = diagonal.asDiagonal();
    EXPECT_EQ((dense(solids.solid_block(Teuchos::null, 0.1)) - expected).norm(), 0);
    EXPECT_TRUE(solids.reduction().is_identity());
    // M_S^-1 (M_S V + dt f) = V + dt g.
    const Eigen::VectorXd faster = dense(*solids.velocity_of(*solids.explicit_momentum(0, 0.5)));
    EXPECT_LT((faster.head(3) - Eigen::Vector3d(1, 2 - 5, 3)).norm(), 1e-13);
  }
}

TEST(SolidSystem, TheInverseOfTheMassStaysAsLongAsTheMass) {
  SolidSystem<2> solids(fake_solids<2>({{sliding_plate()}, {loose_thread()}}),
                        Tpetra::getDefaultComm());
  const auto inverse = solids.mass_inverse();
  solids.begin_step(0, 0.5);
  solids.move(*solids.velocity(), 0, 0.5);
  EXPECT_EQ(solids.mass_inverse(), inverse);  // lumped at nodes and of a plate that does not turn
  const Eigen::MatrixXd product =
      dense(solids.solid_block(Teuchos::null, 0)) * dense(solids.mass_inverse());
  EXPECT_LT((product - Eigen::MatrixXd::Identity(product.rows(), product.cols())).norm(), 1e-14);
}

TEST(SolidSystem, SystemWithoutUnknownsStillHasRows) {
  FakeBody<2> fixed = sliding_plate();
  fixed.kind = FakeBody<2>::Kind::prescribed;
  CoupledCase<2> c(small_tank(), fake_solids<2>({{fixed}}));
  EXPECT_FALSE(c.solids.has_unknowns());
  EXPECT_GE(c.solids.map()->getNodeNumElements(), 1u);
  EXPECT_FALSE(c.system.blocks(0.1).has_solid());
  EXPECT_TRUE(c.coupling.coupling_transposed().is_null());
  // The plate blocks two faces with 1 m/s: 0.5 m each.
  c.fluid.set_velocity([](int, const Point<2>&) { return 0; });
  const auto rhs = make_vector(c.fluid.pressure_map());
  c.coupling.add_prescribed_divergence(*rhs);
  const Eigen::VectorXd values = dense(*rhs);
  // Velocity (1, 2) with spin 3 about (1, 0.5): 1 - 3 (y - 0.5) at y = 0.25 and 0.75.
  EXPECT_NEAR(values[1], -0.5 * 1.75, 1e-13);
  EXPECT_NEAR(values[2], 0.5 * 1.75, 1e-13);
  EXPECT_NEAR(values[7], -0.5 * 0.25, 1e-13);
}

TEST(SolidSystem, MatrixFreeModelsGiveTheSameBlock) {
  FakeBody<2> locked = sliding_plate();
  locked.locked = {1};
  FakeSolidOptions<2> options;
  options.damping = 2;
  CoupledCase<2> assembled_case(small_tank(),
                                fake_solids<2>({{locked}, {loose_thread()}}, options));
  options.matrix_free = true;
  CoupledCase<2> free_case(small_tank(), fake_solids<2>({{locked}, {loose_thread()}}, options));
  const double dt = 0.1;
  EXPECT_FALSE(assembled(assembled_case.system.blocks(dt).solid_block()).is_null());
  EXPECT_TRUE(assembled(free_case.system.blocks(dt).solid_block()).is_null());
  const Eigen::MatrixXd expected = dense(assembled_case.system.blocks(dt).solid_block());
  const Eigen::MatrixXd found = dense(free_case.system.blocks(dt).solid_block());
  EXPECT_LT((found - expected).norm(), 1e-13);
  EXPECT_GT(expected.diagonal()[3], 1 + 2 * dt + 0.1);  // node mass, damping and lumped fluid
  EXPECT_LT((dense(free_case.solids.full_block(Teuchos::null, dt)) -
             dense(assembled_case.solids.full_block(Teuchos::null, dt)))
                .norm(),
            1e-13);
}

}  // namespace lockstep::test
