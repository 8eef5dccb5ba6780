// Swept rates of soft solids, beside bodies that share faces with them.
#include "coupling/swept_volumes.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>

#include "interfaces/volume_sweeper.hpp"
#include "support/coupled_case.hpp"

namespace lockstep::test {
namespace {

/// Loose nodes on a closed line, which can be told what it sweeps.
class SoftLoop : public FakeSolid<2>, public VolumeSweeper<2> {
 public:
  explicit SoftLoop(const FakeBody<2>& body) : FakeSolid<2>({body}, {}, Tpetra::getDefaultComm()) {}
  const VolumeSweeper<2>* sweeper() const override { return this; }
  std::vector<char> can_sweep(const Box<2>&) const override { return {1}; }
  std::vector<int> solid_of_row() const override {
    return std::vector<int>(dof_map()->getNodeNumElements(), 0);
  }
  /// Half of both sides of a node.
  RCP<const Vector> swept_per_velocity() const override {
    const auto swept = make_vector(dof_map());
    for (const auto& [from, to] : surface().simplices) {
      const Point<2> side = surface().vertices[to] - surface().vertices[from];
      const Point<2> half(0.5 * side.y(), -0.5 * side.x());
      for (const int node : {from, to}) {
        for (int a = 0; a < 2; ++a) {
          if (const GlobalIndex dof = 2 * node + a; dof_map()->isNodeGlobalElement(dof))
            swept->sumIntoGlobalValue(dof, half[a]);
        }
      }
    }
    return swept;
  }
  void sweep(double, const std::vector<double>&, Vector&) const override {}
};

/// Rate that a loop at rest gets to sweep: in it, beside its left side, a body moves to the right;
/// a second one, if there is one, has no surface.
double rate_of_loop(bool with_unseen) {
  FakeBox<2> box;
  box.n_cells = {8, 8};
  FakeBody<2> loop, body, unseen;
  loop.kind = FakeBody<2>::Kind::nodal;
  loop.closed = false;
  loop.surface = rectangle({1.3, 1.3}, {6.7, 6.7});
  body.surface = rectangle({1.5, 2}, {3, 4.3});
  body.velocity = {1, 0.5};
  unseen.closed = false;
  unseen.velocity = {3, 3};
  Models<2> models = fake_solids<2>({with_unseen ? std::vector{body, unseen} : std::vector{body}});
  models.push_back(std::make_unique<SoftLoop>(loop));
  CoupledCase<2> coupled(box, std::move(models));
  const SweptRates rates =
      swept_rates(coupled.fluid, coupled.solids, coupled.coupling, *coupled.solids.velocity());
  return rates.at(1).at(0);
}

/// The loop sweeps the body's part of shared faces.
TEST(SweptVolumes, WhatNoFluidSeesChangesNoShares) {
  const double alone = rate_of_loop(false);
  EXPECT_GT(std::abs(alone), 0.01);
  EXPECT_NEAR(rate_of_loop(true), alone, 1e-12);
}

}  // namespace
}  // namespace lockstep::test
