#include "liquid/watch/leak_audit.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

class ToldInterface : public FixedInterface<2> {
 public:
  using FixedInterface<2>::FixedInterface;
  WatchedLiquid liquid_in(const std::vector<char>&) const override { return {1, 2, 0}; }
};

/// A box without lid from (.885, 1.085) to (3.915, 3.115), its inside watched; 48 x 48 cells of
/// 0.1.
struct Harbour {
  Harbour() : domain(description(), world()), ray_halo(domain.grid), interface(domain) {
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
  LeakAudit<2> audit(const Point<2>& point) {
    Watch<2> watch;
    watch.name = "Hold";
    watch.point = point;
    watch.radius = 2.2;
    LeakAudit<2> result(domain, {watch});
    result.begin(surface.before);
    return result;
  }
  /// Message of the audit for liquid that was here and is there; empty: there is none.
  std::string verdict(const SignedDistance<2>& here, const SignedDistance<2>& there) {
    LeakAudit<2> result = audit(Point<2>(2.4, 1.5));
    const InterfaceStep<2> step{velocity, surface, ray_halo, kept, 0, 0.01, {}, {}};
    interface.initialise(here, nullptr);
    result.open(step, interface);
    interface.initialise(there, nullptr);
    try {
      result.close(step, interface, 0.5);
    } catch (const SolveError& error) {
      return error.what();
    }
    EXPECT_EQ(result.report().front().volume, 1);
    EXPECT_EQ(result.report().front().leak, 0);
    return "";
  }

  MacDomain<2> domain;
  RayHalo<2> ray_halo;
  KeptSurface<2> kept;
  FaceField<2> velocity;
  MovingSurface<2> surface;
  Solids<2> solids;
  ToldInterface interface;
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
  EXPECT_NE(said.find("watch \"Hold\", the first at 2.45, 1.15"), std::string::npos) << said;
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

/// Tells how many cells are watched.
class CountingInterface : public FixedInterface<2> {
 public:
  explicit CountingInterface(const MacDomain<2>& domain)
      : FixedInterface<2>(domain), domain_(domain) {
    initialise([](const Point<2>&) { return 1.0; }, nullptr);
  }
  WatchedLiquid liquid_in(const std::vector<char>& cells) const override {
    double n = 0;
    domain_.grid.for_each_owned_cell([&](int cell) { n += cells[cell]; });
    n = sum_all(domain_.grid.comm(), n);
    return {n, n, 0};
  }

 private:
  const MacDomain<2>& domain_;
};

/// 48 x 48 cells of 0.1 without liquid, among solids that move from step to step.
struct Place {
  using Surface = std::shared_ptr<const SurfaceSnapshot<2>>;
  Place(const DomainDescription<2>& description, const Point<2>& point, const Surface& start)
      : domain(description, world()), ray_halo(domain.grid), interface(domain), now(start) {
    for (auto& component : velocity)
      component.assign(domain.grid.n_stored_cells(), 0);
    Watch<2> watch;
    watch.name = "Place";
    watch.point = point;
    audit = std::make_unique<LeakAudit<2>>(domain, std::vector<Watch<2>>{watch});
    audit->begin(start);
  }
  /// Number of cells that are watched once the solids have come to this place.
  double cells_after(const Surface& next) {
    const MovingSurface<2> surface{now, next, {}};
    const InterfaceStep<2> step{velocity, surface, ray_halo, kept, 0, 0.01, {}, {}};
    audit->open(step, interface);
    audit->close(step, interface, 0.5);
    now = next;
    return audit->report().front().volume;
  }

  MacDomain<2> domain;
  RayHalo<2> ray_halo;
  KeptSurface<2> kept;
  FaceField<2> velocity;
  CountingInterface interface;
  Surface now;
  std::unique_ptr<LeakAudit<2>> audit;
};

/// A shell around 10 x 10 cells, with a bar in it that is 3 cells wide and high.
std::shared_ptr<const SurfaceSnapshot<2>> room_with_bar(const Point<2>& place) {
  return Solids<2>()
      .add(box_surface<2>(Point<2>(1.03, 1.03), 0.1), Point<2>(2.4, 2.4), false)
      .add(box_surface<2>(Point<2>(0.28, 0.28), 0.1), place, true)
      .snapshot();
}

/// A body that comes over the point hides all cells from it; the place is still the room, after a
/// restart too, in which nothing but the fields is left of what was.
TEST(LeakAudit, APlaceStaysWhereABodyCoversItsPoint) {
  const auto beside = room_with_bar({2.15, 2.45}), above = room_with_bar({2.45, 2.45});
  Place place(Harbour::description(), Point<2>(2.43, 2.46), beside);
  EXPECT_EQ(place.cells_after(beside), 91);
  EXPECT_EQ(place.cells_after(above), 91);
  EXPECT_EQ(place.cells_after(above), 91);
  Place later(Harbour::description(), Point<2>(2.43, 2.46), beside);
  *later.audit->fields()[0].components[0] = *place.audit->fields()[0].components[0];
  later.now = above;
  EXPECT_EQ(later.cells_after(above), 91);
  EXPECT_EQ(place.cells_after(beside), 91);
}

/// Walls that come together over all centres of cells leave nothing that could be watched, which is
/// not to be taken for a place without liquid.
TEST(LeakAudit, APlaceOfNoCellIsNotWatched) {
  const auto room = [](double width) {
    SurfaceMesh<2> walls = box_surface<2>(Point<2>(1.03, 1.03), 0.1);
    for (Point<2>& x : walls.vertices)
      x *= width / 1.03;
    return Solids<2>().add(walls, Point<2>(2.41, 2.405), false).snapshot();
  };
  Place place(Harbour::description(), Point<2>(2.41, 2.405), room(1.03));
  EXPECT_EQ(place.cells_after(room(0.83)), 64);
  place.cells_after(room(0.04));
  EXPECT_TRUE(std::isnan(place.audit->report().front().volume));
  EXPECT_EQ(place.cells_after(room(0.83)), 64);
}

/// A point before the first centre, from which a wall parts it, sees the last one through the
/// periodic side.
TEST(LeakAudit, APointSeesThroughAPeriodicSide) {
  DomainDescription<2> description = Harbour::description();
  for (auto& side : description.boundary.sides[0])
    side.type = SideType::periodic;
  set_grid_flags(description.boundary, description.grid);
  const auto walls = Solids<2>()
                         .add(plate_surface<2>(Point<2>(0, 6), 0, 0.1), Point<2>(0.035, 2.4), false)
                         .add(plate_surface<2>(Point<2>(0, 6), 0, 0.1), Point<2>(2.4, 2.4), false)
                         .snapshot();
  std::optional<Place> place;
  ASSERT_NO_THROW(place.emplace(description, Point<2>(0.02, 2.43), walls));
  EXPECT_EQ(place->cells_after(walls), 24 * 48);
}

TEST(LeakAudit, PointsMustSeeCells) {
  Harbour harbour;
  EXPECT_THROW(harbour.audit(Point<2>(2.4, 8.0)), InputError);
  EXPECT_NO_THROW(harbour.audit(Point<2>(2.4, 0.5)));
}

}  // namespace
}  // namespace lockstep::test
