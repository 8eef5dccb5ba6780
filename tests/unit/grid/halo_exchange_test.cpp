#include "grid/halo_exchange.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grid/wide_halo.hpp"
#include "grid_cases.hpp"

namespace lockstep::test {
namespace {

constexpr double unset = -7;

/// True if an owned lattice cell lies within `width` of the cell, by looking at every cell of the
/// box.
template <int dim>
bool near_owned(const TiledGrid<dim>& grid, int cell, int width) {
  const Index<dim> x = grid.coordinates(cell);
  int n = 1;
  for (int a = 0; a < dim; ++a)
    n *= 2 * width + 1;
  for (int i = 0; i < n; ++i) {
    Index<dim> y = x;
    for (int a = 0, rest = i; a < dim; ++a, rest /= 2 * width + 1)
      y[a] += rest % (2 * width + 1) - width;
    const int other = grid.cell(y);
    if (other >= 0 && grid.owned(other))
      return true;
  }
  return false;
}

template <int dim>
CellField owned_labels(const TiledGrid<dim>& grid) {
  CellField field(grid.n_stored_cells(), unset);
  for (int c = 0; c < grid.n_owned_cells(); ++c)
    if (grid.in_lattice(c))
      field[c] = label(grid, c);
  return field;
}

template <int dim>
void expect_fill(const TiledGrid<dim>& grid, int width) {
  const HaloExchange<dim> halo(grid, width);
  CellField field = owned_labels(grid);
  halo.fill(field);
  int n_halo = 0;
  for (int c = 0; c < grid.n_stored_cells(); ++c) {
    const bool ghost = !grid.owned(c) && grid.in_lattice(c) && near_owned(grid, c, width);
    n_halo += ghost;
    const bool has_value = ghost || (grid.owned(c) && grid.in_lattice(c));
    ASSERT_EQ(field[c], has_value ? label(grid, c) : unset) << "cell " << c << " width " << width;
  }
  EXPECT_EQ(halo.n_halo_cells(), n_halo);
}

TEST(HaloExchange, FillsTheHaloAndNothingElse) {
  for (const int width : {1, 2, 7, 15, 16}) {
    expect_fill(TiledGrid<2>(channel_20x13(), world()), width);
    expect_fill(TiledGrid<2>(square(64, true), world()), width);
  }
  for (const int width : {1, 3})
    expect_fill(TiledGrid<3>(channel_40x32x10(), world()), width);
}

TEST(HaloExchange, FullWidthFillsEveryGhostCell) {
  const TiledGrid<3> grid(channel_40x32x10(), world());
  CellField field = owned_labels(grid);
  HaloExchange<3>(grid, grid.ghost_width()).fill(field);
  for_each_stored_lattice_cell(grid, [&](int c) { ASSERT_EQ(field[c], label(grid, c)); });
}

TEST(HaloExchange, WorksWithSparseTilesAndEmptyRanks) {
  const auto diagonal = [](const Index<2>& begin, const Index<2>&) { return begin[0] == begin[1]; };
  expect_fill(TiledGrid<2>(square(64, true), world(), diagonal), 5);
  expect_fill(TiledGrid<2>(square(16, true), world()), 16);
}

TEST(HaloExchange, FillsAFieldOfSomeTilesWhereItHasValues) {
  const TiledGrid<3> grid(channel_40x32x10(), world());
  const HaloExchange<3> halo(grid, 2);
  std::vector<char> tiles(grid.n_tiles());  // same tiles on all ranks
  for (int t = 0; t < grid.n_tiles(); ++t)
    tiles[t] = (grid.tile_begin(t)[0] / tile_width<3>) % 2 == 0;
  TileField<3> field(tiles, unset);
  CellField whole = owned_labels(grid);
  for (int c = 0; c < grid.n_owned_cells(); ++c)
    if (field.has(c))
      field.set(c, whole[c]);
  halo.fill(field);
  halo.fill(whole);
  for (int c = 0; c < grid.n_stored_cells(); ++c)
    EXPECT_EQ(field[c], tiles[TiledGrid<3>::tile_of(c)] ? whole[c] : unset) << "cell " << c;
}

TEST(HaloExchange, SumToOwnerIsTheAdjointOfFill) {
  const TiledGrid<2> grid(square(64, true), world());
  const HaloExchange<2> halo(grid, 3);
  const auto dot = [&](const CellField& x, const CellField& y) {
    double sum = 0;
    for (int c = 0; c < grid.n_stored_cells(); ++c)
      sum += x[c] * y[c];
    return sum_all(world(), sum);
  };
  CellField x(grid.n_stored_cells(), 0.0), y(grid.n_stored_cells(), 0.0);
  for (int c = 0; c < grid.n_owned_cells(); ++c)
    x[c] = std::sin(label(grid, c));
  for (int c = 0; c < grid.n_stored_cells(); ++c)
    y[c] = std::cos(label(grid, c) + 10.0 * world()->getRank());
  // Ghosts beyond the halo are no part of the operator.
  CellField in_halo(grid.n_stored_cells(), 0.0);
  std::fill_n(in_halo.begin(), grid.n_owned_cells(), 1.0);
  halo.fill(in_halo);
  for (int c = 0; c < grid.n_stored_cells(); ++c)
    y[c] *= in_halo[c];

  CellField filled = x, summed = y;
  halo.fill(filled);
  halo.sum_to_owner(summed);
  EXPECT_NEAR(dot(filled, y), dot(x, summed), 1e-10);
  for (int c = grid.n_owned_cells(); c < grid.n_stored_cells(); ++c)
    EXPECT_EQ(summed[c], 0.0);
  // Counts the ranks that hold a cell: the corners of a rank's region are held more often than its
  // middle.
  CellField ones(in_halo);
  halo.sum_to_owner(ones);
  const double copies = dot(ones, CellField(ones.size(), 1.0)) - 64.0 * 64.0;
  EXPECT_EQ(copies,
            static_cast<double>(sum_all(world(), static_cast<GlobalIndex>(halo.n_halo_cells()))));
}

TEST(HaloExchange, SendsSeveralFieldsOfAnyTypeInOneMessage) {
  const TiledGrid<2> grid(square(64, true), world());
  const HaloExchange<2> halo(grid, 2);
  CellField a = owned_labels(grid), b = a;
  for (double& value : b)
    value *= 2;
  halo.fill({&a, &b});
  const long long messages = halo.statistics().messages, bytes = halo.statistics().bytes;
  CellField single = owned_labels(grid);
  halo.fill(single);
  EXPECT_EQ(halo.statistics().messages, 2 * messages);
  EXPECT_EQ(2 * halo.statistics().bytes, 3 * bytes);
  EXPECT_EQ(messages > 0, world()->getSize() > 1);

  std::vector<char> flags(grid.n_stored_cells(), 0);
  std::vector<GlobalIndex> numbers(grid.n_stored_cells(), no_index);
  for (int c = 0; c < grid.n_owned_cells(); ++c) {
    flags[c] = static_cast<char>(grid.global_id(c) % 100);
    numbers[c] = grid.global_id(c);
  }
  halo.fill(flags);
  halo.fill(numbers);
  FaceField<2> faces{a, b};
  halo.fill(faces);
  for (int c = 0; c < grid.n_stored_cells(); ++c) {
    if (single[c] == unset)
      continue;
    ASSERT_EQ(a[c], label(grid, c));
    ASSERT_EQ(b[c], 2 * label(grid, c));
    ASSERT_EQ(faces[1][c], b[c]);
    ASSERT_EQ(flags[c], grid.global_id(c) % 100);
    ASSERT_EQ(numbers[c], grid.global_id(c));
  }
}

TEST(HaloExchange, RefusesAWidthBeyondTheGhostTiles) {
  const TiledGrid<2> grid(square(64, true), world());
  EXPECT_THROW(HaloExchange<2>(grid, 17), InputError);
  EXPECT_THROW(HaloExchange<2>(grid, 0), InputError);
}

TEST(WideHalo, FillsAWiderGridFromTheBaseGrid) {
  const TiledGrid<3> grid(channel_40x32x10(), world());
  const TiledGrid<3> wide = grid.with_reach(3);
  const WideHalo<3> halo(grid, wide);
  CellField field;
  halo.fill(owned_labels(grid), field);
  ASSERT_EQ(static_cast<int>(field.size()), wide.n_stored_cells());
  for_each_stored_lattice_cell(wide, [&](int c) { ASSERT_EQ(field[c], label(wide, c)); });
}

}  // namespace
}  // namespace lockstep::test
