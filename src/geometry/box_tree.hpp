#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Order of boxes in which neighbours in the list are near each other in space.
struct SortedBoxes {
  std::vector<int> places;  ///< in a balanced binary tree
  double extent = 0;        ///< sum over the tree's nodes when they were sorted [m]
};
using BoxOrder = std::shared_ptr<const SortedBoxes>;

/// Sorts different numbers: if there are many, by a map of bits.
void sort_ids(std::vector<int>& ids);

/// Finds those of many boxes that touch another or are near a point. What it finds does not depend
/// on the order, so that boxes that have moved a little may be sorted as they were before.
template <int dim>
class BoxTree {
 public:
  BoxTree() = default;
  /// Sorts the boxes; or takes the `order` of a tree of as many, as long as it is of use.
  explicit BoxTree(std::vector<Box<dim>> boxes, BoxOrder order = nullptr);

  const BoxOrder& order() const { return order_; }
  int n_boxes() const { return static_cast<int>(boxes_.size()); }
  const Box<dim>& box(int i) const { return boxes_[i]; }
  /// Calls f(i) for the boxes that touch this one, until f returns true. True if f did.
  template <typename Function>
  bool any_touching(const Box<dim>& box, const Function& f) const;
  /// Finds the boxes that touch `box`, in ascending order; replaces the content of `found`.
  void touching(const Box<dim>& box, std::vector<int>& found) const;
  /// Finds the wanted ones of the boxes that touch `box`.
  template <typename Wanted>
  void touching(const Box<dim>& box, std::vector<int>& found, const Wanted& is_wanted) const;
  /// Calls f(i) for the boxes below the nodes of which all `meets(box of the node, node)` are true,
  /// until f returns true. True if f did.
  template <typename Meets, typename Function>
  bool any(const Meets& meets, const Function& f) const;
  /// By node a sum over the boxes below it: `add(sum, i)` adds one, `merge` two sums.
  template <typename Sum, typename Add, typename Merge>
  std::vector<Sum> over_nodes(const Add& add, const Merge& merge) const;
  /// Calls f(i) for the boxes whose square distance from x is no more than `reach()`, which may
  /// shrink on the way: the near ones come early.
  template <typename Function, typename Reach>
  void near(const Point<dim>& x, const Reach& reach, const Function& f) const;

 private:
  static constexpr int in_leaf = 4;  ///< boxes, at most
  int first_of(int leaf) const {
    return static_cast<int>(static_cast<long long>(leaf) * n_boxes() / n_leaves_);
  }
  void sort(std::vector<int>& order, int begin_leaf, int end_leaf) const;
  std::vector<int> sorted() const;
  void fill_nodes(const std::vector<int>& order);
  double extent() const;

  std::vector<Box<dim>> boxes_;
  BoxOrder order_;
  int n_leaves_ = 0;             ///< a power of two, or 0: no boxes
  std::vector<Box<dim>> nodes_;  ///< 1: the root; below i are 2 i and 2 i + 1
};

template <int dim>
template <typename Meets, typename Function>
bool BoxTree<dim>::any(const Meets& meets, const Function& f) const {
  if (n_leaves_ == 0)
    return false;
  std::array<int, 64> waiting;
  int n_waiting = 0;
  for (int node = 1;;) {
    if (meets(nodes_[node], node)) {
      if (node < n_leaves_) {
        waiting[n_waiting++] = 2 * node + 1;
        node *= 2;
        continue;
      }
      const int leaf = node - n_leaves_, end = first_of(leaf + 1);
      for (int k = first_of(leaf); k < end; ++k)
        if (f(order_->places[k]))
          return true;
    }
    if (n_waiting == 0)
      return false;
    node = waiting[--n_waiting];
  }
}

template <int dim>
template <typename Function>
bool BoxTree<dim>::any_touching(const Box<dim>& box, const Function& f) const {
  return !box.isEmpty() && any([&](const Box<dim>& node, int) { return node.intersects(box); },
                               [&](int i) { return boxes_[i].intersects(box) && f(i); });
}

template <int dim>
template <typename Wanted>
void BoxTree<dim>::touching(const Box<dim>& box, std::vector<int>& found,
                            const Wanted& is_wanted) const {
  found.clear();
  any_touching(box, [&](int i) {
    if (is_wanted(i))
      found.push_back(i);
    return false;
  });
  sort_ids(found);
}

template <int dim>
template <typename Sum, typename Add, typename Merge>
std::vector<Sum> BoxTree<dim>::over_nodes(const Add& add, const Merge& merge) const {
  std::vector<Sum> sums(nodes_.size());
  for (int leaf = 0; leaf < n_leaves_; ++leaf)
    for (int k = first_of(leaf); k < first_of(leaf + 1); ++k)
      add(sums[n_leaves_ + leaf], order_->places[k]);
  for (int node = n_leaves_ - 1; node > 0; --node)
    sums[node] = merge(sums[2 * node], sums[2 * node + 1]);
  return sums;
}

template <int dim>
template <typename Function, typename Reach>
void BoxTree<dim>::near(const Point<dim>& x, const Reach& reach, const Function& f) const {
  if (n_leaves_ == 0)
    return;
  struct Node {
    int node;
    double square;
  };
  std::array<Node, 64> waiting;
  int n_waiting = 0;
  const auto at = [&](int node) { return Node{node, nodes_[node].squaredExteriorDistance(x)}; };
  for (Node now = at(1);;) {
    if (now.square <= reach()) {
      if (now.node < n_leaves_) {
        const Node one = at(2 * now.node), other = at(2 * now.node + 1);
        waiting[n_waiting++] = one.square <= other.square ? other : one;
        now = one.square <= other.square ? one : other;
        continue;
      }
      const int leaf = now.node - n_leaves_, end = first_of(leaf + 1);
      for (int k = first_of(leaf); k < end; ++k) {
        const int i = order_->places[k];
        if (const double square = boxes_[i].squaredExteriorDistance(x); square <= reach())
          f(i);
      }
    }
    if (n_waiting == 0)
      return;
    now = waiting[--n_waiting];
  }
}

}  // namespace lockstep
