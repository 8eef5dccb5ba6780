#include "transport/field_carrier.hpp"

#include <algorithm>
#include <limits>

namespace lockstep {

namespace {

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
bool FieldCarrier<dim>::is_carried(SampleKind kind, int id, bool& has_value) const {
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
bool FieldCarrier<dim>::may_hold_center(SampleKind kind, int id) const {
  return kind != cell_centers || state_of_center(frame_.setting.state, id) == CellState::outside;
}

template <int dim>
bool FieldCarrier<dim>::all_free(SampleKind kind, int first, int n) const {
  if (kind == cell_centers)
    return false;
  const FaceState* states = frame_.setting.state.faces[kind].data() + first;
  int others = 0;
  for (int i = 0; i < n; ++i)
    others += states[i] != FaceState::free && states[i] != FaceState::extended;
  return others == 0;
}

template <int dim>
void FieldCarrier<dim>::keep(Passenger<dim>& passenger, int id, bool has_value) const {
  passenger.carried()[id] = (*passenger.start)[id];
  (*passenger.invalid)[id] = !has_value;
  passenger.forbid_correction(id);
}

template <int dim>
void FieldCarrier<dim>::carry(std::vector<Passenger<dim>>& passengers,
                              const std::vector<char>* tiles) {
  for (Passenger<dim>& passenger : passengers)
    begin(passenger);
  if (passengers.front().field.kind != cell_centers)
    for (Passenger<dim>& passenger : passengers)
      for (const Passenger<dim>& other : passengers)
        passenger.field.velocity[other.field.kind] = other.field.values;
  for (int tile = 0; tile < frame_.setting.grid.n_owned_tiles(); ++tile) {
    if (tiles != nullptr && !(*tiles)[tile])
      continue;
    const bool by_rows = frame_.plans[tile].by_rows && carry_rows(passengers, tile);
    if (frame_.plans[tile].near_surface)
      carry_near_surfaces(passengers, tile, by_rows);
    else if (!by_rows)
      for (Passenger<dim>& passenger : passengers)
        carry_singles(passenger, tile);
  }
  if (passengers.front().corrects())
    correct(passengers);
}

template <int dim>
void FieldCarrier<dim>::begin(Passenger<dim>& passenger) {
  passenger.field.values =
      frame_.setting.halo.fetch(*passenger.start, passenger.storage, passenger.beyond).data();
  passenger.result->resize(passenger.start->size());
  if (passenger.corrects()) {
    passenger.half_way.resize(passenger.start->size());
    // Every value is set before it is used.
    passenger.low = passenger.result->data();
    passenger.high.reset(new double[frame_.setting.grid.n_owned_cells()]);
  }
}

template <int dim>
bool FieldCarrier<dim>::carry_rows(std::vector<Passenger<dim>>& passengers, int tile) {
  TileBlock<dim>& block = *frame_.block;
  const bool near_surface = frame_.plans[tile].near_surface;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  for (Passenger<dim>& passenger : passengers) {
    const SampleKind kind = passenger.field.kind;
    const int length = row_length(frame_, kind, tile);
    CellField& carried = passenger.carried();
    if (near_surface) {
      passenger.back.resize(tile_volume<dim> / tile_width<dim>);
      passenger.forth.resize(tile_volume<dim> / tile_width<dim>);
    }
    block.load(kind, passenger.field.values);
    for_each_row(frame_, kind, tile, [&](const Index<dim>& row, int first) {
      RowValues<dim> values, low, high;
      const RowRays<dim> rays = block.trace(row, -1, passenger.cubic());
      if (passenger.corrects()) {
        block.look_up(rays.end, values, low, high);
        const RowValues<dim> none_low = RowValues<dim>::Ones(), none_high = RowValues<dim>::Zero();
        row_of<dim>(passenger.low, first) = chosen(rays.clipped, none_low, low);
        row_of<dim>(passenger.high.get(), first) = chosen(rays.clipped, none_high, high);
      } else if (passenger.cubic()) {
        block.look_up_cubic(rays.end, values);
      } else {
        block.look_up(rays.end, values);
      }
      row_of<dim>(carried.data(), first) = values;
      if (near_surface) {
        passenger.back[row_in_tile<dim>(first)] = rays;
        if (passenger.corrects())
          passenger.forth[row_in_tile<dim>(first)] = block.trace(row, 1);
      }
      if (all_free(kind, first, length))
        return;
      for (int id = first; id < first + length; ++id) {
        bool has_value;
        if (!is_carried(kind, id, has_value))
          keep(passenger, id, has_value);
      }
    });
  }
  return true;
}

template <int dim>
void FieldCarrier<dim>::carry_singles(Passenger<dim>& passenger, int tile) {
  frame_.for_each_sample(passenger.field.kind, tile, [&](int id, const Point<dim>& x) {
    carry_single(passenger, id, x, passenger.cubic());
  });
}

template <int dim>
void FieldCarrier<dim>::carry_single(Passenger<dim>& passenger, int id, const Point<dim>& x,
                                     bool wide) {
  const SampleKind kind = passenger.field.kind;
  bool has_value;
  if (!is_carried(kind, id, has_value)) {
    keep(passenger, id, has_value);
    return;
  }
  passenger.forbid_correction(id);
  Ray<dim> ray = frame_.tracer->trace(x, -1, wide);
  if (ray.complete)
    frame_.tracer->mix_inflow(kind, ray, passenger.field.inflow_depth);
  if (ray.complete && ray.inflow_share == 1 && !passenger.field.enters) {
    passenger.carried()[id] = passenger.field.inflow(ray);
    return;
  }
  const Stencil<dim> stencil = frame_.lattice->locate(kind, ray.end);
  if (!ray.complete || !stencil.complete()) {
    carry_seeing(passenger, id, x);
    return;
  }
  const double* values = passenger.field.values;
  double& carried = passenger.carried()[id];
  if (wide && ray.inflow_share == 0) {
    const WideStencil<dim> cubic = frame_.lattice->locate_wide(kind, ray.end);
    if (cubic.complete()) {
      carried = interpolate<dim>(cubic, values);
      return;
    }
  }
  carried = interpolate<dim>(stencil, values);
  if (ray.inflow_axis >= 0)
    carried = passenger.field.enters
                  ? passenger.field.enters(ray, carried)
                  : carried + ray.inflow_share * (passenger.field.inflow(ray) - carried);
  if (!passenger.corrects() || ray.clipped || ray.inflow_share > 0)
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
  passenger.forbid_correction(id);
  if (const auto value = frame_.near_surface->carry(passenger.field, x))
    passenger.carried()[id] = *value;
  else
    keep(passenger, id, false);
}

template <int dim>
void FieldCarrier<dim>::carry_with_care(Passenger<dim>& passenger, int id, const Point<dim>& x,
                                        bool by_rows) {
  SurfaceTransport<dim>& near_surface = *frame_.near_surface;
  const SampleKind kind = passenger.field.kind;
  bool has_value;
  const bool carried = is_carried(kind, id, has_value);
  if (carried && carry_open_part(passenger, id, x))
    return;
  if (!carried || near_surface.swept(x)) {
    keep(passenger, id, !carried && has_value);
    return;
  }
  const auto way = [&x](const Ray<dim>& ray) {
    return Box<dim>(x).extend(ray.middle).extend(ray.end);
  };
  if (passenger.cubic()) {
    const Ray<dim> ray = trace(passenger, id, x, -1, true, by_rows);
    if (ray.complete && near_surface.clear(way(ray), false, 2)) {
      if (!by_rows)
        carry_single(passenger, id, x, true);
      return;
    }
  }
  const Ray<dim> ray = trace(passenger, id, x, -1, false, by_rows);
  Box<dim> points = way(ray);
  if (!ray.complete || !near_surface.clear(points, false)) {
    if (may_hold_center(kind, id) &&
        near_surface.inside(x, state_of_center(frame_.setting.state, id)))
      keep(passenger, id, false);
    else if (by_rows && !passenger.cubic() && near_surface.sees_all(kind, x, ray))
      passenger.forbid_correction(id);
    else
      carry_seeing(passenger, id, x);
    return;
  }
  if (!by_rows || passenger.cubic())
    carry_single(passenger, id, x, false);
  if (!passenger.may_correct(id))
    return;
  const Ray<dim> forward = trace(passenger, id, x, 1, false, by_rows);
  points.extend(forward.middle).extend(forward.end);
  if (!forward.complete || !near_surface.clear(points, true))
    passenger.forbid_correction(id);
}

template <int dim>
Ray<dim> FieldCarrier<dim>::trace(const Passenger<dim>& passenger, int id, const Point<dim>& x,
                                  double direction, bool cubic, bool by_rows) const {
  if (!by_rows || cubic != passenger.cubic())
    return frame_.tracer->trace(x, direction, cubic);
  const auto& rows = direction < 0 ? passenger.back : passenger.forth;
  const RowRays<dim>& rays = rows[row_in_tile<dim>(id)];
  const int i = id & (tile_width<dim> - 1);
  Ray<dim> ray;
  ray.middle = frame_.block->place(rays.middle, i);
  ray.end = frame_.block->place(rays.end, i);
  return ray;
}

template <int dim>
bool FieldCarrier<dim>::is_far(const Passenger<dim>& passenger, int id, const Point<dim>& x) const {
  const Ray<dim> back = trace(passenger, id, x, -1, passenger.cubic(), true);
  Box<dim> points = Box<dim>(x).extend(back.middle).extend(back.end);
  if (passenger.corrects()) {
    const Ray<dim> forth = trace(passenger, id, x, 1, false, true);
    points.extend(forth.middle).extend(forth.end);
  }
  return frame_.near_surface->clear(points, true, passenger.cubic() ? 2 : 1);
}

template <int dim>
bool FieldCarrier<dim>::carry_open_part(Passenger<dim>& passenger, int id, const Point<dim>& x) {
  const SampleKind kind = passenger.field.kind;
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
  passenger.carried()[id] =
      near_surface.carry_beside(passenger.field, x + shift, (*passenger.start)[id]);
  passenger.forbid_correction(id);
  return true;
}

template <int dim>
void FieldCarrier<dim>::carry_near_surfaces(std::vector<Passenger<dim>>& passengers, int tile,
                                            bool by_rows) {
  for (Passenger<dim>& passenger : passengers)
    frame_.for_each_sample(passenger.field.kind, tile, [&](int id, const Point<dim>& x) {
      const bool near = frame_.near_surface->is_near(x);
      if (near && !(by_rows && is_far(passenger, id, x)))
        carry_with_care(passenger, id, x, by_rows);
      else if (!by_rows)
        carry_single(passenger, id, x, passenger.cubic());
    });
}

template <int dim>
void FieldCarrier<dim>::correct(std::vector<Passenger<dim>>& passengers) {
  std::vector<const double*> carried;
  for (Passenger<dim>& passenger : passengers)
    carried.push_back(
        frame_.setting.halo.fetch(passenger.half_way, passenger.storage, passenger.beyond).data());
  for (int tile = 0; tile < frame_.setting.grid.n_owned_tiles(); ++tile) {
    if (frame_.plans[tile].by_rows && correct_rows(passengers, carried, tile))
      continue;
    for (std::size_t p = 0; p < passengers.size(); ++p)
      frame_.for_each_sample(passengers[p].field.kind, tile, [&](int id, const Point<dim>& x) {
        correct_single(passengers[p], carried[p], id, x);
      });
  }
}

template <int dim>
bool FieldCarrier<dim>::correct_rows(std::vector<Passenger<dim>>& passengers,
                                     const std::vector<const double*>& carried, int tile) {
  TileBlock<dim>& block = *frame_.block;
  if (!block.enter(frame_.setting.grid.tile_begin(tile)))
    return false;
  for (std::size_t p = 0; p < passengers.size(); ++p) {
    Passenger<dim>& passenger = passengers[p];
    block.load(passenger.field.kind, carried[p]);
    for_each_row(frame_, passenger.field.kind, tile, [&](const Index<dim>& row, int first) {
      RowValues<dim> returned;
      const RowRays<dim> rays = block.trace(row, 1);
      block.look_up(rays.end, returned);
      const RowValues<dim> start = row_of<dim>(passenger.start->data(), first);
      const RowValues<dim> half_way = row_of<dim>(passenger.half_way.data(), first);
      const RowValues<dim> low = row_of<dim>(passenger.low, first);
      const RowValues<dim> high = row_of<dim>(passenger.high.get(), first);
      const RowValues<dim> corrected = half_way - 0.5 * (returned - start);
      row_of<dim>(passenger.result->data(), first) =
          chosen(rays.clipped, half_way, within(corrected, low, high, half_way));
    });
  }
  return true;
}

template <int dim>
void FieldCarrier<dim>::correct_single(Passenger<dim>& passenger, const double* carried, int id,
                                       const Point<dim>& x) const {
  const bool may_correct = passenger.may_correct(id);
  const double low = passenger.low[id];  // where the result goes
  double& result = (*passenger.result)[id];
  result = passenger.half_way[id];
  if (!may_correct)
    return;
  const Ray<dim> ray = frame_.tracer->trace(x, 1);
  if (!ray.complete || ray.clipped)
    return;
  const Stencil<dim> stencil = frame_.lattice->locate(passenger.field.kind, ray.end);
  if (!stencil.complete())
    return;
  const double error = 0.5 * (interpolate<dim>(stencil, carried) - (*passenger.start)[id]);
  result = std::clamp(result - error, low, passenger.high[id]);
}

template class FieldCarrier<2>;
template class FieldCarrier<3>;

}  // namespace lockstep
