// Rows of contacts that a coupled solve holds, against all active sets one by one.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "cloth_world.hpp"
#include "linear/types.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep::test {
namespace {

Eigen::VectorXd dense(const SolidSystem<2>& solids, const Vector& vector) {
  const std::vector<double> values = replicated(solids, vector);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

RCP<Vector> stacked(const SolidSystem<2>& solids, const Eigen::VectorXd& values) {
  return distributed(solids, std::vector<double>(values.data(), values.data() + values.size()));
}

Eigen::MatrixXd dense(const SolidSystem<2>& solids, const LinearOperator& op) {
  const auto n = static_cast<Eigen::Index>(solids.n_unknowns());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto column = make_vector(solids.map());
    apply(op, *stacked(solids, Eigen::VectorXd::Unit(n, k)), *column);
    matrix.col(k) = dense(solids, *column);
  }
  return matrix;
}

/// Velocities that minimise the distance to `free` in C, with heights' rates not below `least`: of
/// all sets of nodes that are held, the one that pushes and breaks nothing.
Eigen::VectorXd by_enumeration(const Eigen::MatrixXd& c, const Eigen::VectorXd& free,
                               const Eigen::VectorXd& least) {
  constexpr double round_off = 1e-12;
  const auto n = static_cast<int>(least.size());
  const Eigen::MatrixXd inverse = c.inverse();
  for (int set = 0; set < (1 << n); ++set) {
    std::vector<int> held;
    for (int node = 0; node < n; ++node)
      if (set & (1 << node))
        held.push_back(2 * node + 1);
    const auto n_held = static_cast<Eigen::Index>(held.size());
    Eigen::MatrixXd compliance(n_held, n_held);
    Eigen::VectorXd wanted(n_held);
    for (Eigen::Index i = 0; i < n_held; ++i) {
      wanted[i] = least[held[i] / 2] - free[held[i]];
      for (Eigen::Index j = 0; j < n_held; ++j)
        compliance(i, j) = inverse(held[i], held[j]);
    }
    Eigen::VectorXd impulses = Eigen::VectorXd::Zero(0), velocity = free;
    if (n_held > 0)
      impulses = compliance.ldlt().solve(wanted);
    for (Eigen::Index i = 0; i < n_held; ++i)
      velocity += impulses[i] * inverse.col(held[i]);
    bool stands = n_held == 0 || impulses.minCoeff() >= 0;
    for (int node = 0; node < n; ++node)
      stands = stands && velocity[2 * node + 1] >= least[node] - round_off;
    if (stands)
      return velocity;
  }
  ADD_FAILURE() << "no set of nodes stands";
  return free;
}

/// A line of three nodes, the first at the lowest, falls askew onto a floor.
TEST(HeldRows, ASolveThatHoldsThemSolvesTheComplementarityProblem) {
  SurfaceMesh<2> line;
  line.vertices = {{0, .06 * h}, {h, .07 * h}, {2 * h, .2 * h}};
  line.simplices = {{0, 1}, {1, 2}};
  std::vector<DeformableBody<2>> cloths;
  cloths.push_back(cloth<2>(line, 1e3));
  // Each rank by itself: on several, dofs have other numbers than their nodes.
  ClothWorld<2> world(std::move(cloths), {}, Point<2>::Zero(), {{2, 1, 1.0, 0}}, {},
                      own_communicator());
  const SolidSystem<2>& solids = *world.solids;
  const double dt = .01, speed = 10 * h;
  const Eigen::MatrixXd c = dense(solids, *solids.solid_block(Teuchos::null, dt));
  const ContactResponse response = [&] {
    return exact_inverse(solids.solid_block(Teuchos::null, dt), "solids");
  };
  Eigen::VectorXd free(6), least(3);
  free << .1 * speed, -speed, 0, -.8 * speed, -.2 * speed, -.1 * speed;
  for (int node = 0; node < 3; ++node)
    least[node] = -(line.vertices[node].y() - .05 * h) / dt;  // the skin is h/10 thick
  const RCP<Vector> velocity = stacked(solids, free);
  world.contact.begin_step(0);
  const ContactReport<2> report =
      world.contact.decide(solids, ContactPhase::velocity, dt, *velocity, response);
  const Eigen::VectorXd exact = by_enumeration(c, free, least);
  ASSERT_EQ(report.held.size(), 2u);
  EXPECT_LT((dense(solids, *velocity) - exact).lpNorm<Eigen::Infinity>(), 1e-5 * speed);

  Eigen::MatrixXd held = c;
  Eigen::VectorXd rhs = c * free;
  for (const HeldRow& row : report.held) {
    EXPECT_GT(row.impulse, 0);
    Eigen::VectorXd j = Eigen::VectorXd::Zero(6);
    for (const auto& [dof, weight] : row.weights)
      j[dof] += weight;
    const double stiffness = 1e5 / row.response;
    held += stiffness * j * j.transpose();
    rhs += (row.impulse + stiffness * row.velocity) * j;
  }
  EXPECT_LT((held.ldlt().solve(rhs) - exact).lpNorm<Eigen::Infinity>(), 1e-8 * speed);
}

/// A contact that sticks is held along the surface, too; a second decision in the same step is the
/// same.
TEST(HeldRows, FrictionThatSticksIsHeld) {
  std::vector<DeformableBody<2>> cloths;
  cloths.push_back(sheet<2>(2 * h, Point<2>(0, .05 * h), h));
  cloths.back().friction = .8;
  ClothWorld<2> world(std::move(cloths), {}, Point<2>::Zero(), {{2, 1, 1.0, 0}});
  const SolidSystem<2>& solids = *world.solids;
  const auto n = static_cast<Eigen::Index>(solids.n_unknowns());
  Eigen::VectorXd free(n);
  for (Eigen::Index k = 0; k < n; ++k)
    free[k] = k % 2 == 0 ? .1 * h : -h;
  const double dt = .01;
  const ContactResponse response = [inverse = exact_inverse(solids.solid_block(Teuchos::null, dt),
                                                            "solids")] { return inverse; };
  world.contact.begin_step(0);
  std::vector<Eigen::VectorXd> found;
  for (int decision = 0; decision < 2; ++decision) {
    const RCP<Vector> velocity = stacked(solids, free);
    const ContactReport<2> report =
        world.contact.decide(solids, ContactPhase::velocity, dt, *velocity, response);
    EXPECT_EQ(static_cast<Eigen::Index>(report.held.size()), n);  // a normal and a tangent a node
    EXPECT_TRUE(report.sliding.empty());
    found.push_back(dense(solids, *velocity));
    EXPECT_LT(found.back().lpNorm<Eigen::Infinity>(), 1e-4 * h);
  }
  EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace lockstep::test
