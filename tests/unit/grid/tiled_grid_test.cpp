#include "grid/tiled_grid.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grid_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
void expect_consistent_ids(const TiledGrid<dim>& grid) {
  for_each_stored_lattice_cell(grid, [&](int c) {
    const Index<dim> x = grid.coordinates(c);
    ASSERT_EQ(grid.cell(x), c);
    ASSERT_EQ(grid.cell_of_global_id(grid.global_id(c)), c);
    ASSERT_EQ(grid.cell_containing(grid.center(c)), c);
    ASSERT_EQ(grid.in_domain(c), grid.in_domain(x));
    for (int a = 0; a < dim; ++a)
      for (int side = 0; side < 2; ++side)
        ASSERT_EQ(grid.neighbor(c, a, side), grid.cell(shifted<dim>(x, a, side)))
            << "cell " << c << " axis " << a << " side " << side;
  });
}

/// Every owned cell has, within the ghost width, all lattice cells that exist.
template <int dim>
void expect_reach(const TiledGrid<dim>& grid) {
  grid.for_each_owned_cell([&](int c) {
    for (int a = 0; a < dim; ++a) {
      for (const int distance : {-grid.ghost_width(), grid.ghost_width()}) {
        Index<dim> x = grid.coordinates(c);
        x[a] += distance;
        if (grid.description().periodic[a] || grid.in_domain(x)) {
          ASSERT_GE(grid.cell(x), 0);
        }
      }
    }
  });
}

template <int dim>
void expect_bijective_numbers(const TiledGrid<dim>& grid) {
  std::vector<GlobalIndex> mine;
  grid.for_each_owned_cell([&](int c) { mine.push_back(grid.global_id(c)); });
  std::vector<GlobalIndex> all = gather_all(grid.comm(), mine);
  std::sort(all.begin(), all.end());
  GlobalIndex n = 1;
  for (int a = 0; a < dim; ++a)
    n *= grid.n_cells()[a];
  ASSERT_EQ(static_cast<GlobalIndex>(all.size()), n);
  EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());
}

template <int dim>
void expect_neighbor_loop_agrees(const TiledGrid<dim>& grid) {
  std::vector<int> expected, visited;
  grid.for_each_owned_cell([&](int c) { expected.push_back(c); });
  grid.for_each_owned_cell_with_neighbors([&](int c, const std::array<int, 2 * dim>& neighbors) {
    visited.push_back(c);
    for (int i = 0; i < 2 * dim; ++i)
      ASSERT_EQ(neighbors[i], grid.neighbor(c, i / 2, i % 2));
  });
  EXPECT_EQ(visited, expected);
}

template <int dim>
void expect_sound(const TiledGrid<dim>& grid) {
  expect_consistent_ids(grid);
  expect_reach(grid);
  expect_bijective_numbers(grid);
  expect_neighbor_loop_agrees(grid);
}

TEST(TiledGrid, IsConsistentWithPartialTilesPeriodicAxesAndLayers) {
  expect_sound(TiledGrid<2>(channel_20x13(), world()));
  expect_sound(TiledGrid<3>(channel_40x32x10(), world()));
}

TEST(TiledGrid, IsConsistentOnAPeriodicSquare) {
  expect_sound(TiledGrid<2>(square(64, true), world()));
  expect_sound(TiledGrid<2>(square(5, true), world()));
}

TEST(TiledGrid, ReachCrossesAPartialTileOfAPeriodicAxis) {
  // Below cell 0 lie the 15 cells of the last tile and then one cell, 63, of the tile before it.
  GridDescription<2> description;
  description.n_cells = {79, 1};
  description.periodic = {true, false};
  EXPECT_THAT(TileLattice<2>(description).tiles_within({0}, 16),
              ::testing::ElementsAre(0, 1, 3, 4));
  expect_sound(TiledGrid<2>(description, world()));
}

TEST(TiledGrid, NumbersAreLexicographicInTheLatticeWhateverTheRanks) {
  const TiledGrid<2> grid(channel_20x13(), world());
  for_each_stored_lattice_cell(grid, [&](int c) {
    const Index<2> x = grid.coordinates(c);
    EXPECT_EQ(grid.global_id(c), x[0] + 20 * x[1]);
  });
}

TEST(TiledGrid, RanksWithoutTilesWork) {
  const TiledGrid<2> grid(square(16, false), world());
  EXPECT_EQ(grid.n_owned_tiles(), is_root(world()) ? 1 : 0);
  EXPECT_EQ(grid.cell({0, 0}), is_root(world()) ? 0 : -1);
  expect_sound(grid);
}

TEST(TiledGrid, PlacesCellsFacesAndPoints) {
  const TiledGrid<2> grid(channel_20x13(), world());
  const int c = grid.cell({17, 3});
  if (grid.n_owned_tiles() == 0)
    return;         // more ranks than tiles
  ASSERT_GE(c, 0);  // the two tiles reach each other
  EXPECT_TRUE(grid.center(c).isApprox(Point<2>(7.75, 3.75)));
  EXPECT_TRUE(grid.face_center(0, c).isApprox(Point<2>(7.5, 3.75)));
  EXPECT_TRUE(grid.face_center(1, c).isApprox(Point<2>(7.75, 3.5)));
  // The period along x is 10 m.
  EXPECT_EQ(grid.cell_containing(Point<2>(7.75 - 30, 3.75)), c);
  EXPECT_TRUE(grid.wrap(Point<2>(9.25, 1)).isApprox(Point<2>(-0.75, 1)));
  EXPECT_EQ(grid.cell_containing(Point<2>(0, 1.99)), -1);
  EXPECT_EQ(grid.cell_containing(Point<2>(0, std::nan(""))), -1);
  EXPECT_EQ(grid.cell_containing(Point<2>(0, 1e300)), -1);
}

TEST(TiledGrid, StoresTheUpperFacesOfOpenSidesOnly) {
  // 32 x 32: the upper faces along y lie in tiles of their own, two of them.
  GridDescription<2> description = square(32, false);
  description.store_upper_face = {false, true};
  const TiledGrid<2> grid(description, world());
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(grid.n_owned_tiles())), 6);
  GlobalIndex n_faces[2] = {0, 0}, n_upper = 0;
  for (int a = 0; a < 2; ++a)
    grid.for_each_owned_face(a, [&](int c) {
      ++n_faces[a];
      if (grid.in_domain(c))
        return;
      ++n_upper;
      EXPECT_EQ(a, 1);
      EXPECT_DOUBLE_EQ(grid.face_center(a, c)[1], 32.0);
      // The cell below it is here, and so are both cells of every owned face.
      EXPECT_TRUE(grid.in_domain(grid.neighbor(c, 1, 0)));
    });
  EXPECT_EQ(sum_all(world(), n_faces[0]), 32 * 32);
  EXPECT_EQ(sum_all(world(), n_faces[1]), 32 * 33);
  EXPECT_EQ(sum_all(world(), n_upper), 32);
  expect_sound(grid);
}

TEST(TiledGrid, CreatesOnlyTheTilesChosen) {
  // The tiles on the diagonal of 4 x 4, and the layer above the last of them.
  GridDescription<2> description = square(64, false);
  description.store_upper_face = {false, true};
  const TiledGrid<2> grid(description, world(), [](const Index<2>& begin, const Index<2>&) {
    return begin[0] == begin[1];
  });
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(grid.n_owned_tiles())), 5);
  for_each_stored_lattice_cell(grid, [&](int c) {
    const Index<2> x = grid.coordinates(c);
    EXPECT_EQ(x[0] / 16, std::min(x[1], 63) / 16);
  });
  EXPECT_EQ(grid.cell({40, 8}), -1);
  expect_consistent_ids(grid);
  expect_neighbor_loop_agrees(grid);
}

TEST(TiledGrid, DividesTheCellsEvenly) {
  const TiledGrid<2> grid(square(64, false), world());
  const double mean = 64.0 * 64.0 / world()->getSize();
  EXPECT_LE(max_all(world(), static_cast<double>(grid.n_owned_cells())), 1.25 * mean);
}

TEST(TiledGrid, DividesByTheWeightsGiven) {
  // The left half costs three times as much: its share of the cells must be the smaller one.
  const auto weight = [](const Index<2>& begin, const Index<2>&) { return begin[0] < 64 ? 3 : 1; };
  const TiledGrid<2> grid(square(128, false), world(), {}, weight);
  double work = 0;
  for (int t = 0; t < grid.n_owned_tiles(); ++t)
    work += weight(grid.tile_begin(t), grid.tile_begin(t));
  EXPECT_LE(max_all(world(), work), 1.15 * 128 / world()->getSize());
}

TEST(TiledGrid, WiderReachKeepsOwnedIds) {
  const TiledGrid<3> grid(channel_40x32x10(), world());
  const TiledGrid<3> wide = grid.with_reach(3);
  EXPECT_EQ(wide.ghost_width(), 24);
  ASSERT_EQ(wide.n_owned_tiles(), grid.n_owned_tiles());
  for (int t = 0; t < grid.n_owned_tiles(); ++t)
    EXPECT_EQ(wide.tile_begin(t), grid.tile_begin(t));
  expect_sound(wide);
}

TEST(TiledGrid, RefusesBadDescriptionsOnAllRanks) {
  GridDescription<2> description = square(16, true);
  description.store_upper_face = {true, false};
  EXPECT_THROW(TiledGrid<2>(description, world()), InputError);
  description = square(16, false);
  description.spacing = 0;
  EXPECT_THROW(TiledGrid<2>(description, world()), InputError);
  description = square(0, false);
  EXPECT_THROW(TiledGrid<2>(description, world()), InputError);
  // A choice that fails on one rank fails on all.
  const auto fails_at_origin = [](const Index<2>& begin, const Index<2>&) {
    check_input(begin != Index<2>{0, 0}, "no tile at the origin");
    return true;
  };
  EXPECT_THROW(TiledGrid<2>(square(64, false), world(), fails_at_origin), Failure);
}

}  // namespace
}  // namespace lockstep::test
