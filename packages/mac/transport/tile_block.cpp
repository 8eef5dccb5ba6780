#include "mac/transport/tile_block.hpp"

#include <algorithm>
#include <type_traits>

#include "mac/transport/cubic_weights.hpp"

namespace lockstep {

namespace {

template <typename Values>
Values blend(const Values& a, const Values& b, const Values& weight) {
  return a + weight * (b - a);
}

/// 0, 1, 2, ...
template <int dim>
RowValues<dim> steps() {
  alignas(64) static constexpr double counted[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                   8, 9, 10, 11, 12, 13, 14, 15};
  static_assert(tile_width<dim> <= 16);
  return Eigen::Map<const RowValues<dim>>(counted);
}

/// The samples below a row of points along one axis, and the weights of those above.
template <int dim>
struct RowSplit {
  void set(const RowValues<dim>& x, int axis, double offset) {
    below = (x - offset).floor();
    weight = (x - offset) - below;
    strays = below - below[0];
    if (axis == 0)
      strays -= steps<dim>();
    strays = strays.abs();
  }
  RowValues<dim> below, weight;
  /// How far the points are from keeping step with the samples of their row, that is, from lying
  /// one sample further each along x and at the same one along other axes. Integers.
  RowValues<dim> strays;
};

/// The 2^dim samples around each point of a row.
template <int dim>
class RowStencil {
 public:
  /// The points split along each axis, and the strides of the block; both must live on.
  RowStencil(const std::array<const RowSplit<dim>*, dim>& splits,
             const std::array<int, dim>& stride)
      : splits_(splits), stride_(stride) {
    RowValues<dim> strays = splits[0]->strays;
    for (int a = 1; a < dim; ++a)
      strays += splits[a]->strays;
    in_step_ = strays.sum() == 0;
  }

  void interpolate(const double* block, RowValues<dim>& values) const {
    if (in_step_)
      values = blended<RowValues<dim>>(block + first_at(0),
                                       [&](int a) -> const RowValues<dim>& { return weight(a); });
    else
      for (int i = 0; i < tile_width<dim>; ++i)
        values[i] = blended<double>(block + first_at(i), [&](int a) { return weight(a)[i]; });
  }
  void find_range(const double* block, RowValues<dim>& low, RowValues<dim>& high) const {
    if (in_step_) {
      const double* c = block + first_at(0);
      low = high = at<RowValues<dim>>(c);
      for (int k = 1; k < 1 << dim; ++k) {
        low = low.min(at<RowValues<dim>>(c + corner(k)));
        high = high.max(at<RowValues<dim>>(c + corner(k)));
      }
    } else {
      for (int i = 0; i < tile_width<dim>; ++i) {
        const double* c = block + first_at(i);
        low[i] = high[i] = *c;
        for (int k = 1; k < 1 << dim; ++k) {
          low[i] = std::min(low[i], c[corner(k)]);
          high[i] = std::max(high[i], c[corner(k)]);
        }
      }
    }
  }

 private:
  const RowValues<dim>& weight(int axis) const { return splits_[axis]->weight; }
  int first_at(int i) const {
    double first = splits_[0]->below[i];
    for (int a = 1; a < dim; ++a)
      first += stride_[a] * splits_[a]->below[i];
    return static_cast<int>(first);
  }
  /// From the lowest sample of a point to sample k; bit a of k: upper along axis a.
  int corner(int k) const {
    int step = 0;
    for (int a = 0; a < dim; ++a)
      step += ((k >> a) & 1) * stride_[a];
    return step;
  }
  /// One sample, or those of a whole row that is in step.
  template <typename Values>
  static Values at(const double* c) {
    if constexpr (std::is_same_v<Values, double>)
      return *c;
    else
      return Eigen::Map<const Values>(c);
  }
  template <typename Values, typename Weight>
  Values blended(const double* c, const Weight& weight) const {
    const int up = stride_[1];
    const auto &w0 = weight(0), &w1 = weight(1);
    const auto in_plane = [&](const double* d) {
      const Values lower = blend<Values>(at<Values>(d), at<Values>(d + 1), w0);
      const Values upper = blend<Values>(at<Values>(d + up), at<Values>(d + up + 1), w0);
      return blend<Values>(lower, upper, w1);
    };
    if constexpr (dim == 2)
      return in_plane(c);
    else
      return blend<Values>(in_plane(c), in_plane(c + stride_[2]), weight(2));
  }

  const std::array<const RowSplit<dim>*, dim>& splits_;
  const std::array<int, dim>& stride_;
  /// Neighbours in the row look at neighbours in memory: whole rows can be loaded at once.
  bool in_step_;
};

/// The four samples around a row of points along one axis. Those before `first` and after `last` do
/// not exist: they count for nothing, and points are moved between those that do.
template <int dim>
struct RowCubicSplit {
  void set(const RowValues<dim>& x, int axis, double offset, const std::array<double, 2>& limits) {
    const auto [first, last] = limits;
    split.set(x.max(first + offset).min(last + offset), axis, offset);
    const RowValues<dim>& f = split.weight;
    RowValues<dim> share = (1 + f) / 3;
    share = (split.below + 2 <= last).select(share, 0);
    share = (split.below - 1 >= first).select(share, 1);
    weights = cubic_weights<RowValues<dim>>(f, share);
  }
  RowSplit<dim> split;
  std::array<RowValues<dim>, 4> weights;
};

/// The 4^dim samples around each point of a row.
template <int dim>
class RowCubic {
 public:
  RowCubic(const std::array<const RowCubicSplit<dim>*, dim>& splits,
           const std::array<int, dim>& stride)
      : splits_(splits), stride_(stride) {}

  void interpolate(const double* block, RowValues<dim>& values) const {
    RowValues<dim> strays = splits_[0]->split.strays;
    for (int a = 1; a < dim; ++a)
      strays += splits_[a]->split.strays;
    if (strays.sum() == 0)
      values = sum<RowValues<dim>>(block + first_at(0), [&](int a, int k) -> const RowValues<dim>& {
        return splits_[a]->weights[k];
      });
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
    Range<Values> range{at<Values>(c), at<Values>(c)};
    const auto along_x = [&](const double* d) {
      const Values v0 = at<Values>(d), v1 = at<Values>(d + 1);
      const Values v2 = at<Values>(d + 2), v3 = at<Values>(d + 3);
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
  template <typename Values>
  static Values at(const double* c) {
    if constexpr (std::is_same_v<Values, double>)
      return *c;
    else
      return Eigen::Map<const Values>(c);
  }

  const std::array<const RowCubicSplit<dim>*, dim>& splits_;
  const std::array<int, dim>& stride_;
};

}  // namespace

template <int dim>
TileBlock<dim>::TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer,
                          int reach, int stencil_reach)
    : lattice_(lattice),
      tracer_(tracer),
      margin_(reach + stencil_reach),
      width_(tile_width<dim> + 2 * margin_),
      stencil_reach_(stencil_reach) {
  int size = 1;
  for (int a = 0; a < dim; ++a) {
    stride_[a] = size;
    size *= width_;
  }
  for (auto& component : velocity_)
    component.resize(size);
  field_.resize(size);
}

template <int dim>
bool TileBlock<dim>::enter(const Index<dim>& tile_begin) {
  for (int a = 0; a < dim; ++a) {
    begin_[a] = tile_begin[a] - margin_;
    // Whatever the velocity is where there is no fluid, no ray may look outside the block.
    lower_[a] = stencil_reach_ - 0.5;
    upper_[a] = width_ - 0.5 - stencil_reach_;
    if (lattice_.periodic(a))
      continue;
    lower_[a] = std::max<double>(lower_[a], -begin_[a]);
    upper_[a] = std::min<double>(upper_[a], lattice_.n_cells()[a] - begin_[a]);
  }
  for (int a = 0; a < dim; ++a)
    if (!lattice_.copy_block(a, begin_, width_, tracer_.velocity()[a], velocity_[a].data()))
      return false;
  return true;
}

template <int dim>
void TileBlock<dim>::load(SampleKind kind, const double* field) {
  kind_ = kind;
  offset_ = sample_offset<dim>(kind);
  // Complete, because the velocity is.
  lattice_.copy_block(kind, begin_, width_, field, field_.data());
}

template <int dim>
RowValues<dim> TileBlock<dim>::velocity_at_samples(int axis, int place) const {
  using Row = Eigen::Map<const RowValues<dim>>;
  const double* c = velocity_[axis].data() + place;
  // A sample lies at a face of the component, or half-way between two along one axis or two.
  if (axis == kind_)
    return Row(c);
  const RowValues<dim> half = RowValues<dim>::Constant(0.5);
  if (kind_ == cell_centers)
    return blend<RowValues<dim>>(Row(c), Row(c + stride_[axis]), half);
  const int first = stride_[std::min(axis, kind_)], second = stride_[std::max(axis, kind_)];
  c -= stride_[kind_];
  const RowValues<dim> lower = blend<RowValues<dim>>(Row(c), Row(c + first), half);
  const RowValues<dim> upper =
      blend<RowValues<dim>>(Row(c + second), Row(c + second + first), half);
  return blend<RowValues<dim>>(lower, upper, half);
}

template <int dim>
RowValues<dim> TileBlock<dim>::clamped(const RowValues<dim>& x, int axis) const {
  // In this order, what is not a number goes to the lower limit.
  return RowValues<dim>::Constant(lower_[axis]).max(x).min(upper_[axis]);
}

template <int dim>
std::array<double, 2> TileBlock<dim>::sample_limits(int axis, SampleKind kind) const {
  if (lattice_.periodic(axis))
    return {-1e300, 1e300};
  return {static_cast<double>(-begin_[axis]),
          static_cast<double>(lattice_.last_sample(axis, kind) - begin_[axis])};
}

template <int dim>
RowPoints<dim> TileBlock<dim>::velocity_at(const RowPoints<dim>& points, bool cubic) const {
  RowPoints<dim> velocity;
  const auto look_up = [&](auto stencil, const auto& on_faces, const auto& at_centers) {
    for (int a = 0; a < dim; ++a) {
      std::array<decltype(on_faces.data()), dim> splits;
      for (int b = 0; b < dim; ++b)
        splits[b] = a == b ? &on_faces[b] : &at_centers[b];
      stencil(splits).interpolate(velocity_[a].data(), velocity[a]);
    }
  };
  if (cubic) {
    std::array<RowCubicSplit<dim>, dim> on_faces, at_centers;
    for (int a = 0; a < dim; ++a) {
      on_faces[a].set(points[a], a, 0, sample_limits(a, a));
      at_centers[a].set(points[a], a, 0.5, sample_limits(a, cell_centers));
    }
    look_up([&](const auto& splits) { return RowCubic<dim>(splits, stride_); }, on_faces,
            at_centers);
  } else {
    std::array<RowSplit<dim>, dim> on_faces, at_centers;
    for (int a = 0; a < dim; ++a) {
      on_faces[a].set(points[a], a, 0);
      at_centers[a].set(points[a], a, 0.5);
    }
    look_up([&](const auto& splits) { return RowStencil<dim>(splits, stride_); }, on_faces,
            at_centers);
  }
  return velocity;
}

template <int dim>
RowRays<dim> TileBlock<dim>::trace(const Index<dim>& in_tile, double direction, bool cubic) const {
  const double factor = direction * tracer_.cells_per_velocity();
  int place = 0;
  RowPoints<dim> start, middle;
  for (int a = 0; a < dim; ++a) {
    const int cell = margin_ + (a == 0 ? 0 : in_tile[a]);
    start[a] = cell + offset_[a] + (a == 0 ? 1.0 : 0.0) * steps<dim>();
    place += cell * stride_[a];
  }
  RowPoints<dim> velocity;
  if (cubic) {
    velocity = velocity_at(start, true);
  } else {
    for (int a = 0; a < dim; ++a)
      velocity[a] = velocity_at_samples(a, place);
  }
  for (int a = 0; a < dim; ++a)
    middle[a] = clamped(start[a] + 0.5 * factor * velocity[a], a);
  velocity = velocity_at(middle, cubic);
  RowRays<dim> rays;
  rays.clipped.setZero();
  for (int a = 0; a < dim; ++a) {
    const RowValues<dim> wanted = start[a] + factor * velocity[a];
    rays.end[a] = clamped(wanted, a);
    rays.clipped += (rays.end[a] - wanted).abs();
  }
  return rays;
}

template <int dim>
void TileBlock<dim>::look_up(const RowPoints<dim>& points, RowValues<dim>& values,
                             RowValues<dim>* low, RowValues<dim>* high) const {
  std::array<RowSplit<dim>, dim> along;
  std::array<const RowSplit<dim>*, dim> splits;
  for (int a = 0; a < dim; ++a) {
    along[a].set(points[a], a, offset_[a]);
    splits[a] = &along[a];
  }
  const RowStencil<dim> stencil(splits, stride_);
  stencil.interpolate(field_.data(), values);
  if (low)
    stencil.find_range(field_.data(), *low, *high);
}

template <int dim>
void TileBlock<dim>::look_up_cubic(const RowPoints<dim>& points, RowValues<dim>& values) const {
  std::array<RowCubicSplit<dim>, dim> along;
  std::array<const RowCubicSplit<dim>*, dim> splits;
  for (int a = 0; a < dim; ++a) {
    along[a].set(points[a], a, offset_[a], sample_limits(a, kind_));
    splits[a] = &along[a];
  }
  RowCubic<dim>(splits, stride_).interpolate(field_.data(), values);
}

template class TileBlock<2>;
template class TileBlock<3>;

}  // namespace lockstep
