#include "mac/transport.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "mac/surface_transport.hpp"

namespace lockstep {

namespace {

/// How the samples of a tile are carried.
enum class TilePath : char {
  plain,    ///< all rays stay among stored tiles inside the domain, far from surfaces
  bounded,  ///< rays may leave the domain, wrap, or miss tiles
  surface   ///< a surface may be in the way
};

/// Cells along each axis of the blocks that are told apart in tiles near surfaces.
constexpr int block_width = 4;
constexpr double largest_sensible_displacement = 1e6;  // [cells]

template <int dim>
Point<dim> sample_position(const Index<dim>& cell, const Point<dim>& offset) {
  Point<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = cell[a] + offset[a];
  return x;
}

template <int dim>
Box<dim> cell_box(const Index<dim>& begin, const Index<dim>& end) {
  Box<dim> box;
  for (int a = 0; a < dim; ++a) {
    box.min()[a] = begin[a];
    box.max()[a] = end[a];
  }
  return box;
}

/// Calls f(id, coordinates) for the cells [begin, end) of a tile.
template <int dim, typename Function>
void for_each_in_tile(int tile, const Index<dim>& tile_begin, const Index<dim>& begin,
                      const Index<dim>& end, const Function& f) {
  constexpr int log_width = log_tile_width<dim>;
  for (int a = 0; a < dim; ++a)
    if (begin[a] >= end[a])
      return;
  Index<dim> cell = begin;
  while (true) {
    int row = tile * tile_volume<dim>;
    for (int a = 1; a < dim; ++a)
      row += (cell[a] - tile_begin[a]) << (log_width * a);
    for (cell[0] = begin[0]; cell[0] < end[0]; ++cell[0])
      f(row + cell[0] - tile_begin[0], cell);
    cell[0] = begin[0];
    int a = 1;
    while (a < dim && ++cell[a] == end[a]) {
      cell[a] = begin[a];
      ++a;
    }
    if (a == dim)
      return;
  }
}

}  // namespace

template <int dim>
struct Transport<dim>::Implementation {
  explicit Implementation(const TransportSetting<dim>& transport_setting);

  double find_largest_displacement() const;
  void mark_usable();
  void choose_paths();

  /// One call of advect_*: the field, and what MacCormack remembers of its first pass.
  struct Pass {
    CarriedField<dim> field;
    CellField storage;  ///< of field.values
    AdvectionScheme scheme;
    CellField* result = nullptr;
    std::vector<char>* invalid = nullptr;
    CellField low, high;  ///< range of the samples used; empty (low > high): not corrected

    bool corrects() const { return scheme == AdvectionScheme::maccormack; }
  };
  void carry(const CellField& field, Pass& pass);
  template <bool checked>
  void carry_sample(Pass& pass, int id, const Point<dim>& x);
  void carry_near_surface(Pass& pass, int id, const Point<dim>& x);
  void carry_surface_tile(Pass& pass, int tile);
  void correct(const CellField& field, Pass& pass);
  template <bool checked>
  void correct_sample(const Pass& pass, const CellField& field, const double* carried, int id,
                      const Point<dim>& x, CellField& corrected) const;
  void keep_range(Pass& pass, int id, const Stencil<dim>& stencil) const;

  bool carried(SampleKind kind, int id, bool& has_value) const;
  /// Calls f(id, position) for the samples of that kind of an owned tile, within [begin, end).
  template <typename Function>
  void for_each_sample(SampleKind kind, int tile, Index<dim> begin, Index<dim> end,
                       const Function& f) const;
  template <typename Function>
  void for_each_sample(SampleKind kind, int tile, const Function& f) const;

  const TransportSetting<dim> setting;
  double largest = 0;  ///< displacement along an axis [cells]
  FaceField<dim> velocity_storage;
  std::array<std::vector<char>, dim> usable_faces, usable_faces_storage;
  std::vector<char> usable_cells, usable_cells_storage;
  UsableSamples<dim> usable;
  InvalidSamples<dim> invalid;
  std::unique_ptr<SampleLattice<dim>> lattice;
  std::unique_ptr<RayTracer<dim>> tracer;
  std::unique_ptr<SurfaceTransport<dim>> near_surface;
  std::vector<TilePath> paths;  ///< of owned tiles
};

template <int dim>
Transport<dim>::Implementation::Implementation(const TransportSetting<dim>& transport_setting)
    : setting(transport_setting) {
  largest = find_largest_displacement();
  setting.halo.require(static_cast<int>(std::ceil(largest)) + 3);
  const TiledGrid<dim>& samples = setting.halo.sample_grid();
  lattice = std::make_unique<SampleLattice<dim>>(samples);

  std::array<const double*, dim> velocity;
  std::array<std::array<bool, 2>, dim> inflow;
  for (int a = 0; a < dim; ++a) {
    velocity[a] = setting.halo.fetch(setting.advection_velocity[a], velocity_storage[a]).data();
    inflow[a] = {setting.sides[a][0].inflow, setting.sides[a][1].inflow};
  }
  mark_usable();
  tracer = std::make_unique<RayTracer<dim>>(*lattice, inflow, velocity,
                                            setting.dt / setting.grid.spacing());
  near_surface = std::make_unique<SurfaceTransport<dim>>(samples, *lattice, *tracer, usable,
                                                         setting.surface, largest);
  choose_paths();
}

template <int dim>
double Transport<dim>::Implementation::find_largest_displacement() const {
  double fastest = 0;
  bool finite = true;
  for (int a = 0; a < dim; ++a)
    setting.grid.for_each_owned_face(a, [&](int cell) {
      if (setting.state.faces[a][cell] == FaceState::inactive)
        return;
      const double speed = std::abs(setting.advection_velocity[a][cell]);
      finite = finite && std::isfinite(speed);
      fastest = std::max(fastest, speed);
    });
  double cells = fastest * setting.dt / setting.grid.spacing();
  if (!finite)
    cells = 2 * largest_sensible_displacement;
  cells = max_all(setting.grid.comm(), cells);
  check_solve(cells <= largest_sensible_displacement,
              "Advection: the velocity is not finite or carries the fluid over more than {} cells "
              "in one step of {} s; the run has become unstable: shorten the time step.",
              largest_sensible_displacement, setting.dt);
  return cells;
}

template <int dim>
void Transport<dim>::Implementation::mark_usable() {
  const int n = setting.grid.n_stored_cells();
  for (int a = 0; a < dim; ++a) {
    usable_faces[a].resize(n);
    invalid.faces[a].assign(n, 0);
    for (int i = 0; i < n; ++i)
      usable_faces[a][i] = setting.state.faces[a][i] != FaceState::inactive;
    usable.faces[a] = setting.halo.fetch(usable_faces[a], usable_faces_storage[a]).data();
  }
  usable_cells.resize(n);
  invalid.cells.assign(n, 0);
  for (int i = 0; i < n; ++i)
    usable_cells[i] = setting.state.cells[i] == CellState::fluid;
  usable.cells = setting.halo.fetch(usable_cells, usable_cells_storage).data();
}

template <int dim>
void Transport<dim>::Implementation::choose_paths() {
  const TiledGrid<dim>& grid = setting.grid;
  const int reach = static_cast<int>(std::ceil(largest)) + 2;
  paths.resize(grid.n_owned_tiles());
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    Index<dim> begin = grid.tile_begin(tile), end = begin;
    for (int& e : end)
      e += tile_width<dim>;
    if (near_surface->is_near(cell_box<dim>(begin, end))) {
      paths[tile] = TilePath::surface;
      continue;
    }
    for (int a = 0; a < dim; ++a) {
      begin[a] -= reach;
      end[a] += reach;
    }
    paths[tile] = lattice->stores(begin, end) ? TilePath::plain : TilePath::bounded;
  }
}

template <int dim>
template <typename Function>
void Transport<dim>::Implementation::for_each_sample(SampleKind kind, int tile, Index<dim> begin,
                                                     Index<dim> end, const Function& f) const {
  const GridDescription<dim>& description = setting.grid.description();
  for (int a = 0; a < dim; ++a)
    end[a] = std::min(
        end[a], description.n_cells[a] + (a == kind && description.store_upper_face[a] ? 1 : 0));
  const Point<dim> offset = sample_offset<dim>(kind);
  for_each_in_tile<dim>(
      tile, setting.grid.tile_begin(tile), begin, end,
      [&](int id, const Index<dim>& cell) { f(id, sample_position<dim>(cell, offset)); });
}

template <int dim>
template <typename Function>
void Transport<dim>::Implementation::for_each_sample(SampleKind kind, int tile,
                                                     const Function& f) const {
  const Index<dim> begin = setting.grid.tile_begin(tile);
  Index<dim> end = begin;
  for (int& e : end)
    e += tile_width<dim>;
  for_each_sample(kind, tile, begin, end, f);
}

template <int dim>
bool Transport<dim>::Implementation::carried(SampleKind kind, int id, bool& has_value) const {
  if (kind == cell_centers) {
    has_value = setting.state.cells[id] == CellState::fluid;
    return has_value;
  }
  const FaceState state = setting.state.faces[kind][id];
  has_value = state != FaceState::inactive;
  return state == FaceState::free || state == FaceState::coupled;
}

template <int dim>
void Transport<dim>::Implementation::keep_range(Pass& pass, int id,
                                                const Stencil<dim>& stencil) const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int i : stencil.id) {
    const double value = i < 0 ? 0 : pass.field.values[i];
    low = std::min(low, value);
    high = std::max(high, value);
  }
  pass.low[id] = low;
  pass.high[id] = high;
}

template <int dim>
template <bool checked>
void Transport<dim>::Implementation::carry_sample(Pass& pass, int id, const Point<dim>& x) {
  const Ray<dim> ray = tracer->template trace<checked>(x, -1);
  if (checked && ray.complete && ray.inflow_axis >= 0) {
    (*pass.result)[id] = pass.field.inflow(ray);
    return;
  }
  const Stencil<dim> stencil = lattice->template locate<checked>(pass.field.kind, ray.end);
  if (checked && (!ray.complete || !stencil.complete())) {
    carry_near_surface(pass, id, x);
    return;
  }
  (*pass.result)[id] = interpolate<dim, checked>(stencil, pass.field.values);
  if (pass.corrects() && !ray.clipped)
    keep_range(pass, id, stencil);
}

template <int dim>
void Transport<dim>::Implementation::carry_near_surface(Pass& pass, int id, const Point<dim>& x) {
  if (const auto value = near_surface->carry(pass.field, x))
    (*pass.result)[id] = *value;
  else
    (*pass.invalid)[id] = 1;
}

template <int dim>
void Transport<dim>::Implementation::carry_surface_tile(Pass& pass, int tile) {
  const SampleKind kind = pass.field.kind;
  const Index<dim> tile_begin = setting.grid.tile_begin(tile);
  constexpr int n_along = tile_width<dim> / block_width;
  const auto carry_checked = [&](int id, const Point<dim>& x) {
    bool has_value;
    if (carried(kind, id, has_value))
      carry_sample<true>(pass, id, x);
    else if (!has_value)
      (*pass.invalid)[id] = 1;
  };
  const auto carry_with_care = [&](int id, const Point<dim>& x) {
    bool has_value;
    const bool is_carried = carried(kind, id, has_value);
    if (!has_value || (is_carried && near_surface->swept(x))) {
      (*pass.invalid)[id] = 1;
      return;
    }
    if (!is_carried)
      return;
    const Ray<dim> ray = tracer->template trace<true>(x, -1);
    Box<dim> points(x);
    points.extend(ray.middle).extend(ray.end);
    if (ray.complete && near_surface->clear(points, false)) {
      carry_sample<true>(pass, id, x);
      if (pass.corrects() && pass.low[id] <= pass.high[id]) {
        const Ray<dim> forward = tracer->template trace<true>(x, 1);
        points.extend(forward.middle).extend(forward.end);
        if (!forward.complete || !near_surface->clear(points, true))
          pass.low[id] = pass.high[id] + 1;
      }
    } else if (kind != cell_centers && near_surface->inside(x)) {
      (*pass.invalid)[id] = 1;
    } else {
      carry_near_surface(pass, id, x);
    }
  };
  for (int block = 0; block < 1 << (dim * (log_tile_width<dim> - 2)); ++block) {
    Index<dim> begin = tile_begin, end;
    for (int a = 0, rest = block; a < dim; ++a) {
      begin[a] += rest % n_along * block_width;
      rest /= n_along;
      end[a] = begin[a] + block_width;
    }
    const Box<dim> box = cell_box<dim>(begin, end);
    if (near_surface->is_near(box)) {
      near_surface->enter(box);
      for_each_sample(kind, tile, begin, end, carry_with_care);
    } else {
      for_each_sample(kind, tile, begin, end, carry_checked);
    }
  }
}

template <int dim>
void Transport<dim>::Implementation::carry(const CellField& field, Pass& pass) {
  pass.field.values = setting.halo.fetch(field, pass.storage).data();
  *pass.result = field;
  if (pass.corrects()) {
    pass.low.assign(setting.grid.n_owned_cells(), 1);
    pass.high.assign(setting.grid.n_owned_cells(), 0);
  }
  const SampleKind kind = pass.field.kind;
  for (int tile = 0; tile < setting.grid.n_owned_tiles(); ++tile) {
    if (paths[tile] == TilePath::surface) {
      carry_surface_tile(pass, tile);
      continue;
    }
    const bool plain = paths[tile] == TilePath::plain;
    for_each_sample(kind, tile, [&](int id, const Point<dim>& x) {
      bool has_value;
      if (!carried(kind, id, has_value)) {
        if (!has_value)
          (*pass.invalid)[id] = 1;
      } else if (plain) {
        carry_sample<false>(pass, id, x);
      } else {
        carry_sample<true>(pass, id, x);
      }
    });
  }
  if (pass.corrects())
    correct(field, pass);
}

template <int dim>
template <bool checked>
void Transport<dim>::Implementation::correct_sample(const Pass& pass, const CellField& field,
                                                    const double* carried_values, int id,
                                                    const Point<dim>& x,
                                                    CellField& corrected) const {
  const Ray<dim> ray = tracer->template trace<checked>(x, 1);
  if (checked && (!ray.complete || ray.clipped))
    return;
  const Stencil<dim> stencil = lattice->template locate<checked>(pass.field.kind, ray.end);
  if (checked && !stencil.complete())
    return;
  const double returned = interpolate<dim, checked>(stencil, carried_values);
  corrected[id] =
      std::clamp((*pass.result)[id] + 0.5 * (field[id] - returned), pass.low[id], pass.high[id]);
}

template <int dim>
void Transport<dim>::Implementation::correct(const CellField& field, Pass& pass) {
  CellField storage;
  const double* carried_values = setting.halo.fetch(*pass.result, storage).data();
  CellField corrected = *pass.result;
  for (int tile = 0; tile < setting.grid.n_owned_tiles(); ++tile) {
    const bool plain = paths[tile] == TilePath::plain;
    for_each_sample(pass.field.kind, tile, [&](int id, const Point<dim>& x) {
      if (pass.low[id] > pass.high[id])
        return;
      if (plain)
        correct_sample<false>(pass, field, carried_values, id, x, corrected);
      else
        correct_sample<true>(pass, field, carried_values, id, x, corrected);
    });
  }
  pass.result->swap(corrected);
}

template <int dim>
Transport<dim>::Transport(const TransportSetting<dim>& setting)
    : implementation_(std::make_unique<Implementation>(setting)) {}
template <int dim>
Transport<dim>::~Transport() = default;

template <int dim>
void Transport<dim>::advect_faces(AdvectionScheme scheme, const FaceField<dim>& u,
                                  FaceField<dim>& result) {
  Implementation& own = *implementation_;
  for (int a = 0; a < dim; ++a) {
    typename Implementation::Pass pass;
    pass.scheme = scheme;
    pass.result = &result[a];
    pass.invalid = &own.invalid.faces[a];
    pass.field.kind = a;
    pass.field.inflow = [&own, a](const Ray<dim>& ray) {
      const Point<dim> place = own.setting.grid.lower() + own.setting.grid.spacing() * ray.end;
      return own.setting.sides[ray.inflow_axis][ray.inflow_side].velocity(place)[a];
    };
    own.carry(u[a], pass);
  }
}

template <int dim>
void Transport<dim>::advect_scalar(AdvectionScheme scheme, const CellField& s,
                                   const SideValues<dim>& inflow_values, CellField& result) {
  Implementation& own = *implementation_;
  typename Implementation::Pass pass;
  pass.scheme = scheme;
  pass.result = &result;
  pass.invalid = &own.invalid.cells;
  pass.field.kind = cell_centers;
  pass.field.inflow = [&](const Ray<dim>& ray) {
    return inflow_values[ray.inflow_axis][ray.inflow_side];
  };
  own.carry(s, pass);
}

template <int dim>
const InvalidSamples<dim>& Transport<dim>::invalid() const {
  return implementation_->invalid;
}

template <int dim>
double Transport<dim>::largest_displacement() const {
  return implementation_->largest;
}

template class Transport<2>;
template class Transport<3>;

}  // namespace lockstep
