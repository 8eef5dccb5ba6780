// Gas bubbles beside solids, with a strategy that solves what they answer.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>

#include "conformance/saddle_problem.hpp"
#include "coupling/gas_solve.hpp"
#include "strategies/register_strategies.hpp"
#include "support/world.hpp"

namespace lockstep::test {
namespace {

/// Gas pushes from outside on all that a closed tank of liquid has for walls that move: the
/// pressure of the liquid takes that up, and nothing moves. The gas cannot get the volume that it
/// lacks, and no pressure does anything about it.
TEST(GasSolve, GasBehindAPistonOfAClosedTankCannotOpen) {
  SaddleOptions options;
  options.open_top = false;
  options.elastic_wall = true;
  options.plate_mass = 50;
  const SaddleProblem problem(world(), options);
  const BlockSystem& blocks = problem.system;
  BlockVector rhs = problem.zero(), unknowns = problem.zero();
  Vector area(rhs.solid->getMap());
  Vector one(rhs.pressure->getMap());
  one.putScalar(1);
  blocks.coupling_transposed()->apply(one, area);
  ASSERT_GT(area.norm2(), 0);

  GasBubble bubble;
  bubble.volume = 1;
  bubble.pressure = 3;
  bubble.keeps_volume = true;
  bubble.missing = 0.1;
  GasProblem gas{{bubble}, {0.}, {area.norm1()}, 0.5, 0.5, true, {}, {}};
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    to.solid->update(pressure[0], area, 1);
  };
  gas.rates = [&](const BlockVector& found, bool) {
    return std::vector<double>{area.dot(*found.solid)};
  };
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  for (const std::string name : {"schur-cg", "direct"}) {
    rhs = problem.zero();
    const auto strategy = registry.create(name, ParameterList());
    strategy->prepare(blocks);
    SolveReport report;
    const std::vector<double> pressure =
        solve_with_gas(gas, {*strategy, blocks, {"S2", 1e-10, 1e-12}}, rhs, unknowns, report);
    EXPECT_EQ(pressure[0], 1.5) << name;
    unknowns.pressure->update(-1.5, one, 1);
    EXPECT_LT(unknowns.pressure->normInf(), 1e-6) << name;
    EXPECT_LT(unknowns.solid->normInf(), 1e-9) << name;
  }
}

/// All around the bubble is one rigid shell: what it pushes on that is round-off, and so is what
/// that would open. No pressure may be made of their quotient.
TEST(GasSolve, GasWithinOneShellPushesOnNothing) {
  SaddleOptions options;
  options.open_top = true;
  const SaddleProblem problem(world(), options);
  BlockVector rhs = problem.zero(), unknowns = problem.zero();
  const double perimeter = 0.25, leftover = 1e-17;
  GasBubble bubble;
  bubble.volume = 1;
  bubble.pressure = 3;
  bubble.keeps_volume = true;
  bubble.missing = 1e-12;
  GasProblem gas{{bubble}, {0.}, {perimeter}, 0.5, 0.5, true, {}, {}};
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    Vector pushed(to.solid->getMap());
    pushed.putScalar(leftover * pressure[0]);
    to.solid->update(1, pushed, 1);
  };
  gas.rates = [&](const BlockVector& found, bool) {
    Vector pushed(found.solid->getMap());
    pushed.putScalar(leftover);
    return std::vector<double>{pushed.dot(*found.solid)};
  };
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  const auto strategy = registry.create("direct", ParameterList());
  strategy->prepare(problem.system);
  SolveReport report;
  const std::vector<double> pressure =
      solve_with_gas(gas, {*strategy, problem.system, {"S2", 1e-10, 1e-12}}, rhs, unknowns, report);
  EXPECT_EQ(pressure[0], 1.5);
  EXPECT_LT(unknowns.solid->normInf(), 1e-12);
}

/// Leaves a known part of every solution to be found.
class InexactStrategy : public SolverStrategy {
 public:
  explicit InexactStrategy(SolverStrategy& exact) : exact_(exact) {}
  std::string name() const override { return "inexact"; }
  void prepare(const BlockSystem& system) override { exact_.prepare(system); }
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    const SolveReport report = exact_.solve(system, rhs, solution, request);
    solution.pressure->scale(1 - 1e-10);
    return report;
  }

 private:
  SolverStrategy& exact_;
};

/// The bubble is the only air of a tank: liquid that cannot be compressed comes back from it as it
/// goes, but for what a solve leaves.
TEST(GasSolve, TheOnlyVoidCannotOpen) {
  SaddleOptions options;
  options.open_top = true;
  options.with_solid = false;
  const SaddleProblem problem(world(), options);
  const BlockSystem& blocks = problem.system;
  BlockVector rhs = problem.zero(), unknowns = problem.zero();
  Vector one(rhs.pressure->getMap()), beside(rhs.pressure->getMap());
  one.putScalar(1);
  apply(*blocks.pressure_block(), one, beside);
  GasBubble bubble;
  bubble.volume = 1;
  bubble.pressure = 3;
  bubble.keeps_volume = true;
  bubble.missing = 0.1;
  GasProblem gas;
  gas.bubbles = {bubble};
  gas.conductance = {beside.dot(one)};
  gas.push_size = {0.};
  gas.dt = gas.step_dt = 0.5;
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    to.pressure->update(pressure[0], beside, 1);
  };
  gas.rates = [&](const BlockVector& found, bool) {
    return std::vector<double>{-beside.dot(*found.pressure)};
  };
  ASSERT_GT(gas.conductance[0], 1e-3);
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  const auto exact = registry.create("direct", ParameterList());
  InexactStrategy strategy(*exact);
  strategy.prepare(blocks);
  SolveReport report;
  const std::vector<double> pressure =
      solve_with_gas(gas, {strategy, blocks, {"S2", 1e-10, 1e-12}}, rhs, unknowns, report);
  EXPECT_EQ(pressure[0], 1.5);
}

/// S1 finds the velocity at half a step, by which solids move over the whole of it.
TEST(GasSolve, WhatABubbleLacksIsMadeGoodInTheStep) {
  SaddleOptions options;
  options.open_top = true;
  const SaddleProblem problem(world(), options);
  const BlockSystem& blocks = problem.system;
  BlockVector rhs = problem.zero(), unknowns = problem.zero();
  Vector beside(rhs.pressure->getMap());  // flow beside one cell, a unit of area
  if (beside.getMap()->getMinAllGlobalIndex() == beside.getMap()->getMinGlobalIndex())
    beside.replaceLocalValue(0, 1.0);

  GasBubble bubble;
  bubble.volume = 1;
  bubble.keeps_volume = true;
  bubble.missing = 0.1;
  const double conductance = 1e6, step_dt = 0.5;
  GasProblem gas{{bubble}, {conductance}, {0.}, step_dt / 2, step_dt, true, {}, {}};
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    to.pressure->update(pressure[0], beside, 1);
  };
  gas.rates = [&](const BlockVector& found, bool) {
    return std::vector<double>{-beside.dot(*found.pressure)};
  };
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  const auto strategy = registry.create("direct", ParameterList());
  strategy->prepare(blocks);
  SolveReport report;
  const std::vector<double> pressure =
      solve_with_gas(gas, {*strategy, blocks, {"S1", 1e-10, 1e-12}}, rhs, unknowns, report);
  EXPECT_NEAR(conductance * pressure[0] + gas.rates(unknowns, false)[0], bubble.missing / step_dt,
              1e-9);
}

}  // namespace
}  // namespace lockstep::test
