#include "liquid/watch/watched_places.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

DomainDescription<2> description() {
  DomainDescription<2> result;
  result.grid.spacing = 0.1;
  result.grid.n_cells.fill(48);
  return result;
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
    return {n, n};
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
    places = std::make_unique<WatchedPlaces<2>>(domain, std::vector<Watch<2>>{watch});
    places->begin(start);
  }
  /// Number of cells that are watched once the solids have come to this place.
  double cells_after(const Surface& next) {
    const MovingSurface<2> surface{now, next, {}};
    const InterfaceStep<2> step{velocity, surface, ray_halo, kept, 0, 0.01, {}, {}};
    places->measure(step, interface);
    now = next;
    return places->report().front().volume;
  }

  MacDomain<2> domain;
  RayHalo<2> ray_halo;
  KeptSurface<2> kept;
  FaceField<2> velocity;
  CountingInterface interface;
  Surface now;
  std::unique_ptr<WatchedPlaces<2>> places;
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
TEST(WatchedPlaces, APlaceStaysWhereABodyCoversItsPoint) {
  const auto beside = room_with_bar({2.15, 2.45}), above = room_with_bar({2.45, 2.45});
  Place place(description(), Point<2>(2.43, 2.46), beside);
  EXPECT_EQ(place.cells_after(beside), 91);
  EXPECT_EQ(place.cells_after(above), 91);
  EXPECT_EQ(place.cells_after(above), 91);
  Place later(description(), Point<2>(2.43, 2.46), beside);
  *later.places->fields()[0].components[0] = *place.places->fields()[0].components[0];
  later.now = above;
  EXPECT_EQ(later.cells_after(above), 91);
  EXPECT_EQ(place.cells_after(beside), 91);
}

/// Walls that come together over all centres of cells leave nothing that could be watched, which is
/// not to be taken for a place without liquid.
TEST(WatchedPlaces, APlaceOfNoCellIsNotWatched) {
  const auto room = [](double width) {
    SurfaceMesh<2> walls = box_surface<2>(Point<2>(1.03, 1.03), 0.1);
    for (Point<2>& x : walls.vertices)
      x *= width / 1.03;
    return Solids<2>().add(walls, Point<2>(2.41, 2.405), false).snapshot();
  };
  Place place(description(), Point<2>(2.41, 2.405), room(1.03));
  EXPECT_EQ(place.cells_after(room(0.83)), 64);
  place.cells_after(room(0.04));
  EXPECT_TRUE(std::isnan(place.places->report().front().volume));
  EXPECT_EQ(place.cells_after(room(0.83)), 64);
}

/// A point before the first centre, from which a wall parts it, sees the last one through the
/// periodic side.
TEST(WatchedPlaces, APointSeesThroughAPeriodicSide) {
  DomainDescription<2> periodic = description();
  for (auto& side : periodic.boundary.sides[0])
    side.type = SideType::periodic;
  set_grid_flags(periodic.boundary, periodic.grid);
  const auto walls = Solids<2>()
                         .add(plate_surface<2>(Point<2>(0, 6), 0, 0.1), Point<2>(0.035, 2.4), false)
                         .add(plate_surface<2>(Point<2>(0, 6), 0, 0.1), Point<2>(2.4, 2.4), false)
                         .snapshot();
  std::optional<Place> place;
  ASSERT_NO_THROW(place.emplace(periodic, Point<2>(0.02, 2.43), walls));
  EXPECT_EQ(place->cells_after(walls), 24 * 48);
}

TEST(WatchedPlaces, PointsMustSeeCells) {
  EXPECT_THROW(Place(description(), Point<2>(2.4, 8.0), nullptr), InputError);
  EXPECT_NO_THROW(Place(description(), Point<2>(2.4, 0.5), nullptr));
}

}  // namespace
}  // namespace lockstep::test
