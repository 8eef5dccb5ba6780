#include "contact/search/meeting_pairs.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
std::vector<std::array<int, 2>> meeting_pairs(const std::vector<Box<dim>>& boxes,
                                              const std::function<bool(int, int)>& is_wanted) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    if (!boxes[i].isEmpty())
      order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return boxes[i].min()[0] < boxes[j].min()[0]; });
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box<dim>& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].min()[0] <= box.max()[0]; ++j) {
      const std::array<int, 2> pair{std::min(order[i], order[j]), std::max(order[i], order[j])};
      if (box.intersects(boxes[order[j]]) && is_wanted(pair[0], pair[1]))
        pairs.push_back(pair);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template std::vector<std::array<int, 2>> meeting_pairs<2>(const std::vector<Box<2>>&,
                                                          const std::function<bool(int, int)>&);
template std::vector<std::array<int, 2>> meeting_pairs<3>(const std::vector<Box<3>>&,
                                                          const std::function<bool(int, int)>&);

}  // namespace lockstep
