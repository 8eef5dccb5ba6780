#include "geometry/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace lockstep {

namespace {

/// Growth of the extent of a tree's nodes since its boxes were sorted at which they are sorted anew
/// [1].
constexpr double most_growth = 1.5;
}  // namespace

void sort_ids(std::vector<int>& ids) {
  constexpr int many = 32;
  if (ids.size() < many)
    return std::sort(ids.begin(), ids.end());
  const auto [least, most] = std::minmax_element(ids.begin(), ids.end());
  const int first = *least, n_words = (*most - first) / 64 + 1;
  if (n_words > 8 * static_cast<int>(ids.size()))
    return std::sort(ids.begin(), ids.end());
  std::vector<std::uint64_t> bits(n_words, 0);
  for (const int id : ids)
    bits[(id - first) >> 6] |= std::uint64_t{1} << ((id - first) & 63);
  auto next = ids.begin();
  for (int word = 0; word < n_words; ++word)
    for (std::uint64_t rest = bits[word]; rest != 0; rest &= rest - 1)
      *next++ = first + 64 * word + __builtin_ctzll(rest);
}

template <int dim>
BoxTree<dim>::BoxTree(std::vector<Box<dim>> boxes, BoxOrder order)
    : boxes_(std::move(boxes)), order_(std::move(order)) {
  if (boxes_.empty())
    return;
  n_leaves_ = 1;
  while (n_leaves_ * in_leaf < n_boxes())
    n_leaves_ *= 2;
  nodes_.resize(2 * n_leaves_);
  if (order_ && order_->places.size() == boxes_.size()) {
    fill_nodes(order_->places);
    if (extent() <= most_growth * order_->extent)
      return;
  }
  std::vector<int> places = sorted();
  fill_nodes(places);
  order_ = std::make_shared<const SortedBoxes>(SortedBoxes{std::move(places), extent()});
}

template <int dim>
void BoxTree<dim>::fill_nodes(const std::vector<int>& order) {
  for (int leaf = 0; leaf < n_leaves_; ++leaf) {
    Box<dim>& node = nodes_[n_leaves_ + leaf];
    node.setEmpty();
    for (int k = first_of(leaf); k < first_of(leaf + 1); ++k)
      node.extend(boxes_[order[k]]);
  }
  for (int node = n_leaves_ - 1; node > 0; --node)
    nodes_[node] = nodes_[2 * node].merged(nodes_[2 * node + 1]);
}

/// Sums the sides of all nodes: how much a search meets.
template <int dim>
double BoxTree<dim>::extent() const {
  double sum = 0;
  for (const Box<dim>& node : nodes_)
    if (!node.isEmpty())
      sum += node.sizes().sum();
  return sum;
}

template <int dim>
std::vector<int> BoxTree<dim>::sorted() const {
  std::vector<int> order(boxes_.size());
  std::iota(order.begin(), order.end(), 0);
  sort(order, 0, n_leaves_);
  return order;
}

/// Halves the boxes of some leaves along the axis on which their centres spread farthest.
template <int dim>
void BoxTree<dim>::sort(std::vector<int>& order, int begin_leaf, int end_leaf) const {
  if (end_leaf - begin_leaf < 2)
    return;
  const auto begin = order.begin() + first_of(begin_leaf), end = order.begin() + first_of(end_leaf);
  const int middle_leaf = begin_leaf + (end_leaf - begin_leaf) / 2;
  Box<dim> centers;
  for (auto i = begin; i != end; ++i)
    if (!boxes_[*i].isEmpty())
      centers.extend(boxes_[*i].center());
  int axis = 0;
  if (!centers.isEmpty())
    centers.sizes().maxCoeff(&axis);
  // empty boxes come last; ties go by number
  const auto key = [&](int i) {
    const Box<dim>& box = boxes_[i];
    return box.isEmpty() ? std::numeric_limits<double>::infinity()
                         : box.min()[axis] + box.max()[axis];
  };
  std::nth_element(begin, order.begin() + first_of(middle_leaf), end, [&](int i, int j) {
    const double one = key(i), other = key(j);
    return one < other || (one == other && i < j);
  });
  sort(order, begin_leaf, middle_leaf);
  sort(order, middle_leaf, end_leaf);
}

template <int dim>
void BoxTree<dim>::touching(const Box<dim>& box, std::vector<int>& found) const {
  touching(box, found, [](int) { return true; });
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace lockstep
