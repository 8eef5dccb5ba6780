// Laws with a memory: what a step changes in the states of elements, and what leaves them alone.
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <filesystem>

#include "output/checkpoint.hpp"
#include "support.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

using namespace test;

constexpr double branch_stiffness = 300, relaxation_time = 0.05;  // Pa, s

/// k/2 |F - I - A|^2 in the plane, with the state A that follows F - I.
class Branch : public MaterialMemory<2> {
 public:
  int n_state() const override { return 4; }
  double energy_density(const Tensor<2>& f, const State& state) const override {
    return 0.5 * branch_stiffness * strain(f, state).squaredNorm();
  }
  Tensor<2> stress(const Tensor<2>& f, const State& state) const override {
    return branch_stiffness * strain(f, state);
  }
  TensorDerivative<2> stress_derivative(const Tensor<2>&, const State&) const override {
    return branch_stiffness * TensorDerivative<2>::Identity();
  }
  void end_step(const Tensor<2>& f, double dt, Eigen::Ref<Eigen::VectorXd> state) const override {
    const Tensor<2> s = strain(f, state);
    state -= std::expm1(-dt / relaxation_time) * Eigen::Map<const Eigen::Vector4d>(s.data());
  }

 private:
  static Tensor<2> strain(const Tensor<2>& f, const State& state) {
    return f - Tensor<2>::Identity() - Eigen::Map<const Tensor<2>>(state.data());
  }
};

/// A law that ships beside such a branch.
class Relaxing : public Material<2> {
 public:
  explicit Relaxing(const LameConstants& lame) : spring_(linear_elasticity<2>(lame)) {}
  double energy_density(const Tensor<2>& f) const override { return spring_->energy_density(f); }
  Tensor<2> stress(const Tensor<2>& f) const override { return spring_->stress(f); }
  TensorDerivative<2> stress_derivative(const Tensor<2>& f) const override {
    return spring_->stress_derivative(f);
  }
  const MaterialMemory<2>* memory() const override { return &branch_; }

 private:
  std::unique_ptr<Material<2>> spring_;
  Branch branch_;
};

std::unique_ptr<DeformableSolids<2>> relaxing_model(const std::string& content) {
  MaterialRegistry<2> materials = shipped_materials<2>();
  materials.add("relaxing", "", elastic_constants, [](const ParameterList& list) {
    return std::make_unique<Relaxing>(read_elastic_constants(list));
  });
  const ParameterList list = scene_list(content, deformable_body_parameters<2>(materials));
  std::vector<DeformableBody<2>> bodies;
  bodies.push_back(read_deformable_body<2>("0", list, 0.1, 0, materials));
  return std::make_unique<DeformableSolids<2>>("deformable body", std::move(bodies),
                                               Point<2>::Zero(), world());
}

std::string stretched_block(const std::string& law, const std::string& integration) {
  return box("1, 0.25", "0.25") + material(law, "1000") + number("Density", "1") +
         numbers("Stretch", "1.01, 1") + text("Time Integration", integration);
}
const std::string all_held = pinned("-1, -1", "1, 1", "x, y");

double elastic_energy(const DeformableSolids<2>& solids) {
  return solids.states()[0].elastic_energy;
}
double total_energy(const DeformableSolids<2>& solids) {
  return solids.states()[0].kinetic_energy + elastic_energy(solids);
}

/// The branch's stress falls as exp(-t / relaxation time), its energy as the square of that,
/// whatever the steps.
TEST(Memory, StressRelaxesAtAHeldStrain) {
  for (const std::string integration :
       {"explicit", "semi-implicit", "fully-implicit", "second-order"}) {
    const auto elastic = model<2>({stretched_block("linear", integration) + all_held});
    for (const int n : {1, 3, 10}) {
      SCOPED_TRACE(integration + ", steps: " + std::to_string(n));
      Alone<2> alone(relaxing_model(stretched_block("relaxing", integration) + all_held));
      const double start = elastic_energy(alone.solids) - elastic_energy(*elastic);
      const std::vector<Point<2>> forces = alone.solids.elastic_forces();
      EXPECT_NEAR(start, 0.5 * branch_stiffness * 1e-4 * 0.25, 1e-12);
      for (int k = 0; k < n; ++k)
        alone.step(0.1 / n);
      const double left = std::exp(-0.1 / relaxation_time);
      EXPECT_NEAR(elastic_energy(alone.solids) - elastic_energy(*elastic), left * left * start,
                  1e-12 * start);
      for (std::size_t i = 0; i < forces.size(); ++i) {
        const Point<2> of_spring = elastic->elastic_forces()[i];
        const Point<2> expected = of_spring + left * (forces[i] - of_spring);
        EXPECT_LE((alone.solids.elastic_forces()[i] - expected).norm(), 1e-12);
      }
    }
  }
}

TEST(Memory, LawsThatAreHeldTogetherKeepTheirs) {
  const auto law = held_together<2>(std::make_unique<Relaxing>(LameConstants{2, 1.5}), 5);
  ASSERT_NE(law->memory(), nullptr);
  EXPECT_EQ(law->memory()->n_state(), 4);
}

/// Solves, attempts and motions outside of steps end none.
TEST(Memory, NothingButAStepsEndChangesStates) {
  Alone<2> alone(relaxing_model(stretched_block("relaxing", "second-order")));
  DeformableSolids<2>& solids = alone.solids;
  const double before = elastic_energy(solids);
  Vector velocity(*solids.velocity(), Teuchos::Copy);
  velocity.putScalar(0.1);
  solids.move(velocity, -1, 1);  // as what settles does
  solids.set_velocity(*solids.velocity());
  EXPECT_NEAR(elastic_energy(solids), before, 1e-12 * before);
  alone.system.begin_step(0, 0.1);
  for (int k = 0; k < 3; ++k)
    solids.nonlinear()->linearise(0.1, velocity);
  solids.set_velocity(*solids.velocity());  // the first of two kicks
  EXPECT_NEAR(elastic_energy(solids), before, 1e-12 * before);
  velocity.putScalar(0);
  solids.move(velocity, 0, 0.1);
  EXPECT_NEAR(elastic_energy(solids), before, 1e-12 * before);
  solids.set_velocity(velocity);
  EXPECT_LT(elastic_energy(solids), 0.9 * before);
  const double after = elastic_energy(solids);
  solids.set_velocity(velocity);  // contact, after the step
  EXPECT_EQ(elastic_energy(solids), after);
}

/// Steps that do not resolve the motion exchange elastic and kinetic energy, as without a memory.
TEST(Memory, EnergyOnlyFalls) {
  if (world()->getSize() > 1)
    GTEST_SKIP() << "The same on several ranks, only slower.";
  for (const double dt : {0.0005, 0.01, 1.0, 100.0}) {
    Alone<2> alone(relaxing_model(stretched_block("relaxing", "second-order")));
    const double start = total_energy(alone.solids), round_off = 1e-13 * start;
    for (int k = 0; k < 100; ++k) {
      const double before = dt < 1 ? total_energy(alone.solids) : start;
      alone.step(dt);
      EXPECT_LE(total_energy(alone.solids), before + round_off) << dt << ", step " << k;
    }
    EXPECT_LT(total_energy(alone.solids), 0.8 * start) << dt;
  }
}

/// A block that rings from its unrelaxed shape: bodies move with second order.
TEST(Memory, MotionIsOfSecondOrder) {
  if (world()->getSize() > 1)
    GTEST_SKIP() << "The same on several ranks, only slower.";
  const std::string content = box("1, 0.25", "0.25") + material("relaxing", "1000") +
                              number("Density", "1") + number("Angular Velocity", "5") +
                              text("Time Integration", "second-order");
  EXPECT_NEAR(order_of_motion([&] { return relaxing_model(content); }), 2, 0.1);
}

TEST(Memory, CheckpointsRestoreStatesBitForBit) {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("lockstep_memory_" + std::to_string(world()->getSize())))
                                 .string();
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  const std::string content = stretched_block("relaxing", "second-order");
  Alone<2> saved(relaxing_model(content)), loaded(relaxing_model(content));
  for (int k = 0; k < 3; ++k)
    saved.step(0.01);
  {
    CheckpointWriter writer(world(), folder, {3, 0.03, "<ParameterList/>"});
    saved.solids.save(writer);
    writer.finish(1);
  }
  loaded.solids.load(CheckpointReader(world(), latest_checkpoint(folder)));
  EXPECT_EQ(saved.solids.elastic_forces(), loaded.solids.elastic_forces());
  loaded.time = saved.time;
  for (int k = 0; k < 3; ++k) {
    saved.step(0.01);
    loaded.step(0.01);
  }
  EXPECT_EQ(saved.solids.positions(), loaded.solids.positions());
  EXPECT_EQ(saved.solids.elastic_forces(), loaded.solids.elastic_forces());
  EXPECT_EQ(elastic_energy(saved.solids), elastic_energy(loaded.solids));
  const auto elastic = model<2>({stretched_block("linear", "second-order")});
  {
    CheckpointWriter writer(world(), folder, {4, 0.04, "<ParameterList/>"});
    elastic->save(writer);
    writer.finish(1);
  }
  const CheckpointReader without_states(world(), latest_checkpoint(folder));
  EXPECT_THROW(loaded.solids.load(without_states), InputError);
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lockstep::test
