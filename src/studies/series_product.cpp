#include "studies/series_product.hpp"

namespace lockstep {
namespace {

template <typename Value>
void append(std::vector<Value>& list, const std::vector<Value>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

Series combined(const Series& before, const Series& option, const Series& plain) {
  Series result = before;
  result.name += (before.name.empty() ? "" : ", ") + option.name;
  append(result.constants, option.constants);
  append(result.assignments, option.assignments);
  if (option.scene_file != plain.scene_file)
    result.scene_file = option.scene_file;
  if (!option.values.empty())
    result.values = option.values;
  return result;
}

}  // namespace

std::vector<Series> series_product(const std::vector<std::vector<Series>>& factors,
                                   const Series& plain) {
  if (factors.empty())
    return {};
  std::vector<Series> product{plain};
  for (const std::vector<Series>& factor : factors) {
    std::vector<Series> longer;
    for (const Series& before : product)
      for (const Series& option : factor)
        longer.push_back(combined(before, option, plain));
    product = std::move(longer);
  }
  return product;
}

}  // namespace lockstep
