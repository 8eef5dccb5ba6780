#include "transport/cell_distance.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// The cells that a box touches along an axis, of [begin, end).
template <int dim>
std::array<int, 2> touched(const Box<dim>& box, int axis, int begin, int end) {
  return {static_cast<int>(std::clamp<double>(std::floor(box.min()[axis]), begin, end)),
          static_cast<int>(std::clamp<double>(std::floor(box.max()[axis]) + 1, begin, end))};
}
}  // namespace

template <int dim>
void CellDistance<dim>::build(const std::vector<Box<dim>>& boxes, const Index<dim>& begin,
                              const Index<dim>& end, int limit) {
  limit_ = limit;
  count_.fill(0);
  Box<dim> all;
  for (const Box<dim>& box : boxes)
    all.extend(box);
  if (all.isEmpty())
    return;
  std::size_t size = 1;
  for (int a = 0; a < dim; ++a) {
    all.min()[a] -= limit;
    all.max()[a] += limit;
    const auto [first, last] = touched<dim>(all, a, begin[a], end[a]);
    begin_[a] = first;
    count_[a] = last - first;
    size *= count_[a];
  }
  nearness_.assign(size, 0);
  if (size == 0)
    return;
  for (const Box<dim>& box : boxes) {
    Index<dim> first, last, cell;
    bool any = true;
    for (int a = 0; a < dim; ++a) {
      const auto [low, high] = touched<dim>(box, a, begin_[a], begin_[a] + count_[a]);
      first[a] = cell[a] = low - begin_[a];
      last[a] = high - begin_[a];
      any = any && low < high;
    }
    for (int a = 0; any && a < dim;) {
      std::size_t row = cell[dim - 1];
      for (int b = dim - 2; b > 0; --b)
        row = row * count_[b] + cell[b];
      std::fill_n(nearness_.begin() + row * count_[0] + first[0], last[0] - first[0], limit + 1);
      for (a = 1; a < dim && ++cell[a] == last[a]; ++a)
        cell[a] = first[a];
    }
  }
  for (int a = 0; a < dim; ++a)
    spread(a);
}

/// The maximum norm's distance is found axis by axis.
template <int dim>
void CellDistance<dim>::spread(int axis) {
  std::size_t stride = 1;
  for (int a = 0; a < axis; ++a)
    stride *= count_[a];
  const std::size_t plane = stride * count_[axis];
  const std::vector<unsigned char> before = nearness_;
  for (int step = 1; step <= std::min(limit_, count_[axis] - 1); ++step) {
    const std::size_t shift = step * stride;
    const auto most = static_cast<unsigned char>(limit_ + 1 - step);
    for (std::size_t first = 0; first < nearness_.size(); first += plane) {
      unsigned char* to = nearness_.data() + first;
      const unsigned char* from = before.data() + first;
      for (std::size_t i = 0; i < plane - shift; ++i)
        to[i] = std::max(to[i], std::min(from[i + shift], most));
      for (std::size_t i = shift; i < plane; ++i)
        to[i] = std::max(to[i], std::min(from[i - shift], most));
    }
  }
}

template class CellDistance<2>;
template class CellDistance<3>;

}  // namespace lockstep
