#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Number of cells between a cell and the nearest that some box touches (maximum norm), up to a
/// limit: one lookup tells most places from those near a surface.
template <int dim>
class CellDistance {
 public:
  /// `boxes` in cells; only the cells [begin, end) and distances up to `limit` (at most 250) count.
  void build(const std::vector<Box<dim>>& boxes, const Index<dim>& begin, const Index<dim>& end,
             int limit);
  /// 0: a box touches the cell; limit + 1: all boxes are farther than the limit.
  int operator()(const Index<dim>& cell) const {
    int place = 0;
    for (int a = dim - 1; a >= 0; --a) {
      const int i = cell[a] - begin_[a];
      if (i < 0 || i >= count_[a])
        return limit_ + 1;
      place = place * count_[a] + i;
    }
    return limit_ + 1 - nearness_[place];
  }

 private:
  void spread(int axis);

  int limit_ = 0;
  Index<dim> begin_{}, count_{};         ///< range of the cells that are not farther than the limit
  std::vector<unsigned char> nearness_;  ///< limit + 1 - distance, x fastest
};

}  // namespace lockstep
