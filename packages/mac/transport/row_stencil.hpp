#pragma once
#include <algorithm>
#include <array>

#include "mac/transport/row_values.hpp"

namespace lockstep {

/// The samples below a row of points along one axis, and the weights of those above.
template <int dim>
struct RowSplit {
  void set(const RowValues<dim>& x, int axis, double offset) {
    below = (x - offset).floor();
    weight = (x - offset) - below;
    ahead = below - below[0];
    if (axis == 0)
      ahead -= steps<dim>();
  }
  RowValues<dim> below, weight;
  /// How far the points are from keeping step with the first of their row, that is, from lying one
  /// sample further each along x and beside the same one along other axes. Integers.
  RowValues<dim> ahead;
};

template <typename Splits>
bool are_in_step(const Splits& splits) {
  auto strays = splits[0]->ahead.abs().eval();
  for (std::size_t a = 1; a < splits.size(); ++a)
    strays += splits[a]->ahead.abs();
  return strays.sum() == 0;
}

/// The 2^dim samples around each point of a row. Neighbours in the row look at neighbours in memory
/// while they keep step: then whole rows are loaded at once. Where some are one sample ahead of
/// others, one row more is, and each point takes its own.
template <int dim>
class RowStencil {
 public:
  /// The points split along each axis, and the strides of the block; both must live on.
  RowStencil(const std::array<const RowSplit<dim>*, dim>& splits,
             const std::array<int, dim>& stride)
      : splits_(splits), stride_(stride), first_(place_of(0)) {
    in_step_ = are_in_step(splits);
    if (!in_step_)
      find_steps();
  }

  /// Whole rows are loaded: up to one place before the block and one behind it.
  void interpolate(const double* block, RowValues<dim>& values) const {
    if (in_step_)
      values = found<dim - 1, false, false>(block + first_).value;
    else if (by_rows_)
      values = found<dim - 1, true, false>(block + first_).value;
    else
      for (int i = 0; i < tile_width<dim>; ++i)
        values[i] = single<dim - 1>(block + place_of(i), i);
  }
  /// Also gives the range of the samples.
  void interpolate(const double* block, RowValues<dim>& values, RowValues<dim>& low,
                   RowValues<dim>& high) const {
    if (in_step_) {
      found<dim - 1, false, true>(block + first_).give(values, low, high);
      return;
    }
    if (by_rows_) {
      found<dim - 1, true, true>(block + first_).give(values, low, high);
      return;
    }
    interpolate(block, values);
    for (int i = 0; i < tile_width<dim>; ++i) {
      const double* c = block + place_of(i);
      low[i] = high[i] = *c;
      for (int k = 1; k < 1 << dim; ++k) {
        low[i] = std::min(low[i], c[corner(k)]);
        high[i] = std::max(high[i], c[corner(k)]);
      }
    }
  }

 private:
  /// What is found between samples, with or without their range.
  template <bool with_range>
  struct Found {
    explicit Found(const double* c) : value(Eigen::Map<const RowValues<dim>>(c)) {
      if constexpr (with_range)
        range = {value, value};
    }
    Found(const Found& lower, const Found& upper, const RowValues<dim>& weight)
        : value(blend<RowValues<dim>>(lower.value, upper.value, weight)) {
      if constexpr (with_range)
        range = {lower.range[0].min(upper.range[0]), lower.range[1].max(upper.range[1])};
    }
    /// Each point has its own of the two.
    Found(const RowValues<dim>& takes_first, const Found& first, const Found& second)
        : value(chosen<dim>(takes_first, first.value, second.value)) {
      if constexpr (with_range)
        range = {chosen<dim>(takes_first, first.range[0], second.range[0]),
                 chosen<dim>(takes_first, first.range[1], second.range[1])};
    }
    void give(RowValues<dim>& values, RowValues<dim>& low, RowValues<dim>& high) const {
      values = value;
      low = range[0];
      high = range[1];
    }
    RowValues<dim> value;
    std::array<RowValues<dim>, with_range ? 2 : 0> range;
  };

  void find_steps() {
    for (int a = 0; a < dim; ++a) {
      const RowValues<dim>& ahead = splits_[a]->ahead;
      const double least = ahead.minCoeff(), range = ahead.maxCoeff() - least;
      by_rows_ = by_rows_ && range <= 1;
      is_mixed_[a] = range > 0;
      is_ahead_[a] = ahead - least;
      const RowValues<dim>& weight = splits_[a]->weight;
      weight_of_other_[a] = chosen<dim>(is_ahead_[a], weight, 1 - weight);
      first_ += stride_[a] * static_cast<int>(least);
    }
  }
  /// Of the lowest sample of a point.
  int place_of(int i) const {
    double place = splits_[0]->below[i];
    for (int a = 1; a < dim; ++a)
      place += stride_[a] * splits_[a]->below[i];
    return static_cast<int>(place);
  }
  /// From the lowest sample of a point to sample k; bit a of k: upper along axis a.
  int corner(int k) const {
    int step = 0;
    for (int a = 0; a < dim; ++a)
      step += ((k >> a) & 1) * stride_[a];
    return step;
  }

  /// Along the axes up to this one, from the lowest samples of the row.
  template <int axis, bool mixed, bool with_range>
  [[gnu::always_inline]] Found<with_range> found(const double* c) const {
    if constexpr (axis < 0) {
      return Found<with_range>(c);
    } else {
      const int step = axis == 0 ? 1 : stride_[axis];
      const auto lower = found<axis - 1, mixed, with_range>(c);
      const auto upper = found<axis - 1, mixed, with_range>(c + step);
      if (!mixed || !is_mixed_[axis])
        return {lower, upper, splits_[axis]->weight};
      // The second of three samples is everybody's; who is ahead needs the third as well.
      const auto last = found<axis - 1, mixed, with_range>(c + 2 * step);
      return {upper, {is_ahead_[axis], last, lower}, weight_of_other_[axis]};
    }
  }
  /// The same for point i of the row alone.
  template <int axis>
  double single(const double* c, int i) const {
    if constexpr (axis < 0)
      return *c;
    else
      return blend(single<axis - 1>(c, i), single<axis - 1>(c + stride_[axis], i),
                   splits_[axis]->weight[i]);
  }

  const std::array<const RowSplit<dim>*, dim>& splits_;
  const std::array<int, dim>& stride_;
  int first_;  ///< place of the lowest sample of a point that is not ahead of others
  bool in_step_ = true, by_rows_ = true;  ///< neither: point by point
  std::array<bool, dim> is_mixed_{};
  /// Where mixed: 1 or 0, and the weight of the first or third of three samples.
  std::array<RowValues<dim>, dim> is_ahead_, weight_of_other_;
};

}  // namespace lockstep
