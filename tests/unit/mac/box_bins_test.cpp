#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mac/transport/box_bins.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Box<dim> random_box(std::mt19937& engine, double size) {
  std::uniform_real_distribution<double> place(-0.2, 1.2), extent(0, size);
  Point<dim> corner, sizes;
  for (int a = 0; a < dim; ++a) {
    corner[a] = place(engine);
    sizes[a] = extent(engine);
  }
  return {corner, corner + sizes};
}

/// Few boxes are looked through, many are binned; some lie beyond the region.
template <int dim>
void compare_with_looking_at_all(int n_boxes) {
  std::mt19937 engine(n_boxes);
  std::vector<Box<dim>> boxes;
  for (int i = 0; i < n_boxes; ++i)
    boxes.push_back(random_box<dim>(engine, n_boxes < 50 ? 0.8 : 0.15));
  BoxBins<dim> bins;
  bins.build(boxes, Box<dim>(Point<dim>::Zero(), Point<dim>::Ones()), 0.1);
  int n_found = 0;
  std::vector<int> found;
  for (int question = 0; question < 200; ++question) {
    const Box<dim> asked = random_box<dim>(engine, 0.1);
    std::vector<int> expected;
    for (int i = 0; i < n_boxes; ++i)
      if (boxes[i].intersects(asked))
        expected.push_back(i);
    bins.touching(asked, found);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(bins.any_touches(asked), !expected.empty());
    n_found += static_cast<int>(expected.size());
  }
  EXPECT_GT(n_found, 0);
}

TEST(BoxBins, FindWhatLookingAtAllFinds) {
  compare_with_looking_at_all<2>(5);
  compare_with_looking_at_all<2>(300);
  compare_with_looking_at_all<3>(10);
  compare_with_looking_at_all<3>(1000);
}

TEST(BoxBins, WithoutBoxesNothingIsFound) {
  BoxBins<2> bins;
  std::vector<int> found{7};
  bins.touching(Box<2>(Point<2>::Zero(), Point<2>::Ones()), found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace lockstep::test
