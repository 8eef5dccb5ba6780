#pragma once
#include <algorithm>
#include <array>
#include <type_traits>

#include "transport/cubic_weights.hpp"
#include "transport/strip_stencil.hpp"

namespace lockstep {

/// The four samples around a row of points along one axis. Those before `first` and after `last` do
/// not exist: they count for nothing, and points are moved between those that do.
template <int dim>
struct StripCubicSplit {
  void set(const StripValues<dim>& x, int axis, double offset,
           const std::array<double, 2>& limits) {
    const auto [first, last] = limits;
    split.set(x.max(first + offset).min(last + offset), axis, offset);
    const StripValues<dim>& f = split.weight;
    StripValues<dim> share = (1 + f) / 3;
    share = (split.below + 2 <= last).select(share, 0);
    share = (split.below - 1 >= first).select(share, 1);
    weights = cubic_weights<StripValues<dim>>(f, share);
  }
  StripSplit<dim> split;
  std::array<StripValues<dim>, 4> weights;
};

/// The 4^dim samples around each point of a row.
template <int dim>
class StripCubic {
 public:
  StripCubic(const std::array<const StripCubicSplit<dim>*, dim>& splits,
             const std::array<int, dim>& stride)
      : splits_(splits), stride_(stride) {}

  void interpolate(const double* block, StripValues<dim>& values) const {
    std::array<const StripSplit<dim>*, dim> along;
    for (int a = 0; a < dim; ++a)
      along[a] = &splits_[a]->split;
    if (are_in_step(along))
      values = sum<StripValues<dim>>(
          block + first_at(0),
          [&](int a, int k) -> const StripValues<dim>& { return splits_[a]->weights[k]; });
    else
      for (int i = 0; i < tile_width<dim>; ++i)
        values[i] = sum<double>(block + first_at(i),
                                [&](int a, int k) { return splits_[a]->weights[k][i]; });
  }

 private:
  int first_at(int i) const {
    double first = 0;
    for (int a = 0; a < dim; ++a)
      first += stride_[a] * (splits_[a]->split.below[i] - 1);
    return static_cast<int>(first);
  }
  template <typename Values>
  struct Range {
    void add(const Values& value) {
      if constexpr (std::is_same_v<Values, double>) {
        low = std::min(low, value);
        high = std::max(high, value);
      } else {
        low = low.min(value);
        high = high.max(value);
      }
    }
    Values low, high;
  };
  template <typename Values, typename Weight>
  Values sum(const double* c, const Weight& weight) const {
    Range<Values> range{samples_at<Values>(c), samples_at<Values>(c)};
    const auto along_x = [&](const double* d) {
      const Values v0 = samples_at<Values>(d), v1 = samples_at<Values>(d + 1);
      const Values v2 = samples_at<Values>(d + 2), v3 = samples_at<Values>(d + 3);
      range.add(v0);
      range.add(v1);
      range.add(v2);
      range.add(v3);
      return Values(weight(0, 0) * v0 + weight(0, 1) * v1 + weight(0, 2) * v2 + weight(0, 3) * v3);
    };
    const auto in_plane = [&](const double* d) {
      Values total = weight(1, 0) * along_x(d);
      for (int k = 1; k < 4; ++k)
        total += weight(1, k) * along_x(d + k * stride_[1]);
      return total;
    };
    Values total = in_plane_sum<Values>(c, weight, in_plane);
    if constexpr (std::is_same_v<Values, double>)
      return std::clamp(total, range.low, range.high);
    else
      return total.max(range.low).min(range.high);
  }
  template <typename Values, typename Weight, typename Plane>
  Values in_plane_sum(const double* c, const Weight& weight, const Plane& in_plane) const {
    if constexpr (dim == 2) {
      return in_plane(c);
    } else {
      Values total = weight(2, 0) * in_plane(c);
      for (int k = 1; k < 4; ++k)
        total += weight(2, k) * in_plane(c + k * stride_[2]);
      return total;
    }
  }
  const std::array<const StripCubicSplit<dim>*, dim>& splits_;
  const std::array<int, dim>& stride_;
};

}  // namespace lockstep
