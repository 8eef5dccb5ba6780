#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Index of boxes by the bins of a uniform lattice, for queries of places much smaller than the
/// whole. Empty bins take three bits each.
template <int dim>
class BoxBins {
 public:
  struct List {
    const int *first = nullptr, *last = nullptr;
    int place = -1;  ///< place of the bin among those that are not empty
    const int* begin() const { return first; }
    const int* end() const { return last; }
  };
  /// Bins of `width` [m], one of whose corners is `origin`, over `region`; boxes beyond the region
  /// are left out. Box i is listed in those of the bins it touches for which `counts(i, centre of
  /// the bin)` is true.
  template <typename Counts>
  void build(const std::vector<Box<dim>>& boxes, const Box<dim>& region, const Point<dim>& origin,
             double width, const Counts& counts);

  /// Bins that are not empty.
  int n_used() const { return static_cast<int>(start_.size()) - 1; }
  /// True if the bins that this box touches are empty.
  bool clear(const Box<dim>& box) const { return !any_set(used_, range(box)); }
  /// True if the bins that this box touches hold no box at all, whether it counts or not.
  bool clear_of_boxes(const Box<dim>& box) const { return !any_set(boxed_, range(box)); }
  /// True if a box touches a bin that lies within this one.
  bool box_within(const Box<dim>& box) const;
  /// Calls f(list) for the bins that this box touches.
  template <typename Function>
  void visit(const Box<dim>& box, const Function& f) const;
  /// Returns the content of the bin at a place: indices, ascending.
  List at(const Point<dim>& x) const;
  /// Returns the content of a bin, counted from the one whose lower corner is the origin.
  List in(const Index<dim>& bin) const;
  /// Calls f(list, fraction of the segment where it enters the bin) for the bins on the
  /// way from a to b in their order, until f returns true. Bins that only a
  /// round-off separates from the segment may be left out.
  template <typename Function>
  void walk(const Point<dim>& a, const Point<dim>& b, const Function& f) const;

 private:
  struct Range {
    Index<dim> begin, end;
  };
  /// Bins that a box touches; without any if it misses the region.
  Range range(const Box<dim>& box) const;
  bool any_set(const std::vector<std::uint64_t>& bits, const Range& asked) const;
  /// Content of a bin within the region, counted from its lowest one.
  List content(const Index<dim>& bin) const;
  /// Sets the bins; false if there are none.
  bool lay_out(const Box<dim>& region, const Point<dim>& origin, double width);
  struct Entry {
    int word, bit, item;
  };
  void fill(const std::vector<Entry>& entries);
  /// First word of the row of bins along axis 0.
  int row_of(const Index<dim>& bin) const {
    int row = bin[dim - 1];
    for (int a = dim - 2; a > 0; --a)
      row = row * count_[a] + bin[a];
    return row * words_in_row_;
  }
  /// Calls f(first bin) for the rows along axis 0 of a range until f returns true. True if f did.
  template <typename Function>
  bool any_row(const Range& range, const Function& f) const;
  static std::uint64_t bits_below(int bit) { return (std::uint64_t{1} << bit) - 1; }
  /// Place among the bins that are not empty; the bin is one of them.
  int slot(int word, int bit) const {
    return slots_before_[word] + __builtin_popcountll(used_[word] & bits_below(bit));
  }
  List list(int slot) const {
    return {items_.data() + start_[slot], items_.data() + start_[slot + 1], slot};
  }

  Point<dim> lower_ = Point<dim>::Zero();
  double per_width_ = 0;  ///< bins a metre
  Index<dim> first_{};    ///< the lowest bin, counted from the origin
  Index<dim> count_{};    ///< bins along each axis; 0: there are no boxes
  int words_in_row_ = 0;
  /// A bit for each bin along axis 0, rows start a word: bins that are not empty, and that a box
  /// touches.
  std::vector<std::uint64_t> used_, boxed_;
  std::vector<int> slots_before_;  ///< bits set in the words before
  std::vector<int> start_{0};      ///< first item of each bin that is not empty, and the end
  std::vector<int> items_;
};

template <int dim>
template <typename Function>
bool BoxBins<dim>::any_row(const Range& range, const Function& f) const {
  for (int a = 0; a < dim; ++a)
    if (range.begin[a] >= range.end[a])
      return false;
  Index<dim> bin = range.begin;
  for (int a = 0; a < dim;) {
    if (f(bin))
      return true;
    for (a = 1; a < dim && ++bin[a] == range.end[a]; ++a)
      bin[a] = range.begin[a];
  }
  return false;
}

template <int dim>
template <typename Counts>
void BoxBins<dim>::build(const std::vector<Box<dim>>& boxes, const Box<dim>& region,
                         const Point<dim>& origin, double width, const Counts& counts) {
  std::vector<Entry> entries;
  if (lay_out(region, origin, width)) {
    entries.reserve(8 * boxes.size());
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      const Range touched = range(boxes[i]);
      any_row(touched, [&](const Index<dim>& first) {
        Point<dim> center;
        for (int a = 0; a < dim; ++a)
          center[a] = lower_[a] + (first[a] + 0.5) * width;
        const int row = row_of(first);
        for (int bin = first[0]; bin < touched.end[0]; ++bin, center[0] += width) {
          boxed_[row + (bin >> 6)] |= std::uint64_t{1} << (bin & 63);
          if (counts(i, center))
            entries.push_back({row + (bin >> 6), bin & 63, i});
        }
        return false;
      });
    }
  }
  fill(entries);
}

template <int dim>
template <typename Function>
void BoxBins<dim>::visit(const Box<dim>& box, const Function& f) const {
  const Range asked = range(box);
  any_row(asked, [&](const Index<dim>& first) {
    const int row = row_of(first);
    for (int bin = first[0]; bin < asked.end[0]; ++bin)
      if (used_[row + (bin >> 6)] >> (bin & 63) & 1)
        f(list(slot(row + (bin >> 6), bin & 63)));
    return false;
  });
}

template <int dim>
template <typename Function>
void BoxBins<dim>::walk(const Point<dim>& a, const Point<dim>& b, const Function& f) const {
  if (count_[0] == 0)
    return;
  const Point<dim> from = (a - lower_) * per_width_, way = (b - a) * per_width_;
  double fraction = 0, end = 1;
  for (int k = 0; k < dim; ++k) {  // the part within the bins
    if (way[k] == 0 && (from[k] < 0 || from[k] > count_[k]))
      return;
    if (way[k] == 0)
      continue;
    const double at_lower = -from[k] / way[k], at_upper = (count_[k] - from[k]) / way[k];
    fraction = std::max(fraction, std::min(at_lower, at_upper));
    end = std::min(end, std::max(at_lower, at_upper));
  }
  if (fraction > end)
    return;
  Index<dim> bin;
  Point<dim> leaves;  // the fraction where the segment leaves the bin along each axis
  for (int k = 0; k < dim; ++k) {
    const double place = std::floor(from[k] + fraction * way[k]);
    bin[k] = static_cast<int>(std::clamp<double>(place, 0, count_[k] - 1));
    leaves[k] = way[k] == 0 ? std::numeric_limits<double>::infinity()
                            : (bin[k] + (way[k] > 0 ? 1 : 0) - from[k]) / way[k];
  }
  while (true) {
    const int word = row_of(bin) + (bin[0] >> 6), bit = bin[0] & 63;
    if ((used_[word] >> bit & 1) != 0 && f(list(slot(word, bit)), fraction))
      return;
    int axis = 0;
    for (int k = 1; k < dim; ++k)
      if (leaves[k] < leaves[axis])
        axis = k;
    fraction = leaves[axis];
    bin[axis] += way[axis] > 0 ? 1 : -1;
    if (fraction > end || bin[axis] < 0 || bin[axis] == count_[axis])
      return;
    leaves[axis] = (bin[axis] + (way[axis] > 0 ? 1 : 0) - from[axis]) / way[axis];
  }
}

}  // namespace lockstep
