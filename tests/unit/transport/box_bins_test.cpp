#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "transport/box_bins.hpp"
#include "transport/cell_distance.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Point<dim> random_point(std::mt19937& engine, double lower, double upper) {
  std::uniform_real_distribution<double> place(lower, upper);
  Point<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = place(engine);
  return x;
}

template <int dim>
std::vector<Box<dim>> random_boxes(std::mt19937& engine, int n, double lower, double upper,
                                   double size) {
  std::vector<Box<dim>> boxes;
  for (int i = 0; i < n; ++i) {
    const Point<dim> corner = random_point<dim>(engine, lower, upper);
    boxes.emplace_back(corner, corner + random_point<dim>(engine, 0, size));
  }
  return boxes;
}

/// 150 bins along each axis, so that rows take several words.
template <int dim>
struct Binned {
  Binned(int n_boxes, double size) : boxes(random_boxes<dim>(engine, n_boxes, -0.2, 1.2, size)) {
    bins.build(boxes, Box<dim>(Point<dim>::Zero(), Point<dim>::Constant(0.999)), Point<dim>::Zero(),
               1. / n_bins, [](int i, const Point<dim>&) { return i != 3; });
  }
  /// The bin that holds a place.
  Box<dim> bin(const Point<dim>& x) const {
    const Point<dim> first = (x.array() * n_bins).floor() / n_bins;
    return {first, first + Point<dim>::Constant(1. / n_bins)};
  }
  std::set<int> touching(const Box<dim>& place) const {
    std::set<int> found;
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
      if (i != 3 && boxes[i].intersects(place))
        found.insert(i);
    return found;
  }
  static constexpr int n_bins = dim == 2 ? 150 : 70;
  std::mt19937 engine;
  std::vector<Box<dim>> boxes;
  BoxBins<dim> bins;
};

template <int dim>
void expect_bins_list_what_touches_them() {
  Binned<dim> binned(300, dim == 2 ? 0.1 : 0.3);
  int n_found = 0, n_clear = 0;
  for (int question = 0; question < 1000; ++question) {
    const Point<dim> x = random_point<dim>(binned.engine, 0, 0.999);
    const auto list = binned.bins.at(x);
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    EXPECT_EQ(std::set<int>(list.begin(), list.end()), binned.touching(binned.bin(x)));
    n_found += static_cast<int>(list.end() - list.begin());
    const Box<dim> place(x, x + random_point<dim>(binned.engine, 0, 0.9));
    Box<dim> asked = binned.bin(place.min()).merged(binned.bin(place.max()));
    asked = asked.intersection(Box<dim>(Point<dim>::Zero(), Point<dim>::Ones()));
    EXPECT_EQ(binned.bins.clear(place), binned.touching(asked).empty());
    n_clear += binned.bins.clear(place);
  }
  EXPECT_GT(n_found, 100);
  EXPECT_GT(n_clear, 0);
}

TEST(BoxBins, ListWhatTouchesThem) {
  expect_bins_list_what_touches_them<2>();
  expect_bins_list_what_touches_them<3>();
}

/// A walk along a segment comes by every box that it meets, in bins that it enters ever later.
template <int dim>
void expect_walks_miss_nothing() {
  Binned<dim> binned(200, 0.05);
  int n_met = 0;
  for (int question = 0; question < 500; ++question) {
    const Point<dim> a = random_point<dim>(binned.engine, -0.5, 1.5);
    Point<dim> b = random_point<dim>(binned.engine, -0.5, 1.5);
    if (question % 3 == 0)
      b[question % dim] = a[question % dim];
    std::set<int> seen;
    double last = 0;
    binned.bins.walk(a, b, [&](const auto& list, double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      seen.insert(list.begin(), list.end());
      return false;
    });
    const int n = 2000;
    for (int k = 0; k <= n; ++k) {
      const Point<dim> x = a + static_cast<double>(k) / n * (b - a);
      if (x.minCoeff() <= 0 || x.maxCoeff() >= 0.999)
        continue;
      for (const int i : binned.bins.at(x)) {
        EXPECT_TRUE(seen.count(i)) << i << " at " << x.transpose();
        ++n_met;
      }
    }
  }
  EXPECT_GT(n_met, 100);
}

TEST(BoxBins, WalksMissNothing) {
  expect_walks_miss_nothing<2>();
  expect_walks_miss_nothing<3>();
}

TEST(BoxBins, AWalkStopsWhenItIsTold) {
  const std::vector<Box<2>> boxes(1, Box<2>(Point<2>(0, 0), Point<2>(9.5, 0.5)));
  BoxBins<2> bins;
  bins.build(boxes, boxes[0], Point<2>::Zero(), 1, [](int, const auto&) { return true; });
  int n = 0;
  bins.walk(Point<2>(0.5, 0.2), Point<2>(8.5, 0.3), [&](const auto&, double fraction) {
    EXPECT_NEAR(fraction, n == 0 ? 0 : (n - 0.5) / 8, 1e-12);
    return ++n == 4;
  });
  EXPECT_EQ(n, 4);
}

TEST(BoxBins, WithoutBoxesNothingIsFound) {
  BoxBins<2> bins;
  bins.build({}, {}, Point<2>::Zero(), 1, [](int, const auto&) { return true; });
  EXPECT_TRUE(bins.clear(Box<2>(Point<2>::Zero(), Point<2>::Ones())));
  EXPECT_EQ(bins.at(Point<2>::Zero()).begin(), bins.at(Point<2>::Zero()).end());
  bins.walk(Point<2>::Zero(), Point<2>::Ones(), [](const auto&, double) {
    ADD_FAILURE();
    return true;
  });
}

/// The distance is that of the maximum norm in whole cells, up to the limit, within the range.
template <int dim>
void expect_distances_in_cells() {
  std::mt19937 engine;
  const auto boxes = random_boxes<dim>(engine, 8, -3, 21, 1.5);
  Index<dim> begin, end;
  begin.fill(-1);
  end.fill(18);
  const int limit = 4;
  CellDistance<dim> distance;
  distance.build(boxes, begin, end, limit);
  int n_near = 0;
  for (int question = 0; question < 2000; ++question) {
    const Point<dim> x = random_point<dim>(engine, -1, 18);
    Index<dim> cell;
    for (int a = 0; a < dim; ++a)
      cell[a] = static_cast<int>(std::floor(x[a]));
    int expected = limit + 1;
    for (const Box<dim>& box : boxes) {
      int from_box = 0;
      for (int a = 0; a < dim; ++a) {
        const int first = std::max(static_cast<int>(std::floor(box.min()[a])), begin[a]);
        const int last = std::min(static_cast<int>(std::floor(box.max()[a])), end[a] - 1);
        from_box = first > last ? limit + 1 : std::max({from_box, first - cell[a], cell[a] - last});
      }
      expected = std::min(expected, from_box);
    }
    EXPECT_EQ(distance(cell), expected);
    n_near += expected < limit;
  }
  EXPECT_GT(n_near, 100);
  distance.build({}, begin, end, limit);
  EXPECT_EQ(distance(begin), limit + 1);
}

TEST(CellDistance, IsThatToTheNearestBox) {
  expect_distances_in_cells<2>();
  expect_distances_in_cells<3>();
}

}  // namespace
}  // namespace lockstep::test
