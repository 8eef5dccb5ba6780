#include <gtest/gtest.h>

#include "bath.hpp"
#include "liquid/particles/level_set.hpp"

namespace lockstep::test {
namespace {

ParameterList with_drops() {
  ParameterList list;
  list.set<std::string>("Drops", "ballistic");
  return list;
}

/// A ball of water that the flow draws out until the grid loses it, above a pool.
template <int dim>
struct Torn {
  static constexpr int n = dim == 2 ? 40 : 24;
  static constexpr double h = 1.0 / n;

  explicit Torn(const Communicator& comm) : bath(closed_cube<dim>(n), comm) {
    const Point<dim> up = Point<dim>::Unit(1), middle = Point<dim>::Constant(0.5);
    bath.set_velocity([&](const Point<dim>& x) {
      // The flow has no divergence, and is at rest in the pool.
      const double above = std::max(x[1] - 0.3, 0.0);
      Point<dim> u = Point<dim>::Zero();
      u[0] = 6 * (x[0] - 0.5) * above;
      u[1] = -3 * above * above;
      return u;
    });
    model = bath.make("particle level set", with_drops());
    model->initialise(
        [=](const Point<dim>& x) {
          return std::min(x[1] - 0.2, (x - middle - 0.15 * up).norm() - 3 * h);
        },
        nullptr);
  }
  void step(double dt, const Point<dim>& gravity) {
    model->advance({bath.velocity, bath.surface, bath.ray_halo, bath.kept, 0, dt, {}, {}, gravity});
  }
  Bath<dim> bath;
  std::unique_ptr<InterfaceModel<dim>> model;
};

/// The target volume of the liquid and the volume of the drops add up to the same all the time, to
/// round-off; there are drops in between, and in the end all have fallen into the pool.
template <int dim>
void expect_volume(const Communicator& comm, std::vector<double>& history) {
  Torn<dim> torn(comm);
  const double start = torn.model->ledger().target;
  long long most = 0;
  const double dt = 0.02;
  for (int i = 0; i < 180; ++i) {
    if (i == 150)
      torn.bath.set_velocity([](const Point<dim>&) { return Point<dim>(Point<dim>::Zero()); });
    torn.step(dt, -9.8 * Point<dim>::Unit(1));
    torn.model->drops()->speed_up();
    const DropsReport drops = torn.model->drops()->report();
    most = std::max(most, drops.n);
    EXPECT_NEAR(torn.model->ledger().target + drops.volume, start, 1e-14);
    EXPECT_EQ(torn.model->ledger().lost, 0);
    history.push_back(static_cast<double>(drops.n));
    history.push_back(torn.model->ledger().target);
    for (const Drop<dim>& drop : torn.model->drops()->mine()) {
      EXPECT_LE(drop.volume, (1 + 1e-12) * std::pow(Torn<dim>::h, dim) / 16);
      EXPECT_GT(drop.volume, 0);
    }
  }
  EXPECT_GT(most, 5);
  EXPECT_EQ(torn.model->drops()->report().n, 0);
  EXPECT_NEAR(torn.model->ledger().volume, start, 1e-3 * start);
}

TEST(DropBirths, KeepTheVolume) {
  std::vector<double> shared, alone;
  expect_volume<2>(world(), shared);
  expect_volume<2>(self(), alone);
  // Nothing here is solved for: any number of ranks finds the same.
  ASSERT_EQ(shared.size(), alone.size());
  for (std::size_t i = 0; i < shared.size(); ++i)
    EXPECT_NEAR(shared[i], alone[i], 1e-12);
}

TEST(DropBirths, KeepTheVolumeInSpace) {
  std::vector<double> history;
  expect_volume<3>(world(), history);
}

/// They leave with the velocity that the flow has where they are.
TEST(DropBirths, HaveTheVelocityOfTheFlow) {
  Torn<2> torn(world());
  double n_new = 0;
  for (int i = 0; i < 20; ++i) {
    torn.model->drops()->clear();
    torn.step(0.02, Point<2>::Zero());
    for (const Drop<2>& drop : torn.model->drops()->mine()) {
      const Point<2>& x = drop.position;
      const double above = std::max(x[1] - 0.3, 0.0);
      const Point<2> exact{6 * (x[0] - 0.5) * above, -3 * above * above};
      EXPECT_LT((drop.velocity - exact).norm(), 0.01);
      ++n_new;
    }
  }
  EXPECT_GT(sum_all(world(), n_new), 0);
}

/// Without the option the same interface, and no drops.
TEST(DropBirths, AreAnOption) {
  Bath<2> bath(closed_cube<2>(16));
  EXPECT_EQ(bath.make("particle level set")->drops(), nullptr);
  EXPECT_EQ(bath.make("level set")->drops(), nullptr);
  EXPECT_EQ(bath.make("volume of fluid")->drops(), nullptr);
}

}  // namespace
}  // namespace lockstep::test
