#pragma once
#include <algorithm>
#include <array>
#include <type_traits>

#include "transport/strip_values.hpp"

namespace lockstep {

/// The samples below a strip of points along one axis, and the weights of those above. The points
/// keep step if each lies one sample further than the one before it along x, and beside the same
/// one along other axes. Where some are one sample ahead of that, the row is mixed.
template <int dim>
struct StripSplit {
  void set(const StripValues<dim>& x, int axis, double offset) {
    const StripValues<dim> place = x - offset;
    below = place.floor();
    weight = place - below;
    StripValues<dim> ahead = below - below[0];
    if (axis == 0)
      ahead -= steps<dim>();
    first = static_cast<int>(below[0]);
    is_mixed = has_nonzero(ahead);
    by_strips = true;
    if (is_mixed)
      find_steps(ahead);
  }

  StripValues<dim> below, weight;
  int first;       ///< sample of the first point, or one less if that is ahead of others
  bool is_mixed;   ///< not all points keep step
  bool by_strips;  ///< true for a point by rows; others are one sample ahead
  /// Where mixed: 1 or 0, and the weight of the first or third of three samples.
  StripValues<dim> is_ahead, weight_of_other;

 private:
  void find_steps(const StripValues<dim>& ahead) {
    const StripValues<dim> behind = ahead.min(0);
    is_ahead = ahead;
    if (has_nonzero(behind)) {
      --first;
      is_ahead += 1;
    }
    by_strips = !has_nonzero(StripValues<dim>(is_ahead * (is_ahead - 1)));
    weight_of_other = chosen(is_ahead, weight, StripValues<dim>(1 - weight));
  }
};

template <typename Splits>
bool are_in_step(const Splits& splits) {
  return std::none_of(splits.begin(), splits.end(), [](const auto* s) { return s->is_mixed; });
}

/// The 2^dim samples around each point of a row. Neighbours in the row look at neighbours in memory
/// while they keep step: then whole rows are loaded at once. Where some are one sample ahead of
/// others, one row more is, and each point takes its own.
template <int dim>
class StripStencil {
 public:
  /// The points split along each axis, and the strides of the block; both must live on.
  StripStencil(const std::array<const StripSplit<dim>*, dim>& splits,
               const std::array<int, dim>& stride)
      : splits_(splits), stride_(stride) {
    for (int a = 0; a < dim; ++a) {
      first_ += (a == 0 ? 1 : stride[a]) * splits[a]->first;
      mixed_ |= splits[a]->is_mixed ? 1 << a : 0;
      by_strips_ = by_strips_ && splits[a]->by_strips;
    }
  }

  /// Whole rows are loaded: up to one place before the block and one behind it.
  void interpolate(const double* block, StripValues<dim>& values) const {
    if (!by_strips_) {
      for (int i = 0; i < tile_width<dim>; ++i)
        values[i] = single<dim - 1>(block + place_of(i), i);
      return;
    }
    with_mixed_axes([&](auto mixed) { values = between<dim - 1, mixed>(block + first_); });
  }
  /// The range of the samples.
  void find_range(const double* block, StripValues<dim>& low, StripValues<dim>& high) const {
    if (by_strips_) {
      with_mixed_axes([&](auto mixed) {
        const Range found = range<dim - 1, mixed>(block + first_);
        low = found.low;
        high = found.high;
      });
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
    StripValues<dim> low, high;
  };

  /// Calls f with bit a of a constant set where axis a is mixed.
  template <typename Function>
  [[gnu::always_inline]] void with_mixed_axes(const Function& f) const {
    switch (mixed_) {
      case 0:
        return f(std::integral_constant<int, 0>());
      case 1:
        return f(std::integral_constant<int, 1>());
      case 2:
        return f(std::integral_constant<int, 2>());
      case 3:
        return f(std::integral_constant<int, 3>());
    }
    if constexpr (dim == 3) {
      switch (mixed_) {
        case 4:
          return f(std::integral_constant<int, 4>());
        case 5:
          return f(std::integral_constant<int, 5>());
        case 6:
          return f(std::integral_constant<int, 6>());
        default:
          return f(std::integral_constant<int, 7>());
      }
    }
  }
  /// Place of the lowest sample of a point.
  int place_of(int i) const {
    double place = splits_[0]->below[i];
    for (int a = 1; a < dim; ++a)
      place += stride_[a] * splits_[a]->below[i];
    return static_cast<int>(place);
  }
  /// Offset from the lowest sample of a point to sample k; bit a of k: upper along axis a.
  int corner(int k) const {
    int step = 0;
    for (int a = 0; a < dim; ++a)
      step += ((k >> a) & 1) * stride_[a];
    return step;
  }

  static StripValues<dim> row_at(const double* c) { return Eigen::Map<const StripValues<dim>>(c); }

  /// Interpolates along the axes up to this one, from the lowest samples of the strip. Of three
  /// samples along a mixed axis all points use the second; those ahead use the third, others the
  /// first.
  template <int axis, int mixed>
  [[gnu::always_inline]] StripValues<dim> between(const double* c) const {
    if constexpr (axis < 0) {
      return row_at(c);
    } else {
      const int step = axis == 0 ? 1 : stride_[axis];
      const StripValues<dim> lower = between<axis - 1, mixed>(c);
      const StripValues<dim> upper = between<axis - 1, mixed>(c + step);
      if constexpr ((mixed >> axis & 1) == 0)
        return blend<StripValues<dim>>(lower, upper, splits_[axis]->weight);
      const StripValues<dim> last = between<axis - 1, mixed>(c + 2 * step);
      return blend<StripValues<dim>>(upper, chosen(splits_[axis]->is_ahead, last, lower),
                                     splits_[axis]->weight_of_other);
    }
  }
  /// Computes the range of the samples, likewise.
  template <int axis, int mixed>
  [[gnu::always_inline]] Range range(const double* c) const {
    if constexpr (axis < 0) {
      return {row_at(c), row_at(c)};
    } else {
      const int step = axis == 0 ? 1 : stride_[axis];
      const Range lower = range<axis - 1, mixed>(c), upper = range<axis - 1, mixed>(c + step);
      if constexpr ((mixed >> axis & 1) == 0)
        return {least(lower.low, upper.low), most(lower.high, upper.high)};
      const Range last = range<axis - 1, mixed>(c + 2 * step);
      const StripValues<dim>& is_ahead = splits_[axis]->is_ahead;
      return {least(upper.low, chosen(is_ahead, last.low, lower.low)),
              most(upper.high, chosen(is_ahead, last.high, lower.high))};
    }
  }
  /// Interpolates at point i of the strip alone.
  template <int axis>
  double single(const double* c, int i) const {
    if constexpr (axis < 0)
      return *c;
    else
      return blend(single<axis - 1>(c, i), single<axis - 1>(c + stride_[axis], i),
                   splits_[axis]->weight[i]);
  }

  const std::array<const StripSplit<dim>*, dim>& splits_;
  const std::array<int, dim>& stride_;
  int first_ = 0;          ///< place of the lowest sample of a point that is not ahead of others
  int mixed_ = 0;          ///< a bit for each axis
  bool by_strips_ = true;  ///< no: point by point
};

}  // namespace lockstep
