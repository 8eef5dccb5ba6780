#include "mac/field_carrier.hpp"

#include <algorithm>
#include <limits>

namespace lockstep {

namespace {

/// Cells along each axis of the blocks that are told apart in tiles near surfaces.
constexpr int log_block_width = 2;

/// Calls f(row within the tile, id of its first sample) for the rows of a tile that have samples.
template <int dim, typename Function>
void for_each_row(const TransportFrame<dim>& frame, SampleKind kind, int tile, const Function& f) {
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

}  // namespace

template <int dim>
bool FieldCarrier<dim>::is_carried(SampleKind kind, int id, bool& has_value) const {
  const MacState<dim>& state = frame_.setting.state;
  if (kind == cell_centers) {
    has_value = state.cells[id] == CellState::fluid;
    return has_value;
  }
  const FaceState face = state.faces[kind][id];
  has_value = face != FaceState::inactive;
  return face == FaceState::free || face == FaceState::coupled;
}

template <int dim>
void FieldCarrier<dim>::carry(std::vector<Passenger<dim>>& passengers) {
  for (Passenger<dim>& passenger : passengers)
    begin(passenger);
  for (int tile = 0; tile < frame_.setting.grid.n_owned_tiles(); ++tile) {
    if (frame_.paths[tile] == TilePath::rows && carry_rows(passengers, tile))
      continue;
    for (Passenger<dim>& passenger : passengers)
      if (frame_.paths[tile] == TilePath::surface)
        carry_surface_tile(passenger, tile);
      else
        carry_singles(passenger, tile);
  }
  for (Passenger<dim>& passenger : passengers)
    if (passenger.corrects())
      correct(passenger);
}

template <int dim>
void FieldCarrier<dim>::begin(Passenger<dim>& passenger) {
  passenger.field.values = frame_.setting.halo.fetch(*passenger.start, passenger.storage).data();
  *passenger.result = *passenger.start;
  if (passenger.corrects()) {
    passenger.low.assign(frame_.setting.grid.n_owned_cells(), 1);
    passenger.high.assign(frame_.setting.grid.n_owned_cells(), 0);
  }
}

template <int dim>
bool FieldCarrier<dim>::carry_rows(std::vector<Passenger<dim>>& passengers, int tile) {
  TileBlock<dim>& block = *frame_.block;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  for (Passenger<dim>& passenger : passengers) {
    const SampleKind kind = passenger.field.kind;
    const int length = row_length(frame_, kind, tile);
    block.load(kind, passenger.field.values);
    for_each_row(frame_, kind, tile, [&](const Index<dim>& row, int first) {
      RowValues<dim> values, low, high;
      const RowRays<dim> rays = block.trace(block.row(kind, row), -1);
      block.look_up(rays.end, values);
      if (passenger.corrects())
        block.look_up_range(rays.end, low, high);
      for (int i = 0, id = first; i < length; ++i, ++id) {
        bool has_value;
        if (!is_carried(kind, id, has_value)) {
          (*passenger.invalid)[id] = !has_value;
          continue;
        }
        (*passenger.result)[id] = values[i];
        if (passenger.corrects() && !rays.clipped[i]) {
          passenger.low[id] = low[i];
          passenger.high[id] = high[i];
        }
      }
    });
  }
  return true;
}

template <int dim>
void FieldCarrier<dim>::carry_singles(Passenger<dim>& passenger, int tile) {
  frame_.for_each_sample(passenger.field.kind, tile,
                         [&](int id, const Point<dim>& x) { carry_single(passenger, id, x); });
}

template <int dim>
void FieldCarrier<dim>::carry_single(Passenger<dim>& passenger, int id, const Point<dim>& x) {
  const SampleKind kind = passenger.field.kind;
  bool has_value;
  if (!is_carried(kind, id, has_value)) {
    (*passenger.invalid)[id] = !has_value;
    return;
  }
  const Ray<dim> ray = frame_.tracer->trace(x, -1);
  if (ray.complete && ray.inflow_axis >= 0) {
    (*passenger.result)[id] = passenger.field.inflow(ray);
    return;
  }
  const Stencil<dim> stencil = frame_.lattice->locate(kind, ray.end);
  if (!ray.complete || !stencil.complete()) {
    carry_seeing(passenger, id, x);
    return;
  }
  const double* values = passenger.field.values;
  (*passenger.result)[id] = interpolate<dim>(stencil, values);
  if (!passenger.corrects() || ray.clipped)
    return;
  passenger.low[id] = std::numeric_limits<double>::infinity();
  passenger.high[id] = -passenger.low[id];
  for (const int i : stencil.id) {
    const double value = i < 0 ? 0 : values[i];
    passenger.low[id] = std::min(passenger.low[id], value);
    passenger.high[id] = std::max(passenger.high[id], value);
  }
}

template <int dim>
void FieldCarrier<dim>::carry_seeing(Passenger<dim>& passenger, int id, const Point<dim>& x) {
  if (const auto value = frame_.near_surface->carry(passenger.field, x))
    (*passenger.result)[id] = *value;
  else
    (*passenger.invalid)[id] = 1;
}

template <int dim>
void FieldCarrier<dim>::carry_with_care(Passenger<dim>& passenger, int id, const Point<dim>& x) {
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  const SampleKind kind = passenger.field.kind;
  bool has_value;
  const bool carried = is_carried(kind, id, has_value);
  if (carried && carry_open_part(passenger, id, x))
    return;
  if (!has_value || (carried && near_surface.swept(x))) {
    (*passenger.invalid)[id] = 1;
    return;
  }
  if (!carried)
    return;
  const Ray<dim> ray = frame_.tracer->trace(x, -1);
  Box<dim> points(x);
  points.extend(ray.middle).extend(ray.end);
  if (!ray.complete || !near_surface.clear(points, false)) {
    if (kind != cell_centers && near_surface.inside(x))
      (*passenger.invalid)[id] = 1;
    else
      carry_seeing(passenger, id, x);
    return;
  }
  carry_single(passenger, id, x);
  if (!passenger.corrects() || passenger.low[id] > passenger.high[id])
    return;
  const Ray<dim> forward = frame_.tracer->trace(x, 1);
  points.extend(forward.middle).extend(forward.end);
  if (!forward.complete || !near_surface.clear(points, true))
    passenger.low[id] = passenger.high[id] + 1;
}

template <int dim>
bool FieldCarrier<dim>::carry_open_part(Passenger<dim>& passenger, int id, const Point<dim>& x) {
  const SampleKind kind = passenger.field.kind;
  if (kind == cell_centers)
    return false;
  const auto& places = frame_.setting.state.open_centers[kind];
  const auto place = places.find(id);
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  if (place == places.end() || !(near_surface.inside(x) || near_surface.swept(x)))
    return false;
  const TiledGrid<dim>& grid = frame_.setting.grid;
  const Point<dim> shift = (place->second - grid.face_center(kind, id)) / grid.spacing();
  (*passenger.result)[id] =
      (*passenger.start)[id] + near_surface.change(passenger.field, x + shift);
  return true;
}

template <int dim>
void FieldCarrier<dim>::carry_surface_tile(Passenger<dim>& passenger, int tile) {
  constexpr int width = 1 << log_block_width;
  constexpr int log_n_along = log_tile_width<dim> - log_block_width;
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  const SampleKind kind = passenger.field.kind;
  for (int block = 0; block < 1 << (dim * log_n_along); ++block) {
    Index<dim> begin = frame_.setting.grid.tile_begin(tile), end;
    Box<dim> box;
    for (int a = 0; a < dim; ++a) {
      begin[a] += ((block >> (a * log_n_along)) & ((1 << log_n_along) - 1)) * width;
      end[a] = begin[a] + width;
      box.min()[a] = begin[a];
      box.max()[a] = end[a];
    }
    const bool near = near_surface.is_near(box);
    if (near)
      near_surface.enter(box);
    frame_.for_each_sample(kind, tile, begin, end, [&](int id, const Point<dim>& x) {
      if (near)
        carry_with_care(passenger, id, x);
      else
        carry_single(passenger, id, x);
    });
  }
}

template <int dim>
void FieldCarrier<dim>::correct(Passenger<dim>& passenger) {
  CellField storage;
  const double* carried = frame_.setting.halo.fetch(*passenger.result, storage).data();
  CellField corrected = *passenger.result;
  for (int tile = 0; tile < frame_.setting.grid.n_owned_tiles(); ++tile) {
    if (frame_.paths[tile] == TilePath::rows && correct_rows(passenger, carried, tile, corrected))
      continue;
    frame_.for_each_sample(passenger.field.kind, tile, [&](int id, const Point<dim>& x) {
      if (passenger.low[id] <= passenger.high[id])
        correct_single(passenger, carried, id, x, corrected);
    });
  }
  passenger.result->swap(corrected);
}

template <int dim>
bool FieldCarrier<dim>::correct_rows(Passenger<dim>& passenger, const double* carried, int tile,
                                     CellField& corrected) {
  TileBlock<dim>& block = *frame_.block;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  const SampleKind kind = passenger.field.kind;
  const int length = row_length(frame_, kind, tile);
  block.load(kind, carried);
  for_each_row(frame_, kind, tile, [&](const Index<dim>& row, int first) {
    RowValues<dim> returned;
    const RowRays<dim> rays = block.trace(block.row(kind, row), 1);
    block.look_up(rays.end, returned);
    for (int i = 0, id = first; i < length; ++i, ++id) {
      if (passenger.low[id] > passenger.high[id] || rays.clipped[i])
        continue;
      const double error = 0.5 * (returned[i] - (*passenger.start)[id]);
      corrected[id] =
          std::clamp((*passenger.result)[id] - error, passenger.low[id], passenger.high[id]);
    }
  });
  return true;
}

template <int dim>
void FieldCarrier<dim>::correct_single(const Passenger<dim>& passenger, const double* carried,
                                       int id, const Point<dim>& x, CellField& corrected) const {
  const Ray<dim> ray = frame_.tracer->trace(x, 1);
  if (!ray.complete || ray.clipped)
    return;
  const Stencil<dim> stencil = frame_.lattice->locate(passenger.field.kind, ray.end);
  if (!stencil.complete())
    return;
  const double error = 0.5 * (interpolate<dim>(stencil, carried) - (*passenger.start)[id]);
  corrected[id] =
      std::clamp((*passenger.result)[id] - error, passenger.low[id], passenger.high[id]);
}

template class FieldCarrier<2>;
template class FieldCarrier<3>;

}  // namespace lockstep
