#include "transport/tile_block.hpp"

#include <algorithm>

#include "transport/strip_cubic.hpp"
#include "transport/strip_stencil.hpp"

namespace lockstep {

namespace {

/// The points split along each axis, for samples at `offset` in their cells.
template <int dim>
struct SplitPoints {
  SplitPoints(const StripPoints<dim>& points, const Point<dim>& offset) {
    for (int a = 0; a < dim; ++a) {
      along[a].set(points[a], a, offset[a]);
      splits[a] = &along[a];
    }
  }
  std::array<StripSplit<dim>, dim> along;
  std::array<const StripSplit<dim>*, dim> splits;
};

/// Places beyond the last sample of a strip move as the first does. Values stored there depend on
/// how far the halo reaches, and points in step and others are summed in ways that differ by
/// round-off: a restarted run, whose halos know no earlier steps, must sum as the straight one.
template <int dim>
void move_along(StripPoints<dim>& velocity, int n_in_row) {
  for (StripValues<dim>& component : velocity)
    component.tail(tile_width<dim> - n_in_row).setConstant(component[0]);
}

}  // namespace

template <int dim>
TileBlock<dim>::TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer,
                          int reach, int stencil_reach)
    : lattice_(lattice), tracer_(tracer), stencil_reach_(stencil_reach) {
  int size = 1;
  for (int a = 0; a < dim; ++a) {
    const int margin = reach + stencil_reach;
    margin_[a] = a == 0 ? (margin + 3) / 4 * 4 : margin;
    width_[a] = tile_width<dim> + 2 * margin_[a];
    stride_[a] = size;
    size *= width_[a];
  }
  for (Values& component : velocity_)
    component.resize(size + 2 * first_place);
  storage_.resize(size + 2 * first_place);
}

template <int dim>
bool TileBlock<dim>::enter(const Index<dim>& tile_begin) {
  for (int a = 0; a < dim; ++a) {
    begin_[a] = tile_begin[a] - margin_[a];
    // Places beyond the domain ask for no samples: they might be stored or not.
    const int samples_end = lattice_.n_cells()[a] + (lattice_.periodic(a) ? 0 : 1);
    const int n_samples = std::min(tile_width<dim>, samples_end - tile_begin[a]);
    if (a == 0)
      n_in_row_ = n_samples;
    for (int on_faces = 0; on_faces < 2; ++on_faces)
      runs_[a][on_faces] =
          lattice_.find_runs(a, on_faces == 1, begin_[a], n_samples + 2 * margin_[a]);
    // Whatever the velocity is where there is no fluid, no ray may look outside the block.
    // All places of the tile are inside, even if nothing moves: the margin is the stencil's then.
    lower_[a] = stencil_reach_ - 0.5;
    upper_[a] = width_[a] - stencil_reach_ - 1e-9;
    if (lattice_.periodic(a))
      continue;
    lower_[a] = std::max<double>(lower_[a], -begin_[a]);
    upper_[a] = std::min<double>(upper_[a], lattice_.n_cells()[a] - begin_[a]);
  }
  for (int a = 0; a < dim; ++a)
    if (!copy(a, tracer_.velocity()[a], velocity_[a]))
      return false;
  return true;
}

template <int dim>
bool TileBlock<dim>::copy(SampleKind kind, const double* from, Values& to) const {
  std::array<const Runs*, dim> runs;
  for (int a = 0; a < dim; ++a)
    runs[a] = &runs_[a][a == kind ? 1 : 0];
  return lattice_.copy_block(runs, stride_, from, to.data() + first_place);
}

template <int dim>
void TileBlock<dim>::load(SampleKind kind, const double* field) {
  kind_ = kind;
  offset_ = sample_offset<dim>(kind);
  if (kind != cell_centers && field == tracer_.velocity()[kind]) {
    field_ = velocity_[kind].data() + first_place;
    return;
  }
  // Complete, because the velocity is.
  copy(kind, field, storage_);
  field_ = storage_.data() + first_place;
}

template <int dim>
StripValues<dim> TileBlock<dim>::velocity_at_samples(int axis, int place) const {
  using Row = Eigen::Map<const StripValues<dim>>;
  const double* c = velocity_[axis].data() + first_place + place;
  // A sample lies at a face of the component, or half-way between two along one axis or two.
  if (axis == kind_)
    return Row(c);
  if (kind_ == cell_centers)
    return 0.5 * (Row(c) + Row(c + stride_[axis]));
  const int first = stride_[std::min(axis, kind_)], second = stride_[std::max(axis, kind_)];
  c -= stride_[kind_];
  // In pairs, so that constants stay exact.
  return 0.25 * ((Row(c) + Row(c + first)) + (Row(c + second) + Row(c + second + first)));
}

template <int dim>
std::array<double, 2> TileBlock<dim>::sample_limits(int axis, SampleKind kind) const {
  if (lattice_.periodic(axis))
    return {-1e300, 1e300};
  return {static_cast<double>(-begin_[axis]),
          static_cast<double>(lattice_.last_sample(axis, kind) - begin_[axis])};
}

template <int dim>
StripPoints<dim> TileBlock<dim>::velocity_at(const StripPoints<dim>& points, bool cubic) const {
  StripPoints<dim> velocity;
  const auto look_up = [&](auto stencil, const auto& on_faces, const auto& at_centers) {
    for (int a = 0; a < dim; ++a) {
      std::array<decltype(on_faces.data()), dim> splits;
      for (int b = 0; b < dim; ++b)
        splits[b] = a == b ? &on_faces[b] : &at_centers[b];
      stencil(splits).interpolate(velocity_[a].data() + first_place, velocity[a]);
    }
  };
  if (cubic) {
    std::array<StripCubicSplit<dim>, dim> on_faces, at_centers;
    for (int a = 0; a < dim; ++a) {
      on_faces[a].set(points[a], a, 0, sample_limits(a, a));
      at_centers[a].set(points[a], a, 0.5, sample_limits(a, cell_centers));
    }
    look_up([&](const auto& splits) { return StripCubic<dim>(splits, stride_); }, on_faces,
            at_centers);
  } else {
    std::array<StripSplit<dim>, dim> on_faces, at_centers;
    for (int a = 0; a < dim; ++a) {
      on_faces[a].set(points[a], a, 0);
      at_centers[a].set(points[a], a, 0.5);
    }
    look_up([&](const auto& splits) { return StripStencil<dim>(splits, stride_); }, on_faces,
            at_centers);
  }
  return velocity;
}

template <int dim>
StripRays<dim> TileBlock<dim>::trace(const Index<dim>& in_tile, double direction,
                                     bool cubic) const {
  const double factor = direction * tracer_.cells_per_velocity();
  int place = 0;
  StripPoints<dim> start;
  for (int a = 0; a < dim; ++a) {
    const int cell = margin_[a] + (a == 0 ? 0 : in_tile[a]);
    start[a].setConstant(cell + offset_[a]);
    place += cell * stride_[a];
  }
  start[0] += steps<dim>();
  StripPoints<dim> velocity;
  if (cubic) {
    velocity = velocity_at(start, true);
  } else {
    for (int a = 0; a < dim; ++a)
      velocity[a] = velocity_at_samples(a, place);
  }
  move_along<dim>(velocity, n_in_row_);
  return rays_from(start, velocity, factor, n_in_row_, cubic);
}

template <int dim>
StripRays<dim> TileBlock<dim>::follow(const StripPoints<dim>& start, double direction) const {
  return rays_from(start, velocity_at(start, false), direction * tracer_.cells_per_velocity(),
                   tile_width<dim>, false);
}

template <int dim>
StripRays<dim> TileBlock<dim>::rays_from(const StripPoints<dim>& start,
                                         const StripPoints<dim>& velocity, double factor,
                                         int n_in_row, bool cubic) const {
  StripRays<dim> rays;
  for (int a = 0; a < dim; ++a)
    rays.middle[a] =
        clamped(StripValues<dim>(start[a] + 0.5 * factor * velocity[a]), lower_[a], upper_[a]);
  StripPoints<dim> halfway = velocity_at(rays.middle, cubic);
  move_along<dim>(halfway, n_in_row);
  rays.clipped.setZero();
  for (int a = 0; a < dim; ++a) {
    const StripValues<dim> wanted = start[a] + factor * halfway[a];
    rays.end[a] = clamped(wanted, lower_[a], upper_[a]);
    rays.clipped += (rays.end[a] - wanted).abs();
  }
  return rays;
}

template <int dim>
void TileBlock<dim>::look_up(const StripPoints<dim>& points, StripValues<dim>& values) const {
  const SplitPoints<dim> split(points, offset_);
  StripStencil<dim>(split.splits, stride_).interpolate(field_, values);
}

template <int dim>
void TileBlock<dim>::look_up(const StripPoints<dim>& points, StripValues<dim>& values,
                             StripValues<dim>& low, StripValues<dim>& high) const {
  const SplitPoints<dim> split(points, offset_);
  const StripStencil<dim> stencil(split.splits, stride_);
  stencil.interpolate(field_, values);
  stencil.find_range(field_, low, high);
}

template <int dim>
void TileBlock<dim>::look_up_cubic(const StripPoints<dim>& points, StripValues<dim>& values) const {
  std::array<StripCubicSplit<dim>, dim> along;
  std::array<const StripCubicSplit<dim>*, dim> splits;
  for (int a = 0; a < dim; ++a) {
    along[a].set(points[a], a, offset_[a], sample_limits(a, kind_));
    splits[a] = &along[a];
  }
  StripCubic<dim>(splits, stride_).interpolate(field_, values);
}

template class TileBlock<2>;
template class TileBlock<3>;

}  // namespace lockstep
