#include <gtest/gtest.h>

#include <numeric>

#include "grid/tile_owners.hpp"
#include "grid/tile_partition.hpp"
#include "grid_cases.hpp"

namespace lockstep::test {
namespace {

TileLattice<3> cube_of_tiles(int n_tiles) {
  GridDescription<3> description;
  description.n_cells.fill(8 * n_tiles);
  return TileLattice<3>(description);
}

std::vector<GlobalIndex> all_tiles(int n_tiles) {
  std::vector<GlobalIndex> tiles(n_tiles * n_tiles * n_tiles);
  std::iota(tiles.begin(), tiles.end(), 0);
  return tiles;
}

/// Tiles of a corner, three along every axis.
std::vector<GlobalIndex> work_in_a_corner(const TileLattice<3>& lattice,
                                          const std::vector<GlobalIndex>& tiles) {
  std::vector<GlobalIndex> work;
  for (const GlobalIndex number : tiles) {
    const Index<3> tile = lattice.tile_coordinates(number);
    work.push_back(tile[0] < 3 && tile[1] < 3 && tile[2] < 3 ? 4 * 512 : 0);
  }
  return work;
}

GlobalIndex largest_share(const std::vector<GlobalIndex>& work, const std::vector<int>& parts,
                          int n_parts) {
  std::vector<GlobalIndex> shares(n_parts, 0);
  for (std::size_t i = 0; i < work.size(); ++i)
    shares[parts[i]] += work[i];
  return *std::max_element(shares.begin(), shares.end());
}

TEST(TilePartition, ABoxIsCutIntoBoxes) {
  const TileLattice<3> lattice = cube_of_tiles(12);
  const auto tiles = all_tiles(12);
  const TileWork work{std::vector<GlobalIndex>(tiles.size(), 512), {}};
  const GlobalIndex cells = 96 * 96 * 96, area = 96 * 96;
  // Half the box and one face; an eighth and three quarter faces.
  for (const auto& [n_parts, faces] : {std::pair<int, double>{2, 1}, {8, 0.75}}) {
    const auto parts = partition_tiles(lattice, tiles, work, n_parts);
    EXPECT_DOUBLE_EQ(partition_cost(lattice, tiles, work, parts, n_parts),
                     cells / n_parts + faces * area);
  }
  // Rows along x stay whole.
  const auto halves = partition_tiles(lattice, tiles, work, 2);
  for (std::size_t i = 0; i < tiles.size(); ++i)
    EXPECT_EQ(halves[i], halves[i / 144 * 144]);
}

TEST(TilePartition, WorkAtSurfacesIsSharedToo) {
  const TileLattice<3> lattice = cube_of_tiles(12);
  const auto tiles = all_tiles(12);
  const TileWork work{std::vector<GlobalIndex>(tiles.size(), 512),
                      work_in_a_corner(lattice, tiles)};
  const auto parts = partition_tiles(lattice, tiles, work, 2);
  EXPECT_LT(largest_share(work.at_surfaces, parts, 2), 0.6 * 27 * 4 * 512);
  EXPECT_LT(largest_share(work.everywhere, parts, 2), 0.52 * 96 * 96 * 96);
}

TEST(TileOwners, AreSharedBetterOnlyWhereItIsWorthIt) {
  const TileLattice<3> lattice = cube_of_tiles(12);
  const auto tiles = all_tiles(12);
  const int n_ranks = world()->getSize();
  TileWork work{std::vector<GlobalIndex>(tiles.size(), 512), {}};
  const TileOwners even{tiles, partition_tiles(lattice, tiles, work, n_ranks)};
  EXPECT_FALSE(share_better(lattice, world(), even, work));
  const TileOwners uneven{tiles, std::vector<int>(tiles.size(), 0)};
  const auto better = share_better(lattice, world(), uneven, work);
  EXPECT_EQ(better.has_value(), n_ranks > 1);
  if (better) {
    EXPECT_EQ(better->ranks, even.ranks);
  }
}

}  // namespace
}  // namespace lockstep::test
