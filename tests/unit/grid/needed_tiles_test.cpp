#include "grid/needed_tiles.hpp"

#include <gmock/gmock.h>

#include "grid_cases.hpp"

namespace lockstep::test {
namespace {

using testing::ElementsAre;

/// A thing that only the last rank knows of.
template <int dim>
void add_on_last_rank(NeededTiles<dim>& needed, const Index<dim>& begin, const Index<dim>& end) {
  if (world()->getRank() == world()->getSize() - 1)
    needed.add(begin, end);
}

TEST(NeededTiles, AreThoseWithinTheMargin) {
  const TileLattice<2> lattice(square(80, false));  // 5 x 5 tiles of 16 x 16
  const auto tiles_within = [&](int margin) {
    NeededTiles<2> needed(lattice, 1, margin);
    add_on_last_rank<2>(needed, {24, 40}, {25, 41});
    return needed.first(world()).tiles;
  };
  EXPECT_THAT(tiles_within(7), ElementsAre(11));
  EXPECT_THAT(tiles_within(8), ElementsAre(11, 12, 16, 17));
  EXPECT_THAT(tiles_within(9), ElementsAre(5, 6, 7, 10, 11, 12, 15, 16, 17));
}

TEST(NeededTiles, WrapAndStopAtTheSides) {
  GridDescription<2> description = square(64, false);
  description.periodic = {true, false};
  description.store_upper_face = {false, true};  // a layer of tiles above the domain
  const TileLattice<2> lattice(description);
  NeededTiles<2> needed(lattice, 1, 4);
  needed.add(Box<2>(Point<2>(62, 70), Point<2>(63, 75)));
  EXPECT_THAT(needed.first(world()).tiles, ElementsAre(12, 15));
}

TEST(NeededTiles, OfCellsOfATileAreThoseAroundTheBoxThatHoldsThem) {
  const TiledGrid<2> grid(square(64, false), world());
  NeededTiles<2> needed(grid.tile_lattice(), 1, 3);
  needed.add_cells(grid, [&](int cell) {
    const Index<2> c = grid.coordinates(cell);
    return (c[0] == 20 && c[1] == 24) || (c[0] == 24 && c[1] == 20) || c == Index<2>{63, 63};
  });
  EXPECT_THAT(needed.first(world()).tiles, ElementsAre(5, 15));
}

TEST(NeededTiles, ThereIsAlwaysOne) {
  const TileLattice<2> lattice(square(64, false));
  EXPECT_EQ(NeededTiles<2>(lattice, 1, 3).first(world()).tiles.size(), 1U);
}

/// Nothing changes between the reach and the margin, and while at most a quarter is idle.
TEST(NeededTiles, ChangeOnlyWhenTheyMust) {
  const TileLattice<2> lattice(square(160, false));  // 10 x 10 tiles
  const auto with_cells = [&](int begin, int end) {
    NeededTiles<2> needed(lattice, 4, 8);
    add_on_last_rank<2>(needed, {begin, 0}, {end, 1});
    return needed;
  };
  const TileOwners present = with_cells(24, 72).first(world());
  ASSERT_THAT(present.tiles, ElementsAre(1, 2, 3, 4));
  EXPECT_FALSE(with_cells(20, 76).change(world(), present));
  EXPECT_TRUE(with_cells(20, 76).are_there(world(), present));
  EXPECT_FALSE(with_cells(20, 77).are_there(world(), present));
  EXPECT_THAT(with_cells(20, 77).change(world(), present)->tiles, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_FALSE(with_cells(40, 60).change(world(), present));
  EXPECT_THAT(with_cells(40, 56).change(world(), present)->tiles, ElementsAre(2, 3));
}

}  // namespace
}  // namespace lockstep::test
