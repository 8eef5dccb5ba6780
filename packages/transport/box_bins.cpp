#include "transport/box_bins.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
typename BoxBins<dim>::Range BoxBins<dim>::range(const Box<dim>& box) const {
  Range range;
  for (int a = 0; a < dim; ++a) {
    const double low = std::floor((box.min()[a] - lower_[a]) * per_width_);
    const double high = std::floor((box.max()[a] - lower_[a]) * per_width_);
    range.begin[a] = static_cast<int>(std::clamp<double>(low, 0, count_[a]));
    range.end[a] = static_cast<int>(std::clamp<double>(high + 1, 0, count_[a]));
  }
  return range;
}

template <int dim>
bool BoxBins<dim>::lay_out(const Box<dim>& region, const Point<dim>& origin, double width) {
  count_.fill(0);
  used_.clear();
  boxed_.clear();
  if (region.isEmpty())
    return false;
  per_width_ = 1 / width;
  int n_rows = 1;
  for (int a = 0; a < dim; ++a) {
    const double first = std::floor((region.min()[a] - origin[a]) * per_width_);
    first_[a] = static_cast<int>(first);
    lower_[a] = origin[a] + first * width;
    count_[a] = static_cast<int>(std::floor((region.max()[a] - lower_[a]) * per_width_)) + 1;
    n_rows *= a > 0 ? count_[a] : 1;
  }
  words_in_row_ = (count_[0] + 63) / 64;
  used_.resize(n_rows * words_in_row_);
  boxed_.resize(used_.size());
  return true;
}

template <int dim>
void BoxBins<dim>::fill(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries)
    used_[entry.word] |= std::uint64_t{1} << entry.bit;
  slots_before_.resize(used_.size());
  int n_slots = 0;
  for (std::size_t word = 0; word < used_.size(); ++word) {
    slots_before_[word] = n_slots;
    n_slots += __builtin_popcountll(used_[word]);
  }
  start_.assign(n_slots + 1, 0);
  for (const Entry& entry : entries)
    ++start_[slot(entry.word, entry.bit)];
  for (int slot = 1; slot <= n_slots; ++slot)
    start_[slot] += start_[slot - 1];
  items_.resize(entries.size());
  // Filled from the back, so that every start ends up where it belongs.
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
    items_[--start_[slot(entry->word, entry->bit)]] = entry->item;
}

template <int dim>
bool BoxBins<dim>::any_set(const std::vector<std::uint64_t>& bits, const Range& asked) const {
  const int last = asked.end[0] - 1;
  const std::uint64_t first_bits = ~bits_below(asked.begin[0] & 63);
  const std::uint64_t last_bits = ~std::uint64_t{0} >> (63 - (last & 63));
  return any_row(asked, [&](const Index<dim>& bin) {
    const std::uint64_t* row = bits.data() + row_of(bin);
    const int first_word = bin[0] >> 6, last_word = last >> 6;
    if (first_word == last_word)
      return (row[first_word] & first_bits & last_bits) != 0;
    bool any = (row[first_word] & first_bits) != 0 || (row[last_word] & last_bits) != 0;
    for (int word = first_word + 1; word < last_word; ++word)
      any = any || row[word] != 0;
    return any;
  });
}

template <int dim>
bool BoxBins<dim>::box_within(const Box<dim>& box) const {
  Range within = range(box);
  for (int a = 0; a < dim; ++a) {
    within.begin[a] += lower_[a] + within.begin[a] / per_width_ < box.min()[a];
    within.end[a] -= lower_[a] + within.end[a] / per_width_ > box.max()[a];
  }
  return any_set(boxed_, within);
}

template <int dim>
typename BoxBins<dim>::List BoxBins<dim>::at(const Point<dim>& x) const {
  Index<dim> bin;
  for (int a = 0; a < dim; ++a) {
    const double place = std::floor((x[a] - lower_[a]) * per_width_);
    if (!(place >= 0 && place < count_[a]))
      return {};
    bin[a] = static_cast<int>(place);
  }
  return content(bin);
}

template <int dim>
typename BoxBins<dim>::List BoxBins<dim>::in(const Index<dim>& bin) const {
  Index<dim> place;
  for (int a = 0; a < dim; ++a) {
    place[a] = bin[a] - first_[a];
    if (place[a] < 0 || place[a] >= count_[a])
      return {};
  }
  return content(place);
}

template <int dim>
typename BoxBins<dim>::List BoxBins<dim>::content(const Index<dim>& bin) const {
  const int word = row_of(bin) + (bin[0] >> 6), bit = bin[0] & 63;
  return (used_[word] >> bit & 1) != 0 ? list(slot(word, bit)) : List{};
}

template class BoxBins<2>;
template class BoxBins<3>;

}  // namespace lockstep
