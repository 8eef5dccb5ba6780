#include "transport/field_advection.hpp"

#include <algorithm>
#include <limits>

namespace lockstep {

namespace {

/// Calls f(row within the tile, id of its first sample) for the rows of a tile that have samples.
template <int dim, typename Function>
void for_each_strip(const TransportFrame<dim>& frame, SampleKind kind, int tile,
                    const Function& f) {
  constexpr int width = tile_width<dim>;
  const Index<dim>& tile_begin = frame.setting.grid.tile_begin(tile);
  for (int first = 0; first < tile_volume<dim>; first += width) {
    Index<dim> row{};
    bool exists = true;
    for (int a = 1, rest = first / width; a < dim; ++a, rest /= width) {
      row[a] = rest % width;
      exists = exists && tile_begin[a] + row[a] < frame.samples_end(kind, a);
    }
    if (exists)
      f(row, tile * tile_volume<dim> + first);
  }
}

template <int dim>
int row_length(const TransportFrame<dim>& frame, SampleKind kind, int tile) {
  return std::min(tile_width<dim>,
                  frame.samples_end(kind, 0) - frame.setting.grid.tile_begin(tile)[0]);
}

template <int dim>
int row_in_tile(int id) {
  return (id & (tile_volume<dim> - 1)) / tile_width<dim>;
}

/// Returns the state at the centre of a cell, or `outside` if its state does not tell.
template <int dim>
CellState state_of_center(const GridState<dim>& state, int cell) {
  return state.has_cut_cells ? CellState::outside : state.cells[cell];
}

}  // namespace

template <int dim>
bool FieldAdvection<dim>::is_carried(SampleKind kind, int id, bool& has_value) const {
  const GridState<dim>& state = frame_.setting.state;
  if (kind == cell_centers) {
    has_value = state.cells[id] == CellState::fluid;
    return has_value;
  }
  const FaceState face = state.faces[kind][id];
  has_value = face != FaceState::inactive;
  return lockstep::is_carried(face);
}

/// Cells whose centres a solid holds are fluid only where surfaces leave faces open in part.
template <int dim>
bool FieldAdvection<dim>::may_hold_center(SampleKind kind, int id) const {
  return kind != cell_centers || state_of_center(frame_.setting.state, id) == CellState::outside;
}

template <int dim>
bool FieldAdvection<dim>::all_free(SampleKind kind, int first, int n) const {
  if (kind == cell_centers)
    return false;
  const FaceState* states = frame_.setting.state.faces[kind].data() + first;
  int others = 0;
  for (int i = 0; i < n; ++i)
    others += states[i] != FaceState::free && states[i] != FaceState::extended;
  return others == 0;
}

template <int dim>
void FieldAdvection<dim>::keep(AdvectedField<dim>& advected, int id, bool has_value) const {
  advected.carried()[id] = (*advected.start)[id];
  (*advected.invalid)[id] = !has_value;
  advected.forbid_correction(id);
}

template <int dim>
void FieldAdvection<dim>::advect(std::vector<AdvectedField<dim>>& fields,
                                 const std::vector<char>* tiles) {
  for (AdvectedField<dim>& advected : fields)
    begin(advected);
  if (fields.front().field.kind != cell_centers)
    for (AdvectedField<dim>& advected : fields)
      for (const AdvectedField<dim>& other : fields)
        advected.field.velocity[other.field.kind] = other.field.values;
  for (int tile = 0; tile < frame_.setting.grid.n_owned_tiles(); ++tile) {
    if (tiles != nullptr && !(*tiles)[tile])
      continue;
    const bool by_strips = frame_.plans[tile].by_strips && advect_strips(fields, tile);
    if (frame_.plans[tile].near_surface)
      advect_near_surfaces(fields, tile, by_strips);
    else if (!by_strips)
      for (AdvectedField<dim>& advected : fields)
        advect_samples(advected, tile);
  }
  if (fields.front().corrects())
    correct(fields);
}

template <int dim>
void FieldAdvection<dim>::begin(AdvectedField<dim>& advected) {
  advected.field.values =
      frame_.setting.halo.fetch(*advected.start, advected.storage, advected.beyond).data();
  advected.result->resize(advected.start->size());
  if (advected.corrects()) {
    advected.half_way.resize(advected.start->size());
    // Every value is set before it is used.
    advected.low = advected.result->data();
    advected.high.reset(new double[frame_.setting.grid.n_owned_cells()]);
  }
}

template <int dim>
bool FieldAdvection<dim>::advect_strips(std::vector<AdvectedField<dim>>& fields, int tile) {
  TileBlock<dim>& block = *frame_.block;
  const bool near_surface = frame_.plans[tile].near_surface;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  for (AdvectedField<dim>& advected : fields) {
    const SampleKind kind = advected.field.kind;
    const int length = row_length(frame_, kind, tile);
    CellField& carried = advected.carried();
    if (near_surface) {
      advected.back.resize(tile_volume<dim> / tile_width<dim>);
      advected.forth.resize(tile_volume<dim> / tile_width<dim>);
    }
    block.load(kind, advected.field.values);
    for_each_strip(frame_, kind, tile, [&](const Index<dim>& row, int first) {
      StripValues<dim> values, low, high;
      const StripRays<dim> rays = block.trace(row, -1, advected.cubic());
      if (advected.corrects()) {
        block.look_up(rays.end, values, low, high);
        const StripValues<dim> none_low = StripValues<dim>::Ones(),
                               none_high = StripValues<dim>::Zero();
        row_of<dim>(advected.low, first) = chosen(rays.clipped, none_low, low);
        row_of<dim>(advected.high.get(), first) = chosen(rays.clipped, none_high, high);
      } else if (advected.cubic()) {
        block.look_up_cubic(rays.end, values);
      } else {
        block.look_up(rays.end, values);
      }
      row_of<dim>(carried.data(), first) = values;
      if (near_surface) {
        advected.back[row_in_tile<dim>(first)] = rays;
        if (advected.corrects())
          advected.forth[row_in_tile<dim>(first)] = block.trace(row, 1);
      }
      if (all_free(kind, first, length))
        return;
      for (int id = first; id < first + length; ++id) {
        bool has_value;
        if (!is_carried(kind, id, has_value))
          keep(advected, id, has_value);
      }
    });
  }
  return true;
}

template <int dim>
void FieldAdvection<dim>::advect_samples(AdvectedField<dim>& advected, int tile) {
  frame_.for_each_sample(advected.field.kind, tile, [&](int id, const Point<dim>& x) {
    advect_sample(advected, id, x, advected.cubic());
  });
}

template <int dim>
void FieldAdvection<dim>::advect_sample(AdvectedField<dim>& advected, int id, const Point<dim>& x,
                                        bool wide) {
  const SampleKind kind = advected.field.kind;
  bool has_value;
  if (!is_carried(kind, id, has_value)) {
    keep(advected, id, has_value);
    return;
  }
  advected.forbid_correction(id);
  Ray<dim> ray = frame_.tracer->trace(x, -1, wide);
  if (ray.complete)
    frame_.tracer->mix_inflow(kind, ray, advected.field.inflow_depth);
  if (ray.complete && ray.inflow_share == 1 && !advected.field.enters) {
    advected.carried()[id] = advected.field.inflow(ray);
    return;
  }
  const Stencil<dim> stencil = frame_.lattice->locate(kind, ray.end);
  if (!ray.complete || !stencil.complete()) {
    advect_near_solid(advected, id, x);
    return;
  }
  const double* values = advected.field.values;
  double& carried = advected.carried()[id];
  if (wide && ray.inflow_share == 0) {
    const WideStencil<dim> cubic = frame_.lattice->locate_wide(kind, ray.end);
    if (cubic.complete()) {
      carried = interpolate<dim>(cubic, values);
      return;
    }
  }
  carried = interpolate<dim>(stencil, values);
  if (ray.inflow_axis >= 0)
    carried = advected.field.enters
                  ? advected.field.enters(ray, carried)
                  : carried + ray.inflow_share * (advected.field.inflow(ray) - carried);
  if (!advected.corrects() || ray.clipped || ray.inflow_share > 0)
    return;
  advected.low[id] = std::numeric_limits<double>::infinity();
  advected.high[id] = -advected.low[id];
  for (const int i : stencil.id) {
    const double value = i < 0 ? 0 : values[i];
    advected.low[id] = std::min(advected.low[id], value);
    advected.high[id] = std::max(advected.high[id], value);
  }
}

template <int dim>
void FieldAdvection<dim>::advect_near_solid(AdvectedField<dim>& advected, int id,
                                            const Point<dim>& x) {
  advected.forbid_correction(id);
  if (const auto value = frame_.near_surface->advect(advected.field, x))
    advected.carried()[id] = *value;
  else
    keep(advected, id, false);
}

template <int dim>
void FieldAdvection<dim>::advect_beside_solid(AdvectedField<dim>& advected, int id,
                                              const Point<dim>& x, bool by_strips) {
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  const SampleKind kind = advected.field.kind;
  bool has_value;
  const bool carried = is_carried(kind, id, has_value);
  if (carried && advect_open_part(advected, id, x))
    return;
  if (!carried || near_surface.swept(x)) {
    keep(advected, id, !carried && has_value);
    return;
  }
  const auto way = [&x](const Ray<dim>& ray) {
    return Box<dim>(x).extend(ray.middle).extend(ray.end);
  };
  if (advected.cubic()) {
    const Ray<dim> ray = trace(advected, id, x, -1, true, by_strips);
    if (ray.complete && near_surface.clear(way(ray), false, 2)) {
      if (!by_strips)
        advect_sample(advected, id, x, true);
      return;
    }
  }
  const Ray<dim> ray = trace(advected, id, x, -1, false, by_strips);
  Box<dim> points = way(ray);
  if (!ray.complete || !near_surface.clear(points, false)) {
    if (may_hold_center(kind, id) &&
        near_surface.inside(x, state_of_center(frame_.setting.state, id)))
      keep(advected, id, false);
    else if (by_strips && !advected.cubic() && near_surface.sees_all(kind, x, ray))
      advected.forbid_correction(id);
    else
      advect_near_solid(advected, id, x);
    return;
  }
  if (!by_strips || advected.cubic())
    advect_sample(advected, id, x, false);
  if (!advected.may_correct(id))
    return;
  const Ray<dim> forward = trace(advected, id, x, 1, false, by_strips);
  points.extend(forward.middle).extend(forward.end);
  if (!forward.complete || !near_surface.clear(points, true))
    advected.forbid_correction(id);
}

template <int dim>
Ray<dim> FieldAdvection<dim>::trace(const AdvectedField<dim>& advected, int id, const Point<dim>& x,
                                    double direction, bool cubic, bool by_strips) const {
  if (!by_strips || cubic != advected.cubic())
    return frame_.tracer->trace(x, direction, cubic);
  const auto& rows = direction < 0 ? advected.back : advected.forth;
  const StripRays<dim>& rays = rows[row_in_tile<dim>(id)];
  const int i = id & (tile_width<dim> - 1);
  Ray<dim> ray;
  ray.middle = frame_.block->place(rays.middle, i);
  ray.end = frame_.block->place(rays.end, i);
  return ray;
}

template <int dim>
bool FieldAdvection<dim>::is_far(const AdvectedField<dim>& advected, int id,
                                 const Point<dim>& x) const {
  const Ray<dim> back = trace(advected, id, x, -1, advected.cubic(), true);
  Box<dim> points = Box<dim>(x).extend(back.middle).extend(back.end);
  if (advected.corrects()) {
    const Ray<dim> forth = trace(advected, id, x, 1, false, true);
    points.extend(forth.middle).extend(forth.end);
  }
  return frame_.near_surface->clear(points, true, advected.cubic() ? 2 : 1);
}

template <int dim>
bool FieldAdvection<dim>::advect_open_part(AdvectedField<dim>& advected, int id,
                                           const Point<dim>& x) {
  const SampleKind kind = advected.field.kind;
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  if (kind == cell_centers || !near_surface.may_be_swept(x))
    return false;
  const auto& places = frame_.setting.state.open_centers[kind];
  const auto place = places.find(id);
  if (place == places.end() ||
      !(near_surface.inside(x, state_of_center(frame_.setting.state, id)) || near_surface.swept(x)))
    return false;
  const TiledGrid<dim>& grid = frame_.setting.grid;
  const Point<dim> shift = (place->second - grid.face_center(kind, id)) / grid.spacing();
  advected.carried()[id] =
      near_surface.advect_beside(advected.field, x + shift, (*advected.start)[id]);
  advected.forbid_correction(id);
  return true;
}

template <int dim>
void FieldAdvection<dim>::advect_near_surfaces(std::vector<AdvectedField<dim>>& fields, int tile,
                                               bool by_strips) {
  for (AdvectedField<dim>& advected : fields)
    frame_.for_each_sample(advected.field.kind, tile, [&](int id, const Point<dim>& x) {
      const bool near = frame_.near_surface->is_near(x);
      if (near && !(by_strips && is_far(advected, id, x)))
        advect_beside_solid(advected, id, x, by_strips);
      else if (!by_strips)
        advect_sample(advected, id, x, advected.cubic());
    });
}

template <int dim>
void FieldAdvection<dim>::correct(std::vector<AdvectedField<dim>>& fields) {
  const int n_tiles = frame_.setting.grid.n_owned_tiles();
  std::vector<const double*> carried;
  for (AdvectedField<dim>& advected : fields) {
    carried.push_back(
        frame_.setting.halo.fetch(advected.half_way, advected.storage, advected.beyond).data());
    advected.error.assign(advected.start->size(), 0);
  }
  for (int tile = 0; tile < n_tiles; ++tile) {
    if (frame_.plans[tile].by_strips && estimate_rows(fields, carried, tile))
      continue;
    for (std::size_t p = 0; p < fields.size(); ++p)
      frame_.for_each_sample(fields[p].field.kind, tile, [&](int id, const Point<dim>& x) {
        estimate_single(fields[p], carried[p], id, x);
      });
  }
  for (AdvectedField<dim>& advected : fields) {
    const double* error = frame_.setting.halo.fetch(advected.error, advected.storage, 0.0).data();
    for (int tile = 0; tile < n_tiles; ++tile)
      apply_smoothed(advected, error, tile);
  }
}

template <int dim>
bool FieldAdvection<dim>::estimate_rows(std::vector<AdvectedField<dim>>& fields,
                                        const std::vector<const double*>& carried, int tile) {
  TileBlock<dim>& block = *frame_.block;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  const StripValues<dim> zero = StripValues<dim>::Zero(), one = StripValues<dim>::Ones();
  for (std::size_t p = 0; p < fields.size(); ++p) {
    AdvectedField<dim>& advected = fields[p];
    block.load(advected.field.kind, carried[p]);
    for_each_strip(frame_, advected.field.kind, tile, [&](const Index<dim>& row, int first) {
      StripValues<dim> returned;
      const StripRays<dim> rays = block.trace(row, 1);
      block.look_up(rays.end, returned);
      const StripValues<dim> start = row_of<dim>(advected.start->data(), first);
      const StripValues<dim> low =
          chosen(rays.clipped, one, StripValues<dim>(row_of<dim>(advected.low, first)));
      const StripValues<dim> high =
          chosen(rays.clipped, zero, StripValues<dim>(row_of<dim>(advected.high.get(), first)));
      row_of<dim>(advected.low, first) = low;
      row_of<dim>(advected.high.get(), first) = high;
      row_of<dim>(advected.error.data(), first) =
          (low <= high).select(0.5 * (returned - start), zero);
    });
  }
  return true;
}

template <int dim>
void FieldAdvection<dim>::estimate_single(AdvectedField<dim>& advected, const double* carried,
                                          int id, const Point<dim>& x) const {
  if (!advected.may_correct(id))
    return;
  const Ray<dim> ray = frame_.tracer->trace(x, 1);
  const bool is_whole = ray.complete && !ray.clipped;
  const Stencil<dim> stencil = frame_.lattice->locate(advected.field.kind, is_whole ? ray.end : x);
  if (is_whole && stencil.complete())
    advected.error[id] = 0.5 * (interpolate<dim>(stencil, carried) - (*advected.start)[id]);
  else
    advected.forbid_correction(id);
}

template <int dim>
StripValues<dim> FieldAdvection<dim>::sum_beside(SampleKind kind, const double* error,
                                                 const Index<dim>& cell, int first) const {
  constexpr int width = tile_width<dim>;
  const auto beside = [&](int id, Index<dim> place, int axis, int step) {
    const int in_tile = (place[axis] & (width - 1)) + step;
    place[axis] += step;
    if (in_tile >= 0 && in_tile < width && place[axis] < frame_.samples_end(kind, axis))
      return id + (step << (log_tile_width<dim> * axis));
    Point<dim> x = sample_offset<dim>(kind);
    for (int a = 0; a < dim; ++a)
      x[a] += place[a];
    return frame_.lattice->locate(kind, x).id[0];
  };
  const auto error_at = [&](int id) { return id < 0 ? 0 : error[id]; };
  StripValues<dim> sum = StripValues<dim>::Zero();
  for (int axis = 1; axis < dim; ++axis)
    for (const int step : {-1, 1})
      if (const int id = beside(first, cell, axis, step); id >= 0)
        sum += row_of<dim>(error, id);
  const int last = std::min(width, frame_.samples_end(kind, 0) - cell[0]) - 1;
  Index<dim> last_cell = cell;
  last_cell[0] += last;
  std::array<double, width + 2> row;
  std::copy_n(error + first, width, row.begin() + 1);
  row[0] = error_at(beside(first, cell, 0, -1));
  row[last + 2] = error_at(beside(first + last, last_cell, 0, 1));
  for (int i = 0; i < width; ++i)
    sum[i] += row[i] + row[i + 2];
  return sum;
}

/// With a share of 1/24 for each sample beside, what is left of the dissipation of semi-Lagrangian
/// advection in space is |u| h^3/48 u'''', a quarter of that of third-order upwinding. Energy falls
/// then at all steps; without it, it grows.
template <int dim>
void FieldAdvection<dim>::apply_smoothed(AdvectedField<dim>& advected, const double* error,
                                         int tile) const {
  constexpr double share = 1. / 24;
  const SampleKind kind = advected.field.kind;
  for_each_strip(frame_, kind, tile, [&](const Index<dim>& row, int first) {
    Index<dim> cell = frame_.setting.grid.tile_begin(tile);
    for (int a = 1; a < dim; ++a)
      cell[a] += row[a];
    const StripValues<dim> own = row_of<dim>(error, first);
    const StripValues<dim> smoothed =
        own + share * (sum_beside(kind, error, cell, first) - 2 * dim * own);
    const StripValues<dim> half_way = row_of<dim>(advected.half_way.data(), first);
    const StripValues<dim> low = row_of<dim>(advected.low, first);
    const StripValues<dim> high = row_of<dim>(advected.high.get(), first);
    row_of<dim>(advected.result->data(), first) =
        within(StripValues<dim>(half_way - smoothed), low, high, half_way);
  });
}

template class FieldAdvection<2>;
template class FieldAdvection<3>;

}  // namespace lockstep
