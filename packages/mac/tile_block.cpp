#include "mac/tile_block.hpp"

#include <algorithm>
#include <type_traits>

namespace lockstep {

namespace {

template <typename Values>
Values blend(const Values& a, const Values& b, const Values& weight) {
  return a + weight * (b - a);
}

/// The samples below a row of points along one axis, and the weights of those above.
template <int dim>
struct RowSplit {
  RowValues<dim> below, weight;
};

template <int dim>
RowSplit<dim> split(const RowValues<dim>& x, double offset) {
  RowSplit<dim> result;
  result.below = (x - offset).floor();
  result.weight = (x - offset) - result.below;
  return result;
}

/// The 2^dim samples around each point of a row.
template <int dim>
class RowStencil {
 public:
  /// The points split along each axis, and the strides of the block.
  RowStencil(const std::array<const RowSplit<dim>*, dim>& splits,
             const std::array<int, dim>& stride);

  void interpolate(const double* block, RowValues<dim>& values) const {
    if (in_step_)
      values = blended<RowValues<dim>>(block + first_at(0), [&](int a) { return weight(a); });
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
  int first_at(int i) const { return static_cast<int>(first_[i]); }
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
    const Values w0 = weight(0), w1 = weight(1);
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

  std::array<const RowSplit<dim>*, dim> splits_;
  std::array<int, dim> stride_;
  RowValues<dim> first_;  ///< place of the lowest sample of each point
  /// The points keep step with the samples: neighbours in the row look at neighbours in memory, so
  /// that whole rows can be loaded at once.
  bool in_step_;
};

template <int dim>
RowStencil<dim>::RowStencil(const std::array<const RowSplit<dim>*, dim>& splits,
                            const std::array<int, dim>& stride)
    : splits_(splits), stride_(stride), first_(splits[0]->below) {
  for (int a = 1; a < dim; ++a)
    first_ += stride[a] * splits[a]->below;
  const RowValues<dim> steps = RowValues<dim>::LinSpaced(0, tile_width<dim> - 1);
  in_step_ = (first_ - first_[0] - steps).abs().maxCoeff() == 0;
}

}  // namespace

template <int dim>
TileBlock<dim>::TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer,
                          int reach)
    : lattice_(lattice), tracer_(tracer), reach_(reach), width_(tile_width<dim> + 2 * reach + 2) {
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
    begin_[a] = tile_begin[a] - reach_ - 1;
    // Whatever the velocity is where there is no fluid, no ray may look outside the block.
    lower_[a] = 0.5;
    upper_[a] = width_ - 1.5;
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
void TileBlock<dim>::clamp(RowPoints<dim>& points) const {
  // In this order, what is not a number goes to the lower limit.
  for (int a = 0; a < dim; ++a)
    points[a] = RowValues<dim>::Constant(lower_[a]).max(points[a]).min(upper_[a]);
}

template <int dim>
RowRays<dim> TileBlock<dim>::trace(const Index<dim>& in_tile, double direction) const {
  const double factor = direction * tracer_.cells_per_velocity();
  const Point<dim> offset = sample_offset<dim>(kind_);
  int place = 0;
  RowPoints<dim> start, middle;
  for (int a = 0; a < dim; ++a) {
    const int first = reach_ + 1 + (a == 0 ? 0 : in_tile[a]);
    start[a] = RowValues<dim>::Constant(first + offset[a]);
    place += first * stride_[a];
  }
  start[0] += RowValues<dim>::LinSpaced(0, tile_width<dim> - 1);
  for (int a = 0; a < dim; ++a)
    middle[a] = start[a] + 0.5 * factor * velocity_at_samples(a, place);
  clamp(middle);

  std::array<RowSplit<dim>, dim> on_faces, at_centers;
  for (int a = 0; a < dim; ++a) {
    on_faces[a] = split<dim>(middle[a], 0);
    at_centers[a] = split<dim>(middle[a], 0.5);
  }
  RowRays<dim> rays;
  for (int a = 0; a < dim; ++a) {
    std::array<const RowSplit<dim>*, dim> splits;
    for (int b = 0; b < dim; ++b)
      splits[b] = a == b ? &on_faces[b] : &at_centers[b];
    RowStencil<dim>(splits, stride_).interpolate(velocity_[a].data(), rays.end[a]);
    rays.end[a] = start[a] + factor * rays.end[a];
  }
  const RowPoints<dim> wanted = rays.end;
  clamp(rays.end);
  rays.clipped.setZero();
  for (int a = 0; a < dim; ++a)
    rays.clipped += (rays.end[a] - wanted[a]).abs();
  return rays;
}

template <int dim>
void TileBlock<dim>::look_up(const RowPoints<dim>& points, RowValues<dim>& values,
                             RowValues<dim>* low, RowValues<dim>* high) const {
  std::array<RowSplit<dim>, dim> along;
  std::array<const RowSplit<dim>*, dim> splits;
  for (int a = 0; a < dim; ++a) {
    along[a] = split<dim>(points[a], a == kind_ ? 0 : 0.5);
    splits[a] = &along[a];
  }
  const RowStencil<dim> stencil(splits, stride_);
  stencil.interpolate(field_.data(), values);
  if (low)
    stencil.find_range(field_.data(), *low, *high);
}

template class TileBlock<2>;
template class TileBlock<3>;

}  // namespace lockstep
