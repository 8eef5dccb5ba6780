// Scripted and released nodes, strain limits, sub-steps.
#include <Eigen/Dense>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "coupling/solid_totals.hpp"
#include "deformable/sub_steps.hpp"
#include "support.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

using namespace test;

std::string region(const std::string& lower, const std::string& upper, const std::string& more) {
  return list("Pinned", list("rim", numbers("Lower", lower) + numbers("Upper", upper) + more));
}
std::string motion(const std::string& type, const std::string& content) {
  return list("Motion", text("Type", type) + content);
}
std::string sub_steps(const std::string& most) {
  return "<Parameter name=\"Most Sub-Steps\" type=\"int\" value=\"" + most + "\"/>";
}
const std::string block =
    box("1, 0.5", "0.25") + material("corotated", "1000") + number("Density", "2");

/// Vertices of the surface left of x, at the start.
template <int dim>
std::vector<int> vertices_left_of(const DeformableSolids<dim>& solids, double x) {
  std::vector<int> found;
  for (std::size_t v = 0; v < solids.surface().vertices.size(); ++v) {
    if (solids.surface().vertices[v].x() < x)
      found.push_back(static_cast<int>(v));
  }
  return found;
}

TEST(Constraints, ScriptedNodesFollowTheirScript) {
  Alone<2> alone(model<2>(
      {block + text("Time Integration", "fully-implicit") + numbers("Position", "3, 1") +
       region("-0.5, -1", "-0.5, 1",
              motion("sinusoid", numbers("Amplitude", "0, 0.2") + number("Frequency", "1") +
                                     number("Angular Amplitude", "0.3") + number("Phase", "0.7")))},
      {0, -1}));
  const auto start = alone.solids.surface().vertices;
  const auto rim = vertices_left_of(alone.solids, 2.51);
  ASSERT_EQ(rim.size(), 3u);
  const auto swing = [](double t) { return std::sin(2 * M_PI * t + 0.7) - std::sin(0.7); };
  for (int i = 1; i <= 5; ++i) {
    alone.step(0.03 * i);
    const double s = swing(alone.time);
    for (const int v : rim) {
      const Point<2> expected =
          Point<2>(3, 1 + 0.2 * s) + Eigen::Rotation2Dd(0.3 * s) * (start[v] - Point<2>(3, 1));
      EXPECT_LE((alone.solids.surface().vertices[v] - expected).norm(), 1e-13);
    }
    // The nodes have the velocity of that instant at the end of the step.
    const double rate = 2 * M_PI * std::cos(2 * M_PI * alone.time + 0.7);
    SurfacePoint<2> point;
    for (std::size_t k = 0; k < alone.solids.surface().simplices.size(); ++k) {
      const auto& s0 = alone.solids.surface().simplices[k];
      if (s0[0] == rim[0]) {
        point.simplex = static_cast<int>(k);
        point.barycentric << 1, 0;
      }
    }
    VelocityRow<2> row;
    alone.solids.velocity_row(point, {}, row);
    const Eigen::VectorXd velocity = dense(*alone.solids.velocity());
    const Point<2> arm = alone.solids.surface().vertices[rim[0]] - Point<2>(3, 1 + 0.2 * s);
    const Point<2> expected =
        0.2 * rate * Point<2>(0, 1) + 0.3 * rate * Point<2>(-arm.y(), arm.x());
    EXPECT_NEAR(velocity[row.dofs[0]], expected.x(), 1e-13);
    EXPECT_NEAR(velocity[row.dofs[1]], expected.y(), 1e-13);
  }
}

TEST(Constraints, ReleasedNodesKeepTheirVelocity) {
  Alone<2> alone(model<2>(
      {block +
       region("-0.5, -1", "0.5, 1",
              number("End", "0.2") + motion("constant velocity", numbers("Velocity", "3, 0")))},
      {0, -10}));
  const double dt = 0.01;
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(alone.solids.locked_dofs().size())), 30);
  EXPECT_NEAR(alone.solids.states()[0].velocity.x(), 3, 1e-14);
  for (int i = 0; i < 20; ++i)
    alone.step(dt);
  EXPECT_NEAR(alone.solids.states()[0].center_of_mass.x(), 0.6, 1e-13);
  EXPECT_NEAR(alone.solids.states()[0].center_of_mass.y(), 0, 1e-14);
  EXPECT_TRUE(alone.system.begin_step(alone.time, dt));
  EXPECT_TRUE(alone.system.reduction().is_identity());
  EXPECT_FALSE(alone.system.begin_step(alone.time, dt));
  for (int i = 0; i < 10; ++i)
    alone.step(dt);
  EXPECT_NEAR(alone.solids.states()[0].velocity.x(), 3, 1e-12);
  EXPECT_NEAR(alone.solids.states()[0].velocity.y(), -10 * 0.1, 1e-12);
  EXPECT_NEAR(alone.solids.states()[0].center_of_mass.y(), -0.5 * 10 * 0.01, 1e-12);
}

/// Beside held nodes the rows of C do not sum to the mass: they lack the columns of what is held.
TEST(Constraints, HeldNodesDoNotHideHowStiffABodyIs) {
  const double dt = 0.1;
  const auto elasticity_over_mass = [dt](const std::string& youngs_modulus) {
    const Alone<2> alone(model<2>(
        {box("1, 0.5", "0.125") + material("corotated", youngs_modulus) + number("Density", "2") +
         text("Time Integration", "fully-implicit") + pinned("-0.5, -1", "-0.5, 1", "x, y")}));
    const NearNullSpace space = near_null_space(alone.system, Teuchos::null);
    const auto mass = space.mass->getData(),
               is_free = alone.system.reduction().unknowns()->getData();
    for (std::size_t row = 0; row < space.body_of_row.size(); ++row) {
      if (space.body_of_row[row] >= 0 && is_free[row] == 0) {
        EXPECT_EQ(mass[row], 1);  // as in C
      }
    }
    const auto c = assembled(alone.system.solid_block(Teuchos::null, dt));
    return stiffness_number(*c, space) - 1;
  };
  const double soft = elasticity_over_mass("1");
  EXPECT_NEAR(elasticity_over_mass("1e8"), 1e8 * soft, 1e-4 * 1e8 * soft);
}

TEST(Constraints, RegionsThatMoveDoNotOverlap) {
  const auto two = [](const std::string& more) {
    const std::string left = numbers("Lower", "-0.5, -1") + numbers("Upper", "-0.5, 1");
    return block + list("Pinned", list("a", left) + list("b", left + more));
  };
  EXPECT_EQ(error([&] { body<2>(two("")); }), "");
  EXPECT_EQ(error([&] { body<2>(two(texts("Locked", ""))); }), "");
  EXPECT_THAT(error([&] { body<2>(two(number("End", "1"))); }),
              ::testing::HasSubstr("body/Pinned/b"));
}

/// A heavy net on a weak sheet, held at its upper edge: no edge grows by more than a tenth.
TEST(Constraints, StrainIsLimited) {
  const ParameterList given =
      scene_list(geometry("sheet", numbers("Size", "1, 0.6, 0") + text("Normal", "z") +
                                       number("Mesh Spacing", "0.25")) +
                     number("Young&apos;s Modulus", "100") + number("Thickness", "0.001") +
                     number("Surface Density", "1") + number("Stretch Limit", "0.1") +
                     region("-1, 0.3, -1", "1, 0.3, 1", ""),
                 cloth_parameters<3>());
  std::vector<DeformableBody<3>> bodies;
  bodies.push_back(read_cloth<3>("net", given, 0.1));
  const auto edges = bodies[0].limited_edges;
  const auto surface = bodies[0].surface;
  Alone<3> alone(std::make_unique<DeformableSolids<3>>("cloth", std::move(bodies),
                                                       Point<3>(0, -10, 1), world()));
  for (int i = 0; i < 40; ++i)
    alone.step(0.01);
  double worst = 0, lowest = 0;
  for (std::size_t s = 0; s < surface.size(); ++s) {
    for (int k = 0; k < 3; ++k) {
      const auto& now = alone.solids.surface();
      const int a = surface[s][k], b = surface[s][(k + 1) % 3];
      const double length =
          (now.vertices[now.simplices[s][k]] - now.vertices[now.simplices[s][(k + 1) % 3]]).norm();
      for (const LimitedEdge& edge : edges) {
        if (edge.corners == std::array<int, 2>{std::min(a, b), std::max(a, b)})
          worst = std::max(worst, length / edge.longest);
      }
      lowest = std::min(lowest, now.vertices[now.simplices[s][k]].y());
    }
  }
  EXPECT_LE(worst, 1.0011);
  EXPECT_GE(worst, 0.99);  // it hangs in its limits
  EXPECT_LE(stretch_beyond_limit(alone.system), 0.001);
  EXPECT_LE(lowest, -0.3);
}

/// A sheet that is held apart stays longer than its limit allows, and the model reports by how
/// much.
TEST(Constraints, StrainThatCannotBeLimitedIsTold) {
  const ParameterList given =
      scene_list(geometry("sheet", numbers("Size", "1, 1, 0") + text("Normal", "z") +
                                       number("Mesh Spacing", "0.3")) +
                     number("Young&apos;s Modulus", "1") + number("Thickness", "0.001") +
                     number("Surface Density", "1") + number("Stretch Limit", "0.05") +
                     numbers("Stretch", "1.2, 1.2, 1") + region("-2, -2, -1", "2, 2, 1", ""),
                 cloth_parameters<3>());
  std::vector<DeformableBody<3>> bodies;
  bodies.push_back(read_cloth<3>("sheet", given, 0.1));
  Alone<3> alone(std::make_unique<DeformableSolids<3>>("cloth", std::move(bodies),
                                                       Point<3>(0, 0, 0), world()));
  alone.step(0.1);
  EXPECT_NEAR(stretch_beyond_limit(alone.system), 1.2 / 1.05 - 1, 1e-12);
}

/// Free, the limit gives no linear momentum, and it acts in S2 as in S1.
TEST(Constraints, StrainLimitKeepsMomentum) {
  const ParameterList given =
      scene_list(geometry("sheet", numbers("Size", "1, 1, 0") + text("Normal", "z") +
                                       number("Mesh Spacing", "0.3")) +
                     number("Young&apos;s Modulus", "1") + number("Thickness", "0.001") +
                     number("Surface Density", "1") + number("Stretch Limit", "0.05") +
                     numbers("Velocity", "1, 2, 3") + numbers("Stretch", "1.2, 1.2, 1"),
                 cloth_parameters<3>());
  std::vector<DeformableBody<3>> bodies;
  bodies.push_back(read_cloth<3>("sheet", given, 0.1));
  Alone<3> alone(std::make_unique<DeformableSolids<3>>("cloth", std::move(bodies),
                                                       Point<3>(0, 0, 0), world()));
  for (int i = 0; i < 3; ++i) {
    alone.step(0.1);
    const auto state = alone.solids.states()[0];
    EXPECT_LE((state.velocity - Point<3>(1, 2, 3)).norm(), 1e-13);
    // An edge turns while its neighbours pull: angular momentum is kept approximately.
    EXPECT_LE(state.angular_velocity.norm(), 0.03);
  }
  EXPECT_GT(alone.solids.states()[0].kinetic_energy, 7.1);  // 14/2, and what drew it together
}

TEST(SubSteps, AreAsFewAsTheStepNeeds) {
  EXPECT_EQ(sub_steps_for(0.9, 1, 50).n, 1);
  EXPECT_EQ(sub_steps_for(10, 1, 1).n, 1);
  EXPECT_EQ(sub_steps_for(9.9, 1, 50).n, 20);
  EXPECT_NEAR(sub_steps_for(9.9, 1, 50).length, 0.99, 1e-14);
  EXPECT_EQ(longest_sub_stepped(0.3, 50), 7.5);
  EXPECT_EQ(longest_sub_stepped(0.3, 1), 0.3);
  for (const int n : {1, 2, 7}) {
    double sum = 0;
    for (int k = 0; k < n; ++k)
      sum += SubSteps{n, 0}.weight(k);
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

/// Every node of a tethered block is one oscillator, of omega = 3: the force is its path's mean.
TEST(SubSteps, ForceIsTheMeanOverThePath) {
  const std::string tethered = box("1, 0.5, 0.5", "0.25") + material("corotated") +
                               number("Density", "4") + text("Time Integration", "semi-implicit") +
                               sub_steps("5");
  const auto ends = numbers("Lower", "-1, -1, -1") + numbers("Upper", "1, 1, 1");
  const auto solids =
      model<3>({tethered + list("Tethers", list("all", ends + number("Stiffness", "9") +
                                                           numbers("Offset", "0, 0.1, 0")))});
  const double stable = solids->largest_stable_step().dt / 2.5;
  const double dt = 2.2 * stable;
  solids->begin_step(0, dt);
  const SubSteps steps = sub_steps_for(dt, stable, 5);
  ASSERT_EQ(steps.n, 5);
  double x = -0.1, v = 0, mean = 0;
  for (int k = 0; k < steps.n; ++k) {
    mean += steps.weight(k) * 9 * -x;
    v -= (k == 0 ? 0.5 : 1) * steps.length * 9 * x;
    x += steps.length * v;
  }
  const auto before = make_vector(solids->dof_map()), after = make_vector(solids->dof_map());
  solids->explicit_momentum(0, 0, *before);
  solids->explicit_momentum(0, 0.01, *after);
  after->update(-1, *before, 1);
  // The block weighs 1; its anchors come after its nodes.
  double impulse = 0;
  const auto values = solids->nodes().owned(*after);
  for (int i = 0; i < solids->nodes().n_owned(); ++i)
    impulse += solids->nodes().original(i) < 45 ? values[i].y() : 0;
  EXPECT_NEAR(sum_all(world(), impulse), 0.01 * mean, 1e-13);
  EXPECT_LE(solids->momentum_of_each(*after)[0].linear.norm(), 1e-13);
}

/// Impulses of elastic forces on owned nodes for a step of dt, in the order of the scene.
std::vector<Point<2>> elastic_impulses(DeformableSolids<2>& solids) {
  const auto before = make_vector(solids.dof_map()), after = make_vector(solids.dof_map());
  solids.explicit_momentum(0, 0, *before);
  solids.explicit_momentum(0, 1, *after);
  after->update(-1, *before, 1);
  const auto values = solids.nodes().owned(*after);
  std::vector<double> mine;
  for (int i = 0; i < solids.nodes().n_owned(); ++i)
    mine.insert(mine.end(), {double(solids.nodes().original(i)), values[i].x(), values[i].y()});
  const std::vector<double> all = gather_all(world(), mine);
  std::vector<Point<2>> result(all.size() / 3);
  for (std::size_t k = 0; k < all.size(); k += 3)
    result[static_cast<std::size_t>(all[k])] = {all[k + 1], all[k + 2]};
  return result;
}

TEST(SubSteps, BodiesSideBySideFeelWhatEachFeelsAlone) {
  const auto stretched = [](const std::string& stiffness, const std::string& place) {
    return box("1, 0.5", "0.25") + material("corotated", stiffness) + number("Density", "1") +
           numbers("Stretch", "1.1, 0.95") + numbers("Position", place) +
           text("Time Integration", "semi-implicit") + sub_steps("40");
  };
  // Two take as many sub-steps, one more, one none.
  const std::vector<std::string> contents{stretched("1e4", "0, 0"), stretched("4e4", "2, 0"),
                                          stretched("1", "4, 0"), stretched("1e4", "6, 0")};
  const double dt = 4 / 20. * model<2>({contents[0]})->largest_stable_step().dt;
  const auto together = model<2>(contents);
  together->begin_step(0, dt);
  std::vector<Point<2>> alone;
  for (const std::string& content : contents) {
    const auto one = model<2>({content});
    one->begin_step(0, dt);
    for (const Point<2>& impulse : elastic_impulses(*one))
      alone.push_back(impulse);
  }
  const auto impulses = elastic_impulses(*together);
  ASSERT_EQ(impulses.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
    EXPECT_LE((impulses[i] - alone[i]).norm(), 1e-11 * alone[0].norm()) << i;
}

/// The mean of a step serves the next one, unless that is of another length or holds other nodes.
TEST(SubSteps, MeansAreFoundAnewWhereTheyDiffer) {
  const std::string content =
      box("1, 0.5", "0.25") + material("corotated", "1e4") + number("Density", "1") +
      numbers("Stretch", "1.1, 0.95") + text("Time Integration", "semi-implicit") +
      sub_steps("40") +
      list("Pinned", list("end", numbers("Lower", "-0.5, -0.25") + numbers("Upper", "-0.5, 0.25") +
                                     number("End", "1")));
  const double dt = 4 / 20. * model<2>({content})->largest_stable_step().dt;
  const auto solids = model<2>({content});
  for (const auto& [time, length] :
       {std::pair(0., dt), std::pair(0.1, dt), std::pair(0.2, 2 * dt), std::pair(2., 2 * dt)}) {
    solids->begin_step(time, length);
    const auto anew = model<2>({content});
    anew->begin_step(time, length);
    EXPECT_EQ(elastic_impulses(*solids), elastic_impulses(*anew)) << time;
  }
}

TEST(SubSteps, StiffBodyIsStableAtTenTimesItsStep) {
  for (const std::string integration : {"explicit", "semi-implicit"}) {
    Alone<2> alone(
        model<2>({box("1, 0.5", "0.125") + material("corotated", "1e4") + number("Density", "1") +
                  numbers("Stretch", "1.02, 0.99") + numbers("Velocity", "1, 2") +
                  text("Time Integration", integration) + sub_steps("40")}));
    const auto energy = [&] {
      const auto state = alone.solids.states()[0];
      return state.elastic_energy + state.kinetic_energy;
    };
    const double before = energy();
    const double dt = 10 / 20. * alone.solids.largest_stable_step().dt;
    for (int i = 0; i < 100; ++i) {
      alone.step(dt);
      EXPECT_LE(energy(), 1.2 * before) << i;
    }
    EXPECT_LE((alone.solids.states()[0].velocity - Point<2>(1, 2)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace lockstep::test
