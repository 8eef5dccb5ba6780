// The model behind its interface: distribution, momentum, checkpoints; on any number of ranks.
#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <filesystem>
#include <limits>

#include "deformable/reading/register_deformable.hpp"
#include "output/checkpoint.hpp"
#include "support.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

using namespace test;

/// Two bodies, stretched and turning.
const std::vector<std::string> pair_of_bodies{
    box("1, 0.5, 0.5", "0.25") + material("corotated") + number("Density", "2") +
        numbers("Stretch", "1.2, 0.9, 1") + numbers("Velocity", "1, 0, 0") +
        numbers("Angular Velocity", "0, 0, 3") + number("Viscosity", "0.1") +
        text("Time Integration", "semi-implicit"),
    geometry("ball", number("Radius", "0.4") + number("Mesh Spacing", "0.2")) +
        material("neo-hookean") + number("Density", "3") + numbers("Position", "2, 1, 0") +
        numbers("Rotation", "0, 1, 0") + numbers("Stretch", "1, 1.1, 0.8") +
        text("Mass", "consistent")};

TEST(DeformableSolids, EveryNodeHasOneOwnerAndForcesDoNotDependOnTheRanks) {
  const auto solids = model<3>(pair_of_bodies);
  int n_nodes = 0;
  for (const auto& content : pair_of_bodies) {
    const auto whole = body<3>(content);
    std::vector<Point<3>> force(whole.position.size(), Point<3>::Zero());
    whole.elements[0]->add_elastic_forces(whole.position, whole.n_nodes(), force);
    for (int i = 0; i < solids->nodes().n_owned(); ++i) {
      const int n = solids->nodes().original(i) - n_nodes;
      if (n >= 0 && n < whole.n_nodes()) {
        EXPECT_EQ(solids->elastic_forces()[i], force[n]);
      }
    }
    n_nodes += whole.n_nodes();
  }
  EXPECT_EQ(solids->dof_map()->getGlobalNumElements(), 3u * n_nodes);
  if (world()->getSize() == 4) {
    EXPECT_GT(solids->nodes().n_owned(), n_nodes / 8);
  }
}

TEST(DeformableSolids, StatesAreThoseOfTheBodies) {
  const auto solids = model<3>(pair_of_bodies);
  const auto states = solids->states();
  ASSERT_EQ(states.size(), 2u);
  EXPECT_NEAR(states[0].mass, 0.5, 1e-13);
  EXPECT_NEAR(states[0].volume, 0.25 * 1.2 * 0.9, 1e-13);
  EXPECT_LE((states[0].velocity - Point<3>(1, 0, 0)).norm(), 1e-13);
  EXPECT_LE((states[0].angular_velocity - Point<3>(0, 0, 3)).norm(), 1e-12);
  EXPECT_GT(states[0].elastic_energy, 0);
  const double ball = 4. / 3 * 3.14159265358979 * 0.064;
  EXPECT_NEAR(states[1].mass, 3 * ball, 1e-12);
  EXPECT_NEAR(states[1].volume, 0.88 * ball, 1e-12);
  EXPECT_LE((states[1].center_of_mass - Point<3>(2, 1, 0)).norm(), 1e-13);
  EXPECT_NEAR(states[1].kinetic_energy, 0, 1e-20);
}

TEST(DeformableSolids, StartsWithTheVorticesOfTheFluid) {
  const auto solids =
      model<2>({box("0.5, 0.5", "0.25") + material("linear") + number("Density", "1") +
                numbers("Position", "0.25, 0.25") + numbers("Velocity", "0.5, 0") +
                list("Vortices", number("Amplitude", "2") + number("Wavelength", "1"))});
  const auto velocity = solids->nodes().owned(*solids->velocity());
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const Point<2> angle = 2 * M_PI * solids->positions()[i];
    const Point<2> expected(0.5 + 2 * std::sin(angle.x()) * std::cos(angle.y()),
                            -2 * std::cos(angle.x()) * std::sin(angle.y()));
    EXPECT_LE((velocity[i] - expected).norm(), 1e-14);
  }
}

TEST(DeformableSolids, RowsAreBarycentric) {
  const auto solids = model<3>(pair_of_bodies);
  const Eigen::VectorXd velocity = dense(*solids->velocity());
  for (const int simplex : {3, solids->solids()[1].simplex_begin + 5}) {
    SurfacePoint<3> point;
    point.simplex = simplex;
    point.barycentric << 0.5, 0.3, 0.2;
    for (int k = 0; k < 3; ++k) {
      point.position += point.barycentric[k] *
                        solids->surface().vertices[solids->surface().simplices[simplex][k]];
    }
    VelocityRow<3> row;
    solids->velocity_row(point, point.position, row);
    Point<3> v = Point<3>::Zero(), sum = Point<3>::Zero();
    for (std::size_t k = 0; k < row.dofs.size(); ++k) {
      v += velocity[row.dofs[k]] * row.coefficients[k];
      sum += row.coefficients[k];
    }
    EXPECT_LE((sum - Point<3>::Ones()).norm(), 1e-15);
    const Point<3> expected =
        simplex == 3 ? Point<3>(Point<3>(1, 0, 0) + Point<3>(0, 0, 3).cross(point.position))
                     : Point<3>(0, 0, 0);
    EXPECT_LE((v - expected).norm(), 1e-13);
  }
}

TEST(DeformableSolids, InternalForcesCarryNoMomentum) {
  const auto solids = model<3>(pair_of_bodies);
  const auto before = make_vector(solids->dof_map()), after = make_vector(solids->dof_map());
  solids->explicit_momentum(0, 0, *before);
  solids->explicit_momentum(0, 0.1, *after);
  const auto p = solids->momentum_of_each(*before), q = solids->momentum_of_each(*after);
  after->update(-1, *before, 1);
  EXPECT_GT(after->norm2(), 1e-3);
  for (int b = 0; b < 2; ++b) {
    EXPECT_LE((p[b].linear - q[b].linear).norm(), 1e-14);
    EXPECT_LE((p[b].angular - q[b].angular).norm(), 1e-14);
    EXPECT_LE((p[b].linear - solids->states()[b].mass * solids->states()[b].velocity).norm(),
              1e-14);
  }
}

TEST(DeformableSolids, GravityAndLoadsAreTheExternalImpulse) {
  const auto solids = model<2>(
      {box("1, 0.5", "0.25") + material("corotated") + number("Density", "2") +
       numbers("Position", "3, 1") +
       list("Loads", list("tip", numbers("Lower", "0.5, 0.25") + numbers("Upper", "0.5, 0.25") +
                                     numbers("Force", "0, 4")))},
      {0, -10});
  const auto momentum = make_vector(solids->dof_map());
  solids->explicit_momentum(0, 0.5, *momentum);
  const auto own = solids->momentum_of_each(*momentum)[0];
  const auto impulse = solids->external_impulse(0, 0.5);
  EXPECT_NEAR(impulse.linear.y(), 0.5 * (-10 + 4), 1e-13);
  EXPECT_NEAR(impulse.angular(0), 0.5 * (-10 * 3 + 4 * 3.5), 1e-12);
  EXPECT_LE((own.linear - impulse.linear).norm(), 1e-13);
  EXPECT_NEAR(own.angular(0), impulse.angular(0), 1e-12);
}

TEST(DeformableSolids, ImplicitForceIsDissipative) {
  const double dt = 0.01;
  const auto solids = model<3>(pair_of_bodies);
  const Eigen::MatrixXd d = dense(solids->implicit_force(dt));
  EXPECT_LE((d - d.transpose()).norm(), 1e-13 * d.norm());
  const Eigen::VectorXd eigenvalues = d.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_LE(eigenvalues.maxCoeff(), 1e-12 * d.norm());
  const Eigen::VectorXd shift = Point<3>(1, 2, 3).replicate(d.rows() / 3, 1);
  EXPECT_LE((d * shift).norm(), 1e-12 * d.norm());
  // It is -B - dt K: what dt adds is the stiffness of the fully implicit body alone.
  const Eigen::MatrixXd change = dense(solids->implicit_force(2 * dt)) - d;
  const Eigen::VectorXd diagonal = change.diagonal();
  int n_of_ball = 0;
  for (int i = 0; i < diagonal.size(); ++i) {
    EXPECT_LE(diagonal[i], 0);
    n_of_ball += diagonal[i] < 0;
  }
  EXPECT_EQ(n_of_ball, 3 * body<3>(pair_of_bodies[1]).n_nodes());
  const auto undamped = model<2>({box("1, 1", "0.5") + material("linear") + number("Density", "1") +
                                  text("Time Integration", "explicit")});
  EXPECT_TRUE(undamped->implicit_force(1).is_null());
}

TEST(DeformableSolids, MassMatrices) {
  const auto solids = model<3>(pair_of_bodies);
  const Eigen::MatrixXd mass = dense(solids->mass());
  EXPECT_LE((mass - mass.transpose()).norm(), 1e-15);
  EXPECT_NEAR(mass.sum(), 3 * (solids->states()[0].mass + solids->states()[1].mass), 1e-12);
  EXPECT_GT(mass.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
}

TEST(DeformableSolids, MovesWithTheVelocityGiven) {
  const auto solids = model<3>(pair_of_bodies);
  const auto before = solids->surface().vertices;
  solids->move(*solids->velocity(), 0, 0.5);
  const auto& after = solids->surface();
  SurfacePoint<3> point;
  point.simplex = 7;
  point.barycentric << 0.2, 0.2, 0.6;
  Point<3> expected = Point<3>::Zero();
  for (int k = 0; k < 3; ++k) {
    const int v = after.simplices[7][k];
    expected += point.barycentric[k] * (after.vertices[v] - before[v]) / 0.5;
  }
  EXPECT_LE((solids->effective_velocity(point, {}) - expected).norm(), 1e-14);
  EXPECT_NEAR(solids->states()[0].center_of_mass.x(), 0.5, 1e-13);
}

/// No more nodes than ranks.
/// Volume inside the surface of a solid, from its vertices.
template <int dim>
double enclosed(const DeformableSolids<dim>& solids, int solid) {
  const SurfaceMesh<dim>& mesh = solids.surface();
  double volume = 0;
  for (int s = solids.solids()[solid].simplex_begin; s < solids.solids()[solid].simplex_end; ++s) {
    Eigen::Matrix<double, dim, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners.col(k) = mesh.vertices[mesh.simplices[s][k]];
    volume += corners.determinant() / (dim == 2 ? 2 : 6);
  }
  return volume;
}

// Nodes that turn on straight lines grow a body; told to, it does not, and its centre stays.
TEST(DeformableSolids, SweepWhatTheyAreTold) {
  const auto solids = model<3>({pair_of_bodies[0], pair_of_bodies[1], pair_of_bodies[0]});
  const double dt = 0.1, before[] = {enclosed(*solids, 0), enclosed(*solids, 1)};
  const Point<3> far = Point<3>::Constant(9), center = solids->states()[0].center_of_mass;
  EXPECT_EQ(solids->sweeper()->can_sweep(Box<3>(-far, far)), (std::vector<char>{1, 1, 1}));
  EXPECT_EQ(solids->sweeper()->can_sweep(Box<3>(-far, Point<3>(9, 1, 9))),
            (std::vector<char>{1, 0, 1}));
  Vector velocity(*solids->velocity(), Teuchos::Copy);
  const Vector free(velocity, Teuchos::Copy);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  solids->sweeper()->sweep(dt, {0, 0.01, nan}, velocity);
  solids->move(velocity, 0, dt);
  EXPECT_NEAR(enclosed(*solids, 0), before[0], 1e-14);
  EXPECT_NEAR(enclosed(*solids, 1), before[1] + 0.01, 1e-14);
  EXPECT_GT(enclosed(*solids, 2), before[0] * 1.01);
  EXPECT_LT((solids->states()[0].center_of_mass - center - dt * Point<3>(1, 0, 0)).norm(), 1e-13);
}

TEST(DeformableSolids, SweepWithoutMovingHeldNodes) {
  const auto solids = model<2>({box("0.5, 0.5", "0.125") + material("linear") +
                                number("Density", "1") + pinned("-1, -1", "1, -0.2", "x, y")});
  Vector velocity(solids->dof_map());
  solids->sweeper()->sweep(0.1, {0.02}, velocity);
  const auto along = solids->nodes().owned(velocity);
  for (std::size_t i = 0; i < along.size(); ++i) {
    EXPECT_EQ(along[i].isZero(),
              solids->positions()[i].y() < -0.2 || solids->positions()[i].isZero());
  }
  const double before = enclosed(*solids, 0);
  solids->move(velocity, 0, 0.1);
  EXPECT_NEAR(enclosed(*solids, 0), before + 0.02, 1e-15);
}

TEST(DeformableSolids, TwoTrianglesOnManyRanks) {
  Alone<2> alone(
      model<2>({box("1, 1", "1") + material("corotated") + number("Density", "1")}, {0, -1}));
  for (int i = 0; i < 3; ++i)
    alone.step(0.1);
  EXPECT_NEAR(alone.solids.states()[0].velocity.y(), -0.3, 1e-12);
}

TEST(DeformableSolids, CheckpointRestoresBitForBit) {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("lockstep_deformable_" + std::to_string(world()->getSize())))
                                 .string();
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  const auto saved = model<3>(pair_of_bodies), loaded = model<3>(pair_of_bodies);
  saved->move(*saved->velocity(), 0, 0.3);
  {
    CheckpointWriter writer(world(), folder, {1, 0.3, "<ParameterList/>"});
    saved->save(writer);
    writer.finish(1);
  }
  loaded->load(CheckpointReader(world(), latest_checkpoint(folder)));
  EXPECT_EQ(saved->positions(), loaded->positions());
  EXPECT_EQ(saved->surface().vertices, loaded->surface().vertices);
  EXPECT_EQ(dense(*saved->velocity()), dense(*loaded->velocity()));
  EXPECT_EQ(saved->elastic_forces(), loaded->elastic_forces());
  SurfacePoint<3> point;
  point.simplex = 2;
  point.barycentric.setConstant(1. / 3);
  EXPECT_EQ(saved->effective_velocity(point, {}), loaded->effective_velocity(point, {}));
  const auto others = model<3>({pair_of_bodies[0]});
  EXPECT_THROW(others->load(CheckpointReader(world(), latest_checkpoint(folder))), InputError);
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

TEST(DeformableSolids, RegistryMakesOneModelOfAllBodies) {
  SolidRegistry<2> registry("solid");
  register_deformable<2>(registry, std::make_shared<MaterialRegistry<2>>(shipped_materials<2>()));
  const std::string disc =
      geometry("ball", number("Radius", "0.2")) + number("Density", "1") + material("linear");
  const NamedLists bodies{{"Left", body_list<2>(disc)}, {"Right", body_list<2>(disc)}};
  SolidSetting<2> setting;
  setting.smallest_length = 0.1;
  setting.comm = world();
  const auto made = registry.create("deformable body", ParameterList(), bodies, setting);
  ASSERT_EQ(made->solids().size(), 2u);
  EXPECT_EQ(made->solids()[1].name, "Right");
  EXPECT_EQ(made->solids()[0].vertex_end, made->solids()[1].vertex_begin);
  EXPECT_TRUE(made->solids()[0].closed && !made->solids()[0].rigid);
}

}  // namespace
}  // namespace lockstep::test
