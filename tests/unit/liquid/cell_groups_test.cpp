#include <gtest/gtest.h>

#include "liquid/common/cell_groups.hpp"

#include "bath.hpp"
#include "geometry/generators.hpp"
#include "liquid/common/cavities.hpp"

namespace lockstep::test {
namespace {

/// Letters that touch by corners only, one of them cut by a plate.
TEST(CellGroups, HangTogetherByOpenFaces) {
  const std::vector<std::string> rows = {"##...#....", "#..##.....", "#..##..###", "####...#.#",
                                         ".......#.#", "..#....###", "..#.......", "..#.####..",
                                         "..#....#..", "..######.."};
  for (const bool has_plate : {false, true}) {
    DomainDescription<2> description = open_cube<2>(10, 10);
    Bath<2> bath(description);
    std::shared_ptr<const SurfaceSnapshot<2>> plate;
    if (has_plate)  // between the rows 6 and 7 from above
      plate = snapshot<2>(plate_surface<2>(Point<2>(3, 3), 1, 0.5), Point<2>(2.5, 3), false);
    const auto solids = find_solid_cells<2>(bath.domain, plate);
    const auto& grid = bath.domain.grid;
    std::vector<char> member(grid.n_stored_cells(), 0);
    grid.for_each_stored_cell([&](int c) {
      const Index<2> at = grid.coordinates(c);
      member[c] = rows[9 - at[1]][at[0]] == '#';
    });
    const CellGroups groups = find_groups(bath.domain, solids, member);
    EXPECT_EQ(groups.n, has_plate ? 5 : 4);
    const auto of = [&](int x, int row) {
      const int c = grid.cell({x, 9 - row});
      return groups.of_cell[c];
    };
    if (bath.domain.grid.comm()->getSize() > 1)
      continue;
    EXPECT_EQ(of(0, 0), of(4, 1));
    EXPECT_NE(of(0, 0), of(5, 0));
    EXPECT_EQ(of(7, 2), of(9, 5));
    EXPECT_EQ(of(2, 5) == of(2, 9), !has_plate);
    EXPECT_EQ(of(4, 7), of(2, 9));
    EXPECT_EQ(of(0, 2), of(0, 0));
  }
}

/// A dry cell between two bodies goes to the nearer one, wherever it lies.
TEST(CellGroups, LabelsSpreadFromTheNearestBody) {
  Bath<2> bath(open_cube<2>(20, 20));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  const Index<2> middle{9, 9};
  for (int nearer = 0; nearer < 4; ++nearer) {
    CellField phi(grid.n_stored_cells(), 0.5);
    std::vector<int> label(grid.n_stored_cells(), -1);
    const auto at = [&](int side) {
      Index<2> place = middle;
      place[side / 2] += side % 2 == 0 ? -1 : 1;
      return place;
    };
    grid.for_each_stored_cell([&](int cell) {
      for (int side = 0; side < 4; ++side)
        if (grid.coordinates(cell) == at(side)) {
          label[cell] = side;
          phi[cell] = side == nearer ? -0.2 : -0.4;
        }
    });
    bath.domain.halo.fill(label);
    bath.domain.halo.fill(phi);
    spread_labels(bath.domain, solids, phi, 1, label);
    const int cell = grid.cell(middle);
    if (cell >= 0 && grid.owned(cell)) {
      EXPECT_EQ(label[cell], nearer);
    }
  }
}

TEST(Voids, SmallOnesUnderWaterAreFilled) {
  Bath<2> bath(open_cube<2>(32, 32));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  CellField phi(grid.n_stored_cells(), -6);
  grid.for_each_stored_cell([&](int c) {
    const Index<2> at = grid.coordinates(c);
    if ((at[0] == 7 && at[1] > 3 && at[1] < 12) || (at[0] == 20 && at[1] > 3 && at[1] < 13) ||
        (at[0] == 0 && at[1] == 5))
      phi[c] = 0.5;
  });
  const auto filled = fill_cavities(bath.domain, solids, 8, phi);
  EXPECT_EQ(sum_all(world(), static_cast<double>(filled.size())), 8);
  const double n_left = [&] {
    double n = 0;
    grid.for_each_owned_cell([&](int c) { n += phi[c] >= 0; });
    return sum_all(world(), n);
  }();
  EXPECT_EQ(n_left, 10);  // the longer one and the one at the open side
}

/// The last air components of a closed tank stay: without them nothing could take back what the
/// correction of the volume adds.
TEST(Voids, TheLastOfAClosedTankStay) {
  Bath<2> bath(closed_cube<2>(32));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  for (const bool has_more : {false, true}) {
    CellField phi(grid.n_stored_cells(), -6 * bath.domain.spacing());
    grid.for_each_stored_cell([&](int c) {
      const Index<2> at = grid.coordinates(c);
      const bool is_small = at[0] == 7 && at[1] > 3 && at[1] < 12;
      if (is_small || (has_more && at[0] == 20 && at[1] > 3 && at[1] < 13))
        phi[c] = 0.5 * bath.domain.spacing();
    });
    const auto filled = fill_cavities(bath.domain, solids, 8, phi);
    EXPECT_EQ(sum_all(world(), static_cast<double>(filled.size())), has_more ? 8 : 0);
  }
}

}  // namespace
}  // namespace lockstep::test
