#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace lockstep {

/// Disjoint sets of 0 .. n-1; the root is the smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of i and j; returns false if they are of one set already.
  bool join(int i, int j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
    return i != j;
  }
  /// Joins n numbers, from that one on.
  void join_run(int begin, int n) {
    int first = root(begin);
    for (int i = begin + 1; i < begin + n; ++i) {
      if (parent_[i] == i) {
        parent_[i] = first;
      } else {
        join(begin, i);
        first = root(begin);
      }
    }
  }
  /// Makes every member point at its root.
  void flatten() {
    for (int& parent : parent_)  // parents come first
      parent = parent_[parent];
  }

 private:
  std::vector<int> parent_;
};

}  // namespace lockstep
