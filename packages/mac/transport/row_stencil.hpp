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
      values = between<dim - 1, false>(block + first_);
    else if (by_rows_)
      values = between<dim - 1, true>(block + first_);
    else
      for (int i = 0; i < tile_width<dim>; ++i)
        values[i] = single<dim - 1>(block + place_of(i), i);
  }
  /// The range of the samples.
  void find_range(const double* block, RowValues<dim>& low, RowValues<dim>& high) const {
    if (by_rows_) {
      const Range found =
          in_step_ ? range<dim - 1, false>(block + first_) : range<dim - 1, true>(block + first_);
      low = found.low;
      high = found.high;
      return;
    }
    for (int i = 0; i < tile_width<dim>; ++i) {
      const double* c = block + place_of(i);
      double least = *c, most = *c;
      for (int k = 1; k < 1 << dim; ++k) {
        least = std::min(least, c[corner(k)]);
        most = std::max(most, c[corner(k)]);
      }
      low[i] = least;
      high[i] = most;
    }
  }

 private:
  struct Range {
    RowValues<dim> low, high;
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

  static RowValues<dim> row_at(const double* c) { return Eigen::Map<const RowValues<dim>>(c); }

  /// Along the axes up to this one, from the lowest samples of the row. Of three samples along a
  /// mixed axis the second is everybody's; who is ahead takes the third, others the first.
  template <int axis, bool mixed>
  [[gnu::always_inline]] RowValues<dim> between(const double* c) const {
    if constexpr (axis < 0) {
      return row_at(c);
    } else {
      const int step = axis == 0 ? 1 : stride_[axis];
      const RowValues<dim> lower = between<axis - 1, mixed>(c);
      const RowValues<dim> upper = between<axis - 1, mixed>(c + step);
      if (!mixed || !is_mixed_[axis])
        return blend<RowValues<dim>>(lower, upper, splits_[axis]->weight);
      const RowValues<dim> last = between<axis - 1, mixed>(c + 2 * step);
      return blend<RowValues<dim>>(upper, chosen<dim>(is_ahead_[axis], last, lower),
                                   weight_of_other_[axis]);
    }
  }
  /// The same for the range of the samples.
  template <int axis, bool mixed>
  [[gnu::always_inline]] Range range(const double* c) const {
    const int step = axis == 0 ? 1 : stride_[axis];
    if constexpr (axis == 0) {
      const RowValues<dim> lower = row_at(c), upper = row_at(c + 1);
      if (!mixed || !is_mixed_[0])
        return {lower.min(upper), lower.max(upper)};
      const RowValues<dim> other = chosen<dim>(is_ahead_[0], row_at(c + 2), lower);
      return {upper.min(other), upper.max(other)};
    } else {
      const Range lower = range<axis - 1, mixed>(c), upper = range<axis - 1, mixed>(c + step);
      if (!mixed || !is_mixed_[axis])
        return {lower.low.min(upper.low), lower.high.max(upper.high)};
      const Range last = range<axis - 1, mixed>(c + 2 * step);
      return {upper.low.min(chosen<dim>(is_ahead_[axis], last.low, lower.low)),
              upper.high.max(chosen<dim>(is_ahead_[axis], last.high, lower.high))};
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
