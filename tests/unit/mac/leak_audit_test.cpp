#include "leaks/leak_audit.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

/// A box without lid from (.885, 1.085) to (3.915, 3.115); 48 x 48 cells of 0.1.
struct Harbour {
  Harbour() : domain(description(), world()), ray_halo(domain.grid) {
    solids.add(open_box_surface<2>(Point<2>(3.03, 2.03), 0.1), Point<2>(2.4, 2.1), false);
    for (auto& component : velocity)
      component.assign(domain.grid.n_stored_cells(), 0);
    surface.before = surface.after = solids.snapshot();
  }
  static DomainDescription<2> description() {
    DomainDescription<2> result;
    result.grid.spacing = 0.1;
    result.grid.n_cells.fill(48);
    return result;
  }
  /// Message of the audit for liquid that was here and is there; empty: there is none.
  std::string verdict(const SignedDistance<2>& here, const SignedDistance<2>& there) {
    const InterfaceStep<2> step{velocity, surface, ray_halo, kept, 0, 0.01, {}, {}};
    const auto where = [&](const SignedDistance<2>& distance) {
      return [&](const SolidCells<2>& solids) {
        const int n = domain.grid.n_stored_cells();
        LiquidCells cells{std::vector<char>(n, 0), std::vector<char>(n, 0)};
        domain.grid.for_each_stored_cell([&](int cell) {
          cells.seen[cell] = solids.is_fluid(cell) && distance(domain.grid.center(cell)) < 0;
        });
        return cells;
      };
    };
    LeakAudit<2> audit(domain);
    audit.open(step, where(here));
    try {
      audit.close(step, where(there));
    } catch (const SolveError& error) {
      return error.what();
    }
    return "";
  }

  MacDomain<2> domain;
  RayHalo<2> ray_halo;
  KeptSurface<2> kept;
  FaceField<2> velocity;
  MovingSurface<2> surface;
  Solids<2> solids;
};

SignedDistance<2> below(double height) {
  return [height](const Point<2>& x) { return x[1] - height; };
}
SignedDistance<2> ball(const Point<2>& center, double radius) {
  return [=](const Point<2>& x) { return (x - center).norm() - radius; };
}
SignedDistance<2> both(const SignedDistance<2>& a, const SignedDistance<2>& b) {
  return [=](const Point<2>& x) { return std::min(a(x), b(x)); };
}

TEST(LeakAudit, WhatComesThroughAHullIsALeak) {
  Harbour harbour;
  const SignedDistance<2> sea = below(1.04);
  EXPECT_EQ(harbour.verdict(sea, sea), "");
  const std::string said = harbour.verdict(sea, both(sea, ball({2.45, 1.15}, 0.04)));
  EXPECT_NE(said.find("in 1 cells, the first at 2.45, 1.15"), std::string::npos) << said;
}

TEST(LeakAudit, WaterInsideMoves) {
  Harbour harbour;
  EXPECT_EQ(harbour.verdict(ball({2.4, 2.1}, 0.5), ball({2.45, 2.05}, 0.5)), "");
  EXPECT_NE(harbour.verdict(ball({1.5, 1.5}, 0.3), ball({3.3, 1.5}, 0.3)), "");
}

/// Over the rim a way is open, along the wall none is.
TEST(LeakAudit, WaterComesOverTheRim) {
  Harbour harbour;
  const SignedDistance<2> drop = ball({0.85, 3.15}, 0.12);
  EXPECT_EQ(harbour.verdict(drop, both(drop, ball({0.95, 3.05}, 0.04))), "");
  const SignedDistance<2> low = ball({0.85, 2.15}, 0.06);
  EXPECT_NE(harbour.verdict(low, both(low, ball({0.95, 2.05}, 0.04))), "");
}

/// A wall that moves over a cell takes its water along on its own side.
TEST(LeakAudit, AWallPushesWater) {
  Harbour harbour;
  Solids<2> moved;
  moved.add(open_box_surface<2>(Point<2>(3.03, 2.03), 0.1), Point<2>(2.52, 2.1), false);
  harbour.surface.after = moved.snapshot();
  // The left wall goes from .885 to 1.005 over the centres at .95, the right one from 3.915
  // to 4.035.
  EXPECT_EQ(harbour.verdict(ball({0.95, 2.05}, 0.04), ball({1.05, 2.05}, 0.04)), "");
  EXPECT_NE(harbour.verdict(ball({3.95, 2.05}, 0.04), ball({3.95, 2.05}, 0.04)), "");
  EXPECT_EQ(harbour.verdict(ball({3.95, 2.05}, 0.04), ball({4.05, 2.05}, 0.04)), "");
}

}  // namespace
}  // namespace lockstep::test
