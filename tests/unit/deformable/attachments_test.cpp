// Deformable bodies glued to rigid ones.
#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "rigid/rigid_bodies.hpp"
#include "rigid/rigid_parameters.hpp"
#include "support.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

using namespace test;

ParameterList rigid_list(const std::string& content) {
  return scene_list(content, rigid_body_parameters<3>());
}

/// A beam, cells of 1/8, whose left end is glued into a turning rigid box.
struct Glued {
  explicit Glued(const std::string& carrier = "hub", const std::string& size = "1, 0.25, 0.25",
                 const std::string& glued_to = "-0.25")
      : system(models(carrier, size, glued_to, rigid, beam), world()) {}
  static std::vector<std::unique_ptr<SolidModel<3>>> models(const std::string& carrier,
                                                            const std::string& size,
                                                            const std::string& glued_to,
                                                            RigidBodies<3>*& rigid,
                                                            DeformableSolids<3>*& beam) {
    auto hub = make_rigid_bodies<3>(
        {{"hub",
          rigid_list(geometry("box", numbers("Size", "0.5, 0.5, 0.5")) + number("Density", "3") +
                     numbers("Position", "0.1, 0, 0") + numbers("Velocity", "0.3, 0, 0.1") +
                     numbers("Angular Velocity", "0, 1, 2"))}},
        0.25, Point<3>::Zero(), world(), 0);
    std::vector<DeformableBody<3>> bodies;
    bodies.push_back(body<3>(
        box(size, "0.125") + material("corotated", "2000") + number("Density", "2") +
            number("Viscosity", "0.5") + text("Mass", "consistent") +
            text("Time Integration", "fully-implicit") + numbers("Position", "0.5, 0, 0") +
            list("Attachments",
                 list("root", numbers("Lower", "-0.5, -1, -1") +
                                  numbers("Upper", glued_to + ", 1, 1") + text("Solid", carrier))),
        "beam"));
    auto soft = std::make_unique<DeformableSolids<3>>("deformable body", std::move(bodies),
                                                      Point<3>::Zero(), world());
    rigid = hub.get();
    beam = soft.get();
    std::vector<std::unique_ptr<SolidModel<3>>> all;
    all.push_back(std::move(hub));
    all.push_back(std::move(soft));
    return all;
  }

  RCP<Vector> solved(double dt, const Vector& momentum) const {
    return system.velocity_of(momentum, dt, system.reduction());
  }
  void step(double time, double dt) {
    system.begin_step(time, dt);
    system.move(*solved(dt / 2, *system.explicit_momentum(time, dt / 2)), time, dt);
    system.set_velocity(*solved(dt, *system.explicit_momentum(time, dt)));
  }
  Momentum<3> momentum() const {
    const auto q = make_vector(system.map());
    apply(*system.mass(), *system.velocity(), *q);
    return system.momentum(*q);
  }

  RigidBodies<3>* rigid = nullptr;
  DeformableSolids<3>* beam = nullptr;
  SolidSystem<3> system;
};

TEST(Attachments, NodesStayWhereTheyAreGluedWhileTheBodyTurns) {
  Glued glued;
  std::vector<Point<3>> start;
  for (const auto& node : glued.beam->attachments())
    start.push_back(node.position);
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(start.size())), 27);
  const auto corner_before = glued.rigid->surface().vertices;
  for (int i = 0; i < 20; ++i)
    glued.step(0.1 * i, 0.1);
  // Each keeps its distance from every vertex of the hub, which has turned.
  const auto& corner = glued.rigid->surface().vertices;
  EXPECT_GT((corner[1] - corner[0] - corner_before[1] + corner_before[0]).norm(), 0.01);
  const auto nodes = glued.beam->attachments();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t v = 0; v < corner.size(); ++v) {
      EXPECT_NEAR((nodes[n].position - corner[v]).norm(), (start[n] - corner_before[v]).norm(),
                  1e-12);
    }
  }
}

TEST(Attachments, MomentumIsThatOfAllNodesAndIsKept) {
  Glued glued;
  glued.step(0, 0.05);
  // Both models' own momenta, from the velocities they were handed.
  Momentum<3> own;
  for (int m = 0; m < 2; ++m) {
    const SolidModel<3>& part = glued.system.model(m);
    const auto q = make_vector(part.dof_map());
    apply(*part.mass(), *part.velocity(), *q);
    own += part.audit()->momentum_of_each(*q)[0];
  }
  const Momentum<3> total = glued.momentum();
  EXPECT_LE((total.linear - own.linear).norm(), 1e-13);
  EXPECT_LE((total.angular - own.angular).norm(), 1e-13);
  for (int i = 1; i < 10; ++i) {
    glued.step(0.05 * i, 0.05);
    // Elastic forces at the present positions give neither momentum nor angular momentum.
    const auto before = glued.system.momentum(*glued.system.explicit_momentum(0, 0));
    const auto pushed = glued.system.momentum(*glued.system.explicit_momentum(0, 0.05));
    EXPECT_LE((pushed.linear - before.linear).norm(), 1e-13);
    EXPECT_LE((pushed.angular - before.angular).norm(), 1e-13);
  }
  EXPECT_LE((glued.momentum().linear - total.linear).norm(), 1e-12);
}

TEST(Attachments, BlockIsSymmetricAndNodesAreNoUnknowns) {
  Glued glued;
  const Eigen::MatrixXd block = dense(glued.system.solid_block(Teuchos::null, 0.1));
  EXPECT_LE((block - block.transpose()).norm(), 1e-12 * block.norm());
  EXPECT_GT(Eigen::VectorXd(block.selfadjointView<Eigen::Lower>().eigenvalues()).minCoeff(), 0);
  const Reduction& reduction = glued.system.reduction();
  EXPECT_EQ(
      dense(*reduction.unknowns()).sum(),
      6 + 3 * (body<3>(box("1, 0.25, 0.25", "0.125") + material("linear") + number("Density", "1"))
                   .n_nodes() -
               27));
  // A rigid motion of all costs no force, its mass is that of both.
  const Eigen::MatrixXd mass = dense(glued.system.mass());
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(mass.rows());
  for (GlobalIndex i = 0; i < mass.rows(); ++i)
    shift[i] = i == 0 || (i >= 6 && (i - 6) % 3 == 0);
  EXPECT_NEAR(shift.dot(mass * shift), 3 * 0.125 + 2 * 0.0625, 1e-12);
  const Eigen::VectorXd unknowns = shift.cwiseProduct(dense(*reduction.unknowns()));
  EXPECT_NEAR(unknowns.dot(block * unknowns), 3 * 0.125 + 2 * 0.0625, 1e-9);
  const auto expanded = distributed(unknowns, glued.system.map());
  reduction.expand(*expanded);
  EXPECT_LE((dense(*expanded) - shift).norm(), 1e-13);
}

/// Four layers of 8 x 8 nodes: as many as a byte cannot count.
TEST(Attachments, AreKeptHoweverManyNodesThereAre) {
  const Glued glued("hub", "1, 0.875, 0.875", "-0.125");
  const auto n_attached = static_cast<GlobalIndex>(glued.beam->attachments().size());
  EXPECT_EQ(sum_all(world(), n_attached), 256);
  ASSERT_TRUE(glued.system.reduction().has_combinations());
  EXPECT_EQ(dense(*glued.system.reduction().unknowns()).sum(), 6 + 3 * (9 * 8 * 8 - 256));
}

TEST(Attachments, WantADynamicRigidBody) {
  EXPECT_THAT(error([] { Glued("hob"); }), ::testing::HasSubstr("\"hob\""));
  EXPECT_THAT(error([] { Glued("beam"); }), ::testing::HasSubstr("rigid and dynamic"));
}

}  // namespace
}  // namespace lockstep::test
