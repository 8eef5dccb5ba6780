#include "grid/tile_migration.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "grid_cases.hpp"

namespace lockstep::test {
namespace {

/// Tiles whose first cell lies in [begin, end) along an axis.
template <int dim>
typename TiledGrid<dim>::TileChoice slab(int axis, int begin, int end) {
  return [=](const Index<dim>& first, const Index<dim>&) {
    return first[axis] >= begin && first[axis] < end;
  };
}

template <int dim>
CellField labels_of_owned(const TiledGrid<dim>& grid, double otherwise) {
  CellField field(grid.n_stored_cells(), otherwise);
  for (int c = 0; c < grid.n_owned_cells(); ++c)
    if (grid.in_lattice(c))
      field[c] = label(grid, c);
  return field;
}

/// All stored cells have their label if `was_there(coordinates)`, else `fill`.
template <int dim, typename WasThere>
void expect_labels(const TiledGrid<dim>& grid, const CellField& field, double fill,
                   const WasThere& was_there) {
  ASSERT_EQ(static_cast<int>(field.size()), grid.n_stored_cells());
  for_each_stored_lattice_cell(grid, [&](int c) {
    ASSERT_EQ(field[c], was_there(grid.coordinates(c)) ? label(grid, c) : fill) << "cell " << c;
  });
}

/// There and back between two slabs of tiles that overlap: what both have stays, the rest is lost.
template <int dim>
void expect_there_and_back(const GridDescription<dim>& description, int axis, int middle) {
  const int n = description.n_cells[axis] + 1;
  const TiledGrid<dim> first(description, world(), slab<dim>(axis, 0, n - tile_width<dim>));
  const TiledGrid<dim> second(description, world(), slab<dim>(axis, middle, n));
  CellField field = labels_of_owned(first, -1);
  TileMigration<dim>(first, second).move(field, -2.0);
  expect_labels(second, field, -2, [&](const Index<dim>& c) {
    return first.tile_lattice().n_tiles()[axis] > 1 &&
           c[axis] / tile_width<dim> * tile_width<dim> < n - tile_width<dim>;
  });
  TileMigration<dim>(second, first).move(field, -2.0);
  expect_labels(first, field, -2, [&](const Index<dim>& c) {
    return c[axis] / tile_width<dim> * tile_width<dim> >= middle;
  });
}

TEST(TileMigration, KeepsWhatBothGridsHave) {
  GridDescription<2> plane = square(80, false);
  expect_there_and_back(plane, 1, 32);
  plane.periodic = {true, true};
  expect_there_and_back(plane, 0, 48);
  expect_there_and_back(channel_40x32x10(), 0, 16);
}

TEST(TileMigration, ToTheSameGridChangesNothing) {
  const TiledGrid<3> grid(channel_40x32x10(), world());
  const TileMigration<3> migration(grid, grid);
  EXPECT_EQ(migration.n_gone() + migration.n_new(), 0);
  CellField field = labels_of_owned(grid, -1);
  migration.move(field);
  expect_labels(grid, field, 0, [](const Index<3>&) { return true; });
}

TEST(TileMigration, TilesGoToOtherRanks) {
  const TiledGrid<2> first(square(64, true), world());
  TileOwners turned = first.tile_owners();
  for (int& rank : turned.ranks)
    rank = world()->getSize() - 1 - rank;
  const TiledGrid<2> second(first.description(), world(), turned);
  FaceField<2> field{labels_of_owned(first, -1), labels_of_owned(first, -1)};
  for (double& value : field[1])
    value *= -1;
  TileMigration<2>(first, second).move(field);
  expect_labels(second, field[0], 0, [](const Index<2>&) { return true; });
  for (double& value : field[1])
    value *= -1;
  expect_labels(second, field[1], 0, [](const Index<2>&) { return true; });
}

TEST(TileMigration, MovesSeveralFieldsOfFlags) {
  const TiledGrid<2> first(square(64, false), world(), slab<2>(0, 0, 32));
  const TiledGrid<2> second(square(64, false), world(), slab<2>(0, 16, 64));
  std::vector<char> near(first.n_stored_cells(), 3), far(first.n_stored_cells(), 5);
  TileMigration<2>(first, second).move<char>({&near, &far}, {7, 9});
  for_each_stored_lattice_cell(second, [&](int c) {
    const bool was_there = second.coordinates(c)[0] < 32;
    ASSERT_EQ(near[c], was_there ? 3 : 7);
    ASSERT_EQ(far[c], was_there ? 5 : 9);
  });
}

struct Particle {
  double x;
  int age;
};

/// As many particles in each tile as its number tells, and none in tiles that are new.
TEST(TileMigration, MovesListsOfParticles) {
  const TiledGrid<2> first(square(80, true), world(), slab<2>(1, 0, 48));
  const TiledGrid<2> second(square(80, true), world(), slab<2>(1, 16, 80));
  const auto number = [](const TiledGrid<2>& grid, int tile) {
    return grid.tile_begin(tile)[0] / 16 + 5 * (grid.tile_begin(tile)[1] / 16);
  };
  std::vector<std::vector<Particle>> particles(first.n_owned_tiles());
  for (int t = 0; t < first.n_owned_tiles(); ++t)
    for (int i = 0; i < number(first, t); ++i)
      particles[t].push_back({0.5 * number(first, t), i});
  TileMigration<2>(first, second).move_lists(particles);
  ASSERT_EQ(static_cast<int>(particles.size()), second.n_owned_tiles());
  for (int t = 0; t < second.n_owned_tiles(); ++t) {
    const int n = second.tile_begin(t)[1] < 48 ? number(second, t) : 0;
    ASSERT_EQ(static_cast<int>(particles[t].size()), n);
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(particles[t][i].x, 0.5 * number(second, t));
      EXPECT_EQ(particles[t][i].age, i);
    }
  }
}

TEST(TileOwners, TilesThatStayKeepTheirRank) {
  const TiledGrid<2> grid(square(160, false), world(), slab<2>(0, 0, 80));
  const TileOwners before = grid.tile_owners();
  std::vector<GlobalIndex> tiles(before.tiles.begin() + 1, before.tiles.end());
  tiles.push_back(before.tiles.back() + 1);  // beside the last one
  const TileOwners after = share_tiles_again<2>(grid.tile_lattice(), world(), before, tiles,
                                                std::vector<GlobalIndex>(tiles.size(), 256));
  int n_same = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    for (std::size_t j = 0; j < before.tiles.size(); ++j)
      n_same += before.tiles[j] == tiles[i] && before.ranks[j] == after.ranks[i];
  EXPECT_EQ(n_same, 49);
  EXPECT_EQ(after.ranks.back(), before.ranks.back());
  EXPECT_EQ(TiledGrid<2>(grid.description(), world(), after).tile_owners().ranks, after.ranks);
}

TEST(TileOwners, AreSharedAnewWhenTheWorkIsUneven) {
  const TiledGrid<2> grid(square(160, false), world(), slab<2>(0, 0, 16));
  TileOwners before = grid.tile_owners();
  std::fill(before.ranks.begin(), before.ranks.end(), 0);
  const std::vector<GlobalIndex> weights(before.tiles.size(), 256);
  const TileOwners after =
      share_tiles_again<2>(grid.tile_lattice(), world(), before, before.tiles, weights);
  const auto at_most = (10 + world()->getSize() - 1) / world()->getSize();
  for (int rank = 0; rank < world()->getSize(); ++rank)
    EXPECT_LE(std::count(after.ranks.begin(), after.ranks.end(), rank), at_most);
}

TEST(TiledGrid, KnowsWhereItsTilesEnd) {
  GridDescription<2> description = square(64, false);
  description.periodic = {true, false};
  const TiledGrid<2> grid(description, world(), slab<2>(1, 16, 48));
  EXPECT_FALSE(grid.is_complete());
  EXPECT_EQ(grid.extent()[0], (Index<2>{0, 16}));
  EXPECT_EQ(grid.extent()[1], (Index<2>{64, 48}));
  for (int t = 0; t < grid.n_owned_tiles(); ++t)
    for (int axis = 0; axis < 2; ++axis)
      for (int side = 0; side < 2; ++side)
        EXPECT_EQ(grid.ends_at(t, axis, side),
                  axis == 1 && grid.tile_begin(t)[1] == (side == 0 ? 16 : 32));
  const TiledGrid<2> whole(description, world());
  EXPECT_TRUE(whole.is_complete());
  for (int t = 0; t < whole.n_owned_tiles(); ++t)
    EXPECT_FALSE(whole.ends_at(t, 1, 0) || whole.ends_at(t, 1, 1));
}

}  // namespace
}  // namespace lockstep::test
