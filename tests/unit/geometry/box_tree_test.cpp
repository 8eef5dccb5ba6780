#include "geometry/box_tree.hpp"

#include <algorithm>

#include "support.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Point<dim> random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> place(0, 1);
  Point<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = place(random);
  return x;
}

/// Every seventh is empty.
template <int dim>
std::vector<Box<dim>> random_boxes(int n, std::mt19937& random) {
  std::vector<Box<dim>> boxes(n);
  for (int i = 0; i < n; ++i) {
    if (i % 7 == 3)
      continue;
    const Point<dim> x = random_point<dim>(random);
    boxes[i].extend(x);
    boxes[i].extend(x + 0.1 * random_point<dim>(random));
  }
  return boxes;
}

template <int dim>
void expect_what_all_boxes_say(const BoxTree<dim>& tree, const std::vector<Box<dim>>& boxes,
                               std::mt19937& random) {
  std::vector<int> found, expected;
  for (int question = 0; question < 50; ++question) {
    const Point<dim> x = random_point<dim>(random);
    const Box<dim> box(x, x + 0.3 * random_point<dim>(random));
    expected.clear();
    double nearest = 0.1;  // no farther
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      if (boxes[i].isEmpty())
        continue;
      if (boxes[i].intersects(box))
        expected.push_back(i);
      nearest = std::min(nearest, boxes[i].squaredExteriorDistance(x));
    }
    tree.touching(box, found);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(tree.any_touching(box, [](int) { return true; }), !expected.empty());
    double reach = 0.1;
    tree.near(
        x, [&] { return reach; },
        [&](int i) { reach = std::min(reach, boxes[i].squaredExteriorDistance(x)); });
    EXPECT_EQ(reach, nearest);
  }
}

template <int dim>
void expect_what_all_boxes_say() {
  std::mt19937 random(5);
  for (const int n : {1, 2, 5, 64, 1000}) {
    const auto boxes = random_boxes<dim>(n, random);
    const BoxTree<dim> tree(boxes);
    expect_what_all_boxes_say<dim>(tree, boxes, random);
    // an order that has nothing to do with where they are
    const auto others = random_boxes<dim>(n, random);
    expect_what_all_boxes_say<dim>(BoxTree<dim>(others, tree.order()), others, random);
  }
}

TEST(BoxTree, FindsWhatAllBoxesSay) {
  expect_what_all_boxes_say<2>();
  expect_what_all_boxes_say<3>();
}

TEST(BoxTree, OfNothing) {
  const BoxTree<3> tree;
  std::vector<int> found{1};
  tree.touching({Point<3>(0, 0, 0), Point<3>(1, 1, 1)}, found);
  EXPECT_TRUE(found.empty());
  tree.near(
      Point<3>(0, 0, 0), [] { return 1e300; }, [](int) { FAIL(); });
}

TEST(BoxTree, IsSortedAnewOnceItsBoxesHaveMixed) {
  std::mt19937 random(7);
  auto boxes = random_boxes<2>(100, random);
  const BoxTree<2> first(boxes);
  for (Box<2>& box : boxes)
    box.translate(Point<2>(3, 0.01));
  const BoxTree<2> moved(boxes, first.order());
  EXPECT_EQ(moved.order(), first.order());
  std::shuffle(boxes.begin(), boxes.end(), random);
  const BoxTree<2> mixed(boxes, moved.order());
  EXPECT_EQ(mixed.order()->places, BoxTree<2>(boxes).order()->places);
}

TEST(BoxTree, AnOrderOfOthersIsNotTaken) {
  std::mt19937 random(6);
  const BoxTree<2> few(random_boxes<2>(10, random));
  const auto boxes = random_boxes<2>(100, random);
  expect_what_all_boxes_say<2>(BoxTree<2>(boxes, few.order()), boxes, random);
}

}  // namespace
}  // namespace lockstep::test
