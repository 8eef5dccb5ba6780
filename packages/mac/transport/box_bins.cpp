#include "mac/transport/box_bins.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Up to so many boxes are looked through one by one.
constexpr std::size_t handful = 12;
/// Bins along an axis, at most.
constexpr double most_bins = 64;
}  // namespace

template <int dim>
void BoxBins<dim>::clear() {
  boxes_ = nullptr;
  per_width_ = 0;
}

template <int dim>
int BoxBins<dim>::row_of(const Index<dim>& bin) const {
  int row = 0;
  for (int a = dim - 1; a > 0; --a)
    row = (row + bin[a]) * (a > 1 ? count_[a - 1] : 1);
  return row * count_[0];
}

template <int dim>
template <typename Function>
void BoxBins<dim>::for_each_row(const Range& range, const Function& f) const {
  Index<dim> bin = range.begin;
  while (true) {
    const int row = row_of(bin);
    f(row + range.begin[0], row + range.end[0]);
    int a = 1;
    while (a < dim && ++bin[a] == range.end[a]) {
      bin[a] = range.begin[a];
      ++a;
    }
    if (a == dim)
      return;
  }
}

template <int dim>
typename BoxBins<dim>::Range BoxBins<dim>::range(const Box<dim>& box) const {
  Range range;
  for (int a = 0; a < dim; ++a) {
    const double last = count_[a] - 1;
    const double low = (box.min()[a] - lower_[a]) * per_width_;
    const double high = (box.max()[a] - lower_[a]) * per_width_;
    range.begin[a] = static_cast<int>(std::clamp(low, 0., last));
    range.end[a] = static_cast<int>(std::clamp(high, 0., last)) + 1;
  }
  return range;
}

template <int dim>
void BoxBins<dim>::build(const std::vector<Box<dim>>& boxes, const Box<dim>& region, double width) {
  boxes_ = &boxes;
  per_width_ = 0;
  if (boxes.size() <= handful)
    return;
  lower_ = region.min();
  per_width_ = 1 / std::max(width, region.sizes().maxCoeff() / most_bins);
  int n_bins = 1;
  for (int a = 0; a < dim; ++a) {
    count_[a] = std::max(1, static_cast<int>(std::ceil(region.sizes()[a] * per_width_)));
    n_bins *= count_[a];
  }
  start_.assign(n_bins + 1, 0);
  for (const Box<dim>& box : boxes)
    for_each_row(range(box), [&](int first, int last) {
      for (int bin = first; bin < last; ++bin)
        ++start_[bin + 1];
    });
  for (int bin = 0; bin < n_bins; ++bin)
    start_[bin + 1] += start_[bin];
  items_.resize(start_[n_bins]);
  // Filled from the back, so that every start ends up where it belongs.
  for (int i = static_cast<int>(boxes.size()) - 1; i >= 0; --i)
    for_each_row(range(boxes[i]), [&](int first, int last) {
      for (int bin = first; bin < last; ++bin)
        items_[--start_[bin + 1]] = i;
    });
  std::rotate(start_.begin(), start_.begin() + 1, start_.end());
  start_.back() = static_cast<int>(items_.size());
  seen_.assign(boxes.size(), 0);
  question_ = 0;
}

template <int dim>
void BoxBins<dim>::touching(const Box<dim>& box, std::vector<int>& found) const {
  found.clear();
  if (!boxes_)
    return;
  const std::vector<Box<dim>>& boxes = *boxes_;
  if (per_width_ == 0) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].intersects(box))
        found.push_back(static_cast<int>(i));
    return;
  }
  ++question_;
  for_each_row(range(box), [&](int first, int last) {
    for (int k = start_[first]; k < start_[last]; ++k) {
      const int i = items_[k];
      if (seen_[i] == question_)
        continue;
      seen_[i] = question_;
      if (boxes[i].intersects(box))
        found.push_back(i);
    }
  });
}

template <int dim>
bool BoxBins<dim>::any_touches(const Box<dim>& box) const {
  if (!boxes_)
    return false;
  const std::vector<Box<dim>>& boxes = *boxes_;
  const auto touches = [&](const Box<dim>& other) { return other.intersects(box); };
  if (per_width_ == 0)
    return std::any_of(boxes.begin(), boxes.end(), touches);
  bool any = false;
  for_each_row(range(box), [&](int first, int last) {
    for (int k = start_[first]; !any && k < start_[last]; ++k)
      any = touches(boxes[items_[k]]);
  });
  return any;
}

template class BoxBins<2>;
template class BoxBins<3>;

}  // namespace lockstep
