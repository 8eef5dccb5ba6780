#include "liquid/drops/drops.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "geometry/generators.hpp"
#include "support/world.hpp"

namespace lockstep::test {
namespace {

/// A unit cube, its first axis periodic or open, walls elsewhere.
template <int dim>
DomainDescription<dim> box_of_drops(int n, SideType type) {
  DomainDescription<dim> description;
  description.grid.spacing = 1.0 / n;
  description.grid.n_cells.fill(n);
  for (auto& side : description.boundary.sides[0])
    side.type = type;
  set_grid_flags(description.boundary, description.grid);
  return description;
}

template <int dim>
MovingSurface<dim> nothing_in_the_way() {
  return {nullptr, nullptr,
          [](const SurfacePoint<dim>&) { return Point<dim>(Point<dim>::Zero()); }};
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> placed(SurfaceMesh<dim> mesh, const Point<dim>& place) {
  for (Point<dim>& x : mesh.vertices)
    x += place;
  SolidDescription solid;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh),
                                                      std::vector<SolidDescription>{solid});
}

/// Adds one on the rank that has this place.
template <int dim>
void add(const MacDomain<dim>& domain, Drops<dim>& drops, Drop<dim> drop) {
  const int cell = domain.grid.cell_containing(drop.position);
  drop.next = drop.velocity;
  if (cell >= 0 && domain.grid.owned(cell))
    drops.add(drop);
}

template <int dim>
std::vector<double> numbers_of(const MacDomain<dim>& domain, const Drops<dim>& drops) {
  std::vector<double> mine;
  for (const Drop<dim>& drop : drops.mine()) {
    const int cell = domain.grid.cell_containing(drop.position);
    EXPECT_TRUE(cell >= 0 && domain.grid.owned(cell));
    mine.insert(mine.end(), drop.position.begin(), drop.position.end());
    mine.insert(mine.end(), drop.velocity.begin(), drop.velocity.end());
    mine.push_back(drop.volume);
  }
  return gather_all(domain.grid.comm(), mine);
}

/// Steps of many cells, from rank to rank.
template <int dim>
void expect_parabola() {
  const MacDomain<dim> domain(box_of_drops<dim>(32, SideType::periodic), world());
  Drops<dim> drops(domain);
  Drop<dim> drop;
  drop.position = Point<dim>::Constant(0.3);
  drop.velocity = Point<dim>::Unit(0) * 2.5 + Point<dim>::Unit(1) * 1.1;
  drop.volume = 1e-5;
  const Drop<dim> start = drop;
  add(domain, drops, drop);
  const Point<dim> g = -2.0 * Point<dim>::Unit(1);
  const double dt = 0.13;
  for (int step = 1; step <= 7; ++step) {
    EXPECT_EQ(drops.fly(nothing_in_the_way<dim>(), g, dt), 0);
    Momentum<dim> given = sum_over_ranks(drops.speed_up(), domain.grid.comm());
    EXPECT_LT((given.linear - start.volume * dt * g).norm(), 1e-20);
    EXPECT_EQ(drops.speed_up().linear.norm(), 0);  // not twice
    const double t = step * dt;
    Point<dim> x = start.position + t * start.velocity + 0.5 * t * t * g;
    x[0] -= std::floor(x[0]);
    const auto found = numbers_of(domain, drops);
    ASSERT_EQ(found.size(), 2U * dim + 1);
    for (int a = 0; a < dim; ++a) {
      EXPECT_NEAR(found[a], x[a], 1e-13);
      EXPECT_NEAR(found[dim + a], start.velocity[a] + t * g[a], 1e-13);
    }
    EXPECT_EQ(found[2 * dim], start.volume);
  }
}

TEST(Drops, FlyAlongParabolas) {
  expect_parabola<2>();
  expect_parabola<3>();
}

TEST(Drops, StopAtWallsAndLeaveThroughOpenSides) {
  const MacDomain<2> domain(box_of_drops<2>(16, SideType::open), world());
  Drops<2> drops(domain);
  add<2>(domain, drops, {{0.5, 0.1}, {0.3, -4}, {}, 1e-4});
  add<2>(domain, drops, {{0.9, 0.8}, {5, 0}, {}, 2e-4});
  drops.fly(nothing_in_the_way<2>(), Point<2>::Zero(), 0.05);
  drops.speed_up();
  drops.count();
  EXPECT_EQ(drops.report().n, 1);
  EXPECT_EQ(drops.report().volume, 1e-4);
  const auto found = numbers_of(domain, drops);
  EXPECT_NEAR(found[0], 0.515, 1e-14);
  EXPECT_NEAR(found[1], 1e-3 / 16, 1e-14);
  EXPECT_EQ(found[2], 0.3);
  EXPECT_EQ(found[3], 0);
}

/// On a body that moves up or down, with a normal that is not along an axis: the drop takes its
/// velocity along the normal and gives it what it loses, exactly; it never gets inside, even where
/// the surface comes at it by more than its way.
template <int dim>
void expect_hit(double speed) {
  const MacDomain<dim> domain(box_of_drops<dim>(16, SideType::open), world());
  const double h = domain.spacing(), radius = 0.2, dt = 0.05;
  Drops<dim> drops(domain);
  const Point<dim> up = Point<dim>::Unit(1);
  Point<dim> center = Point<dim>::Constant(0.5) - 0.15 * up;
  Drop<dim> drop;
  drop.position = center + (radius + 0.3 * h) * up + 0.02 * Point<dim>::Unit(0);
  drop.velocity = -0.5 * up;
  drop.volume = 1e-4;
  add(domain, drops, drop);
  double given = 0;
  for (int step = 0; step < 6; ++step) {
    const auto before = placed<dim>(ball_surface<dim>(radius, h), center);
    center += dt * speed * up;
    const auto after = placed<dim>(ball_surface<dim>(radius, h), center);
    const MovingSurface<dim> surface{
        before, after, [&](const SurfacePoint<dim>&) { return Point<dim>(speed * up); }};
    const Momentum<dim> start = sum_over_ranks(drops.momentum(), domain.grid.comm());
    EXPECT_EQ(drops.fly(surface, -9.8 * up, dt), 0);
    Momentum<dim> pushed;
    for (const SurfaceImpulse<dim>& push : drops.pushes()) {
      pushed.add(push.place, push.impulse);
      EXPECT_NEAR(push.place[0], push.point.position[0], h);
    }
    pushed = sum_over_ranks(pushed, domain.grid.comm());
    const Momentum<dim> change = sum_over_ranks(drops.speed_up(), domain.grid.comm());
    const Momentum<dim> end = sum_over_ranks(drops.momentum(), domain.grid.comm());
    EXPECT_LT((end.linear - start.linear - change.linear).norm(), 1e-18);
    EXPECT_LT((change.linear + pushed.linear - drop.volume * dt * -9.8 * up).norm(), 1e-18);
    given += pushed.linear.norm();
    for (const Drop<dim>& now : drops.mine()) {
      EXPECT_LT(after->inside(now.position), 0);
      EXPECT_GT(after->closest_on_solid(now.position, 0).fraction, 0.02 * h);
    }
  }
  EXPECT_GT(given, drop.volume * 0.3);
  drops.count();
  EXPECT_EQ(drops.report().n, 1);
}

TEST(Drops, GiveSolidsWhatTheyLose) {
  for (const double speed : {-0.3, 0.0, 0.9}) {
    expect_hit<2>(speed);
    expect_hit<3>(speed);
  }
}

/// A solid before an open side stops a drop whose step would end beyond it; a drop that a solid
/// pushes out through the side has left, as any other.
TEST(Drops, MeetSolidsBeforeOpenSides) {
  const MacDomain<2> domain(box_of_drops<2>(16, SideType::open), world());
  Drops<2> drops(domain);
  const auto mesh = box_surface<2>({0.05, 0.8}, 0.1);
  const auto wall = placed<2>(mesh, {0.95, 0.5}), beyond = placed<2>(mesh, {1.1, 0.5});
  add<2>(domain, drops, {{0.8, 0.5}, {6, 0}, {}, 1e-4});
  const MovingSurface<2> at_rest{wall, wall, [](const SurfacePoint<2>&) { return Point<2>(0, 0); }};
  EXPECT_EQ(sum_all(world(), drops.fly(at_rest, Point<2>::Zero(), 0.05)), 0);
  drops.count();
  ASSERT_EQ(drops.report().n, 1);
  EXPECT_NEAR(numbers_of(domain, drops)[0], 0.925 - 0.1 / 16, 1e-12);
  drops.clear();
  add<2>(domain, drops, {{0.99, 0.5}, {0, 0}, {}, 1e-4});
  const MovingSurface<2> pushed{wall, beyond,
                                [](const SurfacePoint<2>&) { return Point<2>(3, 0); }};
  EXPECT_EQ(sum_all(world(), drops.fly(pushed, Point<2>::Zero(), 0.05)), 0);
  EXPECT_TRUE(drops.pushes().empty());
  drops.count();
  EXPECT_EQ(drops.report().n, 0);
}

/// A drop between a wedge that closes and the floor has no room in the end; its volume is told.
TEST(Drops, ThatSolidsCloseInAreTold) {
  const MacDomain<2> domain(box_of_drops<2>(16, SideType::open), world());
  Drops<2> drops(domain);
  add<2>(domain, drops, {{0.5, 0.03}, {0, 0}, {}, 1e-4});
  const auto mesh = box_surface<2>({0.5, 0.25}, 0.1);
  const auto before = placed<2>(mesh, {0.5, 0.2}), after = placed<2>(mesh, {0.5, 0.1249});
  const MovingSurface<2> surface{before, after,
                                 [](const SurfacePoint<2>&) { return Point<2>(0, -1.5); }};
  const double lost = sum_all(domain.grid.comm(), drops.fly(surface, Point<2>::Zero(), 0.05));
  EXPECT_EQ(lost, 1e-4);
  EXPECT_TRUE(drops.pushes().empty());
  drops.count();
  EXPECT_EQ(drops.report().n, 0);
}

TEST(Drops, AreSavedAndComeBack) {
  const std::string folder = testing::TempDir() + "drops" + std::to_string(world()->getSize());
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  const MacDomain<3> domain(box_of_drops<3>(16, SideType::open), world());
  Drops<3> drops(domain);
  for (const bool any : {false, true}) {
    for (int i = 0; i < (any ? 20 : 0); ++i)
      add<3>(domain, drops,
             {{0.03 + 0.045 * i, 0.5 - 0.02 * i, 0.9 - 0.04 * i}, {1. * i, 2, -3}, {}, 1e-5 * i});
    {
      CheckpointWriter writer(world(), folder, {any ? 2 : 1, 0.3, "<ParameterList/>"});
      drops.save(writer);
      writer.finish(1);
    }
    Drops<3> again(domain);
    again.load(CheckpointReader(world(), latest_checkpoint(folder)));
    EXPECT_EQ(numbers_of(domain, again), numbers_of(domain, drops));
    EXPECT_EQ(again.report().n, any ? 20 : 0);
    // reads on one rank what several have written
    const MacDomain<3> alone(box_of_drops<3>(16, SideType::open),
                             Teuchos::rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
    Drops<3> mine(alone);
    mine.load(CheckpointReader(alone.grid.comm(), latest_checkpoint(folder)));
    EXPECT_EQ(mine.mine().size(), any ? 20U : 0U);
  }
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lockstep::test
