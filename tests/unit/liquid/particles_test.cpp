#include <gtest/gtest.h>

#include <filesystem>

#include "advection_cases.hpp"
#include "geometry/generators.hpp"
#include "liquid/particles/level_set.hpp"
#include "liquid/particles/particle_correction.hpp"
#include "liquid/particles/particle_motion.hpp"
#include "output/checkpoint.hpp"
#include "transport/transport.hpp"

namespace lockstep::test {
namespace {

const char* const name = "particle level set";

template <int dim>
const LevelSet<dim>& level_set(const InterfaceModel<dim>& model) {
  return dynamic_cast<const LevelSet<dim>&>(model);
}

/// Global cell and what is in it, in an order that does not depend on how they are kept.
template <int dim>
using Census = std::vector<std::array<double, dim + 2>>;

template <int dim>
Census<dim> census(const Bath<dim>& bath, const InterfaceModel<dim>& model) {
  std::vector<double> mine;
  const auto& tiles = level_set(model).particles();
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (const Particle<dim>& p : tiles[t]) {
      const int cell = static_cast<int>(t) * tile_volume<dim> + p.cell_in_tile();
      mine.push_back(static_cast<double>(bath.domain.grid.global_id(cell)));
      mine.insert(mine.end(), p.x.begin(), p.x.end());
      mine.push_back(p.radius);
    }
  const auto all = gather_all(bath.domain.grid.comm(), mine);
  Census<dim> result(all.size() / (dim + 2));
  for (std::size_t i = 0; i < all.size(); ++i)
    result[i / (dim + 2)][i % (dim + 2)] = all[i];
  std::sort(result.begin(), result.end());
  return result;
}

template <int dim>
void expect_particles_at_their_distance() {
  const double h = dim == 2 ? 1.0 / 48 : 1.0 / 24;
  Bath<dim> bath(open_cube<dim>(dim == 2 ? 48 : 24));
  const auto model = bath.make(name);
  const Point<dim> center = Point<dim>::Constant(0.507);
  model->initialise(ball<dim>(center, 0.28), nullptr);
  const auto& grid = bath.domain.grid;
  const auto& tiles = level_set(*model).particles();
  double n = 0, n_cells = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (const Particle<dim>& p : tiles[t]) {
      Point<dim> x = p.position();
      for (int a = 0; a < dim; ++a)
        x[a] = (x[a] + grid.tile_begin(static_cast<int>(t))[a]) * h;
      const double distance = ((x - center).norm() - 0.28) / h;
      ++n;
      EXPECT_EQ(p.side() > 0, distance > 0);
      EXPECT_LT(std::abs(distance), 3.5);
      EXPECT_GT(std::abs(distance), 0.05);
      EXPECT_NEAR(p.size(), std::clamp(std::abs(distance), 0.1, 0.5), 0.15);
    }
  grid.for_each_owned_cell([&](int c) { n_cells += std::abs(model->distance()[c]) < 3 * h; });
  n = sum_all(world(), n);
  n_cells = sum_all(world(), n_cells);
  EXPECT_GT(n, 14 * n_cells);
  EXPECT_LE(n, 16 * n_cells);
}

TEST(Particles, AreSeededAtTheirDistance) {
  expect_particles_at_their_distance<2>();
  expect_particles_at_their_distance<3>();
}

template <int dim>
void expect_same_on_any_ranks() {
  Bath<dim> bath(open_cube<dim>(dim == 2 ? 70 : 30)), alone(bath.description, self());
  for (auto* b : {&bath, &alone})
    b->set_velocity(swirl<dim>);
  const auto model = bath.make(name), model_alone = alone.make(name);
  for (auto* m : {model.get(), model_alone.get()})
    m->initialise(ball<dim>(Point<dim>::Constant(0.45), 0.25), nullptr);
  // Over two reseedings.
  for (int i = 0; i < 45; ++i) {
    bath.step(*model, 0, 0.04);
    alone.step(*model_alone, 0, 0.04);
  }
  bath.domain.grid.for_each_stored_cell([&](int c) {
    const int other = alone.domain.grid.cell(bath.domain.grid.coordinates(c));
    ASSERT_NEAR(model->distance()[c], model_alone->distance()[other], 1e-13);
  });
  const auto here = census(bath, *model), there = census(alone, *model_alone);
  ASSERT_EQ(here.size(), there.size());
  ASSERT_GT(here.size(), 1000U);
  for (std::size_t i = 0; i < here.size(); ++i)
    for (int k = 0; k < dim + 2; ++k)
      ASSERT_NEAR(here[i][k], there[i][k], 1e-5);
}

TEST(Particles, AreTheSameOnAnyNumberOfRanks) {
  expect_same_on_any_ranks<2>();
  expect_same_on_any_ranks<3>();
}

/// Small air components in the lower corners of all tiles, so that some touch a border, wherever
/// ranks meet: their particles go with them, those beyond the border too.
template <int dim>
void expect_small_voids_go_on_any_ranks() {
  constexpr int width = tile_width<dim>, n = 4 * width;
  const double h = 1.0 / n;
  Bath<dim> bath(closed_cube<dim>(n)), alone(bath.description, self());
  const SignedDistance<dim> distance = [&](const Point<dim>& x) {
    Point<dim> middle;  // middle of the nearest
    for (int a = 0; a < dim; ++a)
      middle[a] = h * (1 + width * std::clamp<long>(std::lround(x[a] / (width * h)), 1, 3));
    return std::max(x[dim - 1] - (n - 3) * h, 1.5 * h - (x - middle).norm());
  };
  const auto model = bath.make(name), model_alone = alone.make(name);
  for (auto* m : {model.get(), model_alone.get()})
    m->initialise(distance, nullptr);
  for (auto* b : {&bath, &alone})
    b->set_velocity([](const Point<dim>&) { return Point<dim>(0.1 * Point<dim>::Unit(0)); });
  bath.step(*model, 0, h);
  alone.step(*model_alone, 0, h);
  EXPECT_EQ(census(bath, *model).size(), census(alone, *model_alone).size());
}

TEST(Particles, OfFilledVoidsGoOnAnyNumberOfRanks) {
  expect_small_voids_go_on_any_ranks<2>();
  expect_small_voids_go_on_any_ranks<3>();
}

template <int dim>
void expect_restart() {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("lockstep_interface_" + std::to_string(world()->getSize())))
                                 .string();
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  Bath<dim> bath(open_cube<dim>(dim == 2 ? 40 : 20));
  bath.set_velocity(swirl<dim>);
  const auto model = bath.make(name), loaded = bath.make(name);
  model->initialise(ball<dim>(Point<dim>::Constant(0.45), 0.25), nullptr);
  const auto advance = [&](InterfaceModel<dim>& m) {
    for (int i = 0; i < 12; ++i)
      bath.step(m, 0, 0.05);
  };
  advance(*model);
  {
    CheckpointWriter writer(world(), folder, {1, 0.3, "<ParameterList/>"});
    model->save(writer);
    writer.finish(1);
  }
  loaded->load(CheckpointReader(world(), latest_checkpoint(folder)));
  advance(*model);
  advance(*loaded);
  bath.domain.grid.for_each_stored_cell(
      [&](int c) { ASSERT_EQ(model->distance()[c], loaded->distance()[c]); });
  EXPECT_EQ(census(bath, *model), census(bath, *loaded));
  EXPECT_EQ(model->ledger().volume, loaded->ledger().volume);
  EXPECT_EQ(model->ledger().target, loaded->ledger().target);
  EXPECT_EQ(model->ledger().shift, loaded->ledger().shift);
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

TEST(Particles, CheckpointRestoresBitForBit) {
  expect_restart<2>();
  expect_restart<3>();
}

/// A step that is taken back leaves no trace.
/// A closed shell, empty in a pool or half full in the air, is driven through rough flow. What was
/// dry stays dry, what is inside remains there, and no particle of the liquid changes sides.
template <int dim>
void expect_shell_in_pool(bool half_full) {
  const int n = dim == 2 ? 48 : 24;
  Bath<dim> bath(closed_cube<dim>(n));
  const auto model = bath.make(name);
  const double dt = 1.2 / n, radius = 0.21;
  const auto center = [&](int i) {
    return Point<dim>(Point<dim>::Constant(0.5) + 0.1 * std::sin(0.8 * i) * Point<dim>::Unit(0) +
                      0.1 * std::sin(0.5 * i) * Point<dim>::Unit(1));
  };
  const SurfaceMesh<dim> shell = ball_surface<dim>(radius, 0.7 / n);
  const auto at = [&](int i) { return snapshot<dim>(shell, center(i), false); };
  bath.set_velocity([](const Point<dim>& x) {
    Point<dim> u;
    for (int a = 0; a < dim; ++a)
      u[a] = std::sin(31 * x[a] + 17 * x[(a + 1) % dim] + a);
    return u;
  });
  auto before = at(0);
  model->initialise(
      [&](const Point<dim>& x) {
        const bool inside = (x - center(0)).norm() < radius;
        const double level = x[dim - 1] - (inside ? 0.48 : 0.55);
        return inside == half_full ? level : std::max(level, 0.02);
      },
      before);
  const double target = model->ledger().target;
  for (int i = 0; i < 12; ++i) {
    auto after = at(i + 1);
    bath.move(before, after, dt);
    bath.step(*model, i * dt, dt);
    before = after;
    double inside = 0;
    bath.domain.grid.for_each_owned_cell([&](int c) {
      const double distance = (bath.domain.grid.center(c) - center(i + 1)).norm() - radius;
      const bool is_wet = model->distance()[c] < 0;
      if (distance < -0.2 / n)
        inside += is_wet;
      // Liquid is either in the pool or inside, never in both.
      if (is_wet && std::abs(distance) > 0.2 / n) {
        ASSERT_EQ(distance < 0, half_full)
            << "step " << i << " at " << bath.domain.grid.center(c).transpose();
      }
    });
    EXPECT_EQ(sum_all(world(), inside) > 0, half_full);
    if (half_full) {
      EXPECT_NEAR(model->ledger().target + model->ledger().lost, target, 1e-12);
    }
    const auto& tiles = level_set(*model).particles();
    for (std::size_t t = 0; t < tiles.size(); ++t)
      for (const Particle<dim>& p : tiles[t]) {
        Point<dim> x = p.position();
        for (int a = 0; a < dim; ++a)
          x[a] = (x[a] + bath.domain.grid.tile_begin(static_cast<int>(t))[a]) / n;
        const double distance = (x - center(i + 1)).norm() - radius;
        if (std::abs(distance) > 0.05 / n && p.side() < 0) {
          ASSERT_EQ(distance < 0, half_full);
        }
      }
  }
}

TEST(Particles, AClosedShellLetsNothingThrough) {
  for (const bool half_full : {false, true}) {
    expect_shell_in_pool<2>(half_full);
    expect_shell_in_pool<3>(half_full);
  }
}

/// Air that a solid and liquid enclose in a part of a cell goes; beside an air cell, away from
/// solids, and of the liquid all stay.
template <int dim>
void expect_trapped_air_goes() {
  constexpr int n = 24;
  const double h = 1.0 / n, radius = 0.21;
  Bath<dim> bath(closed_cube<dim>(n), self());
  const Point<dim> middle = Point<dim>::Constant(0.5);
  const auto surface = snapshot<dim>(ball_surface<dim>(radius, 0.5 * h), middle, true);
  const auto solids = find_solid_cells<dim>(bath.domain, surface);
  // The upper half of space is air.
  CellField phi(bath.domain.grid.n_stored_cells(), 1);
  bath.domain.grid.for_each_owned_cell(
      [&](int c) { phi[c] = bath.domain.grid.center(c)[dim - 1] - 0.5; });
  bath.domain.halo.fill(phi);
  ParticleTiles<dim> tiles(bath.domain.grid.n_owned_tiles());
  const auto add = [&](const Point<dim>& x, int side) {
    for (int t = 0; t < bath.domain.grid.n_owned_tiles(); ++t) {
      const Index<dim> begin = bath.domain.grid.tile_begin(t);
      Particle<dim> particle;
      bool inside = true;
      for (int a = 0; a < dim; ++a) {
        particle.x[a] = static_cast<float>(x[a] / h - begin[a]);
        inside = inside && particle.x[a] >= 0 && particle.x[a] < tile_width<dim>;
      }
      particle.radius = static_cast<float>(0.2 * side);
      if (inside)
        tiles[t].push_back(particle);
    }
  };
  const auto below = [&](double distance) {
    return Point<dim>(middle - distance * Point<dim>::Unit(dim - 1));
  };
  const auto count = [&] {
    std::size_t result = 0;
    for (const auto& tile : tiles)
      result += tile.size();
    return result;
  };
  add(below(radius + 0.1 * h), 1);
  ASSERT_EQ(count(), 1U);
  add(below(radius + 0.1 * h), -1);
  add(below(radius + 3 * h), 1);
  add(middle + (radius + 0.1 * h) * Point<dim>::Unit(0), 1);
  remove_trapped_air(bath.domain, solids, bath.kept, phi, tiles);
  EXPECT_EQ(count(), 3U);
  // Not the one of the liquid: it would have no company but those of the air.
  int n_of_air = 0;
  for (const auto& tile : tiles)
    for (const Particle<dim>& particle : tile)
      n_of_air += particle.side() > 0;
  EXPECT_EQ(n_of_air, 2);
}

TEST(Particles, AirThatASolidAndLiquidEncloseGoes) {
  expect_trapped_air_goes<2>();
  expect_trapped_air_goes<3>();
}

/// In a last tile that is short, float rounds what comes to the end up to it: on a periodic axis it
/// begins anew there.
template <int dim>
void expect_none_beyond_short_tiles() {
  constexpr int n = 2 * tile_width<dim> + 1;
  const double h = 1.0 / n;
  DomainDescription<dim> description = closed_cube<dim>(n);
  for (auto& side : description.boundary.sides[0])
    side.type = SideType::periodic;
  description.grid.periodic[0] = true;
  Bath<dim> bath(description);
  const TiledGrid<dim>& grid = bath.domain.grid;
  bath.set_velocity(
      [&](const Point<dim>&) { return Point<dim>((0.5 - 1e-8) * h * Point<dim>::Unit(0)); });
  bath.domain.halo.fill(bath.velocity);
  ParticleTiles<dim> tiles(grid.n_owned_tiles());
  for (int t = 0; t < grid.n_owned_tiles(); ++t) {
    Particle<dim> particle;
    particle.x.fill(0.5F);
    particle.radius = 0.2F;
    tiles[t].push_back(particle);
  }
  const SolidCells<dim> solids = find_solid_cells<dim>(bath.domain, nullptr);
  Transport<dim> transport(
      {grid, solids.state, bath.surface, bath.velocity, bath.ray_halo, bath.kept, {}, 1.0});
  move_particles(bath.domain, transport.frame(), bath.ray_halo, tiles);
  GlobalIndex count = 0;
  for (int t = 0; t < grid.n_owned_tiles(); ++t)
    for (const Particle<dim>& particle : tiles[t]) {
      ++count;
      EXPECT_TRUE(grid.in_domain(t * tile_volume<dim> + particle.cell_in_tile()));
    }
  EXPECT_EQ(sum_all(world(), count), std::lround(std::pow(3, dim)));
}

TEST(Particles, DoNotLieBeyondShortTiles) {
  expect_none_beyond_short_tiles<2>();
  expect_none_beyond_short_tiles<3>();
}

template <int dim>
void expect_rest() {
  Bath<dim> bath(open_cube<dim>(20));
  const auto model = bath.make(name);
  Point<dim> normal = Point<dim>::Constant(0.3);
  normal[dim - 1] = 1;
  normal.normalize();
  model->initialise([&](const Point<dim>& x) { return normal.dot(x) - 0.537; }, nullptr);
  const CellField before = model->distance();
  for (int i = 0; i < 50; ++i)
    bath.step(*model, 0.1 * i, 0.1);
  bath.domain.grid.for_each_stored_cell(
      [&](int c) { EXPECT_NEAR(model->distance()[c], before[c], 1e-13); });
  // They were seeded a tenth of a cell away; phi is not known in the last half cell at a side.
  const auto& tiles = level_set(*model).particles();
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (const Particle<dim>& p : tiles[t]) {
      Point<dim> x = p.position();
      for (int a = 0; a < dim; ++a)
        x[a] += bath.domain.grid.tile_begin(static_cast<int>(t))[a];
      if ((x.array() > 0.5).all() && (x.array() < 19.5).all()) {
        EXPECT_GT(p.side() * (normal.dot(x) - 0.537 * 20), 0.09);
      }
    }
}

TEST(Particles, LeaveWhatIsAtRest) {
  expect_rest<2>();
  expect_rest<3>();
}

}  // namespace
}  // namespace lockstep::test
