// Contacts of solids that answer an impulse as a whole, against the operator itself.
#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>
#include <cmath>

#include "cloth_world.hpp"
#include "contact/impulses/impulse_solver.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep::test {
namespace {

/// A stiff sheet that falls on a floor, askew and with some nodes held.
struct FallingSheet {
  static constexpr double dt = 0.1;
  std::unique_ptr<ClothWorld<3>> world;
  ContactTopology<3> topology;
  RCP<const LinearOperator> response;
  InverseMass inverse_mass;
  std::vector<double> velocity;

  FallingSheet() {
    std::vector<DeformableBody<3>> cloths;
    cloths.push_back(sheet<3>(3 * h, up<3>(0.1 * h), h, 1e4));
    cloths.back().locked[2].fill(true);
    world = std::make_unique<ClothWorld<3>>(std::move(cloths), std::vector<RigidBody<3>>(),
                                            Point<3>::Zero());
    const auto& solids = *world->solids;
    response = exact_inverse(solids.solid_block(Teuchos::null, dt), "solids");
    inverse_mass = replicated_inverse_mass(solids);
    velocity.resize(solids.n_unknowns());
    for (std::size_t dof = 0; dof < velocity.size(); ++dof) {
      const bool is_held = inverse_mass.rows[dof].empty();
      velocity[dof] = is_held ? 0 : (dof % 3 == 2 ? -1 : 0.3) - 0.01 * static_cast<double>(dof % 7);
    }
  }
  Contact<3> contact(const ContactShapes<3>& shapes, int vertex) const {
    Contact<3> one;
    one.solid = 0;
    one.other = ~4;
    one.point = shapes.at_vertex(vertex);
    one.x = one.point.position;
    one.normal = Point<3>::UnitZ();
    return one;
  }
};

/// In rounds: what is found in one must hold in the next.
void check_solution(double friction) {
  FallingSheet falling;
  const auto& solids = *falling.world->solids;
  const ContactShapes<3> shapes(solids, falling.topology);
  Mobility<3> mobility(falling.inverse_mass, solids, falling.response);
  ImpulseSolver<3> solver(solids, shapes, mobility, falling.velocity);
  const double target = -0.2;
  std::vector<int> vertices;
  int n_pushed = 0;
  for (int v = 0; v < static_cast<int>(shapes.mesh().vertices.size()); ++v) {
    const bool added = solver.add(falling.contact(shapes, v), target, friction);
    EXPECT_EQ(added, !shapes.held(v));
    if (added)
      vertices.push_back(v);
    if (v % 5 == 4)
      solver.iterate(20, 0);
  }
  solver.iterate(20000, 1e-14);
  EXPECT_EQ(mobility.n_active(), static_cast<int>(vertices.size()) * (friction > 0 ? 3 : 1));

  // Every dof moves as the operator says.
  std::vector<double> impulse = solver.generalized_impulse();
  std::vector<double> free = impulse;
  for (std::size_t dof = 0; dof < free.size(); ++dof) {
    if (falling.inverse_mass.rows[dof].empty())
      free[dof] = 0;
  }
  const auto change = make_vector(solids.map());
  apply(*falling.response, *distributed(solids, free), *change);
  const std::vector<double> expected = replicated(solids, *change);
  for (std::size_t dof = 0; dof < expected.size(); ++dof)
    EXPECT_NEAR(solver.velocity()[dof], falling.velocity[dof] + expected[dof], 1e-11) << dof;

  VelocityRow<3> row;
  for (const int v : vertices) {
    const SurfacePoint<3> point = shapes.at_vertex(v);
    shapes.velocity_row(point, point.position, row);
    Point<3> moved = Point<3>::Zero(), pushed = Point<3>::Zero();
    for (std::size_t k = 0; k < row.dofs.size(); ++k) {
      moved += solver.velocity()[row.dofs[k]] * row.coefficients[k];
      pushed += impulse[row.dofs[k]] * row.coefficients[k];
    }
    n_pushed += pushed.z() > 0 ? 1 : 0;
    EXPECT_GE(pushed.z(), 0);
    EXPECT_GT(moved.z(), target - 1e-9);
    EXPECT_LT(pushed.z() * (moved.z() - target), 1e-9);
    const double along = std::hypot(pushed.x(), pushed.y());
    EXPECT_LE(along, friction * pushed.z() + 1e-12);
    if (friction > 0 && along < 0.999 * friction * pushed.z()) {
      EXPECT_LT(std::hypot(moved.x(), moved.y()), 1e-7);
    }
  }
  EXPECT_GT(n_pushed, 3);
}

TEST(ContactResponses, MeetTheLawsOfContactWithoutFriction) {
  check_solution(0);
}
TEST(ContactResponses, MeetTheLawsOfContactWithFriction) {
  check_solution(0.4);
}

}  // namespace
}  // namespace lockstep::test
