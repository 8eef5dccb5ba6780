#include "transport/transport.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "transport/field_advection.hpp"

namespace lockstep {

namespace {

constexpr double largest_sensible_displacement = 1e6;  // [cells]
/// Largest distance from an inflow side at the end of a ray for which the side bounds a distance
/// function: beyond the samples beside which the surface comes to lie [cells].
constexpr double bounded_depth = 3;
/// Reynolds number of a cell and its slip up to which the fluid comes to rest at a surface within
/// the cell [1].
constexpr double resolved_reynolds_number = 4;

/// Along an axis, over all ranks, in cells.
template <int dim>
double find_largest_displacement(const TransportSetting<dim>& setting) {
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

}  // namespace

template <int dim>
struct Transport<dim>::Implementation {
  explicit Implementation(const TransportSetting<dim>& setting);

  void mark_usable();
  TilePlan make_plan(int tile) const;

  TransportFrame<dim> frame;
  FaceField<dim> velocity_storage;
  std::array<std::vector<char>, dim + 1> usable_samples, usable_storage;  ///< faces, cells
  UsableSamples<dim> usable;
};

template <int dim>
Transport<dim>::Implementation::Implementation(const TransportSetting<dim>& setting)
    : frame{setting, 0, {}, {}, {}, {}, {}, {}} {
  frame.largest_displacement = find_largest_displacement(setting);
  const int reach = static_cast<int>(std::ceil(frame.largest_displacement));
  const int stencil_reach = setting.stencil_reach;
  setting.halo.require(reach + 2 + stencil_reach);
  const TiledGrid<dim>& samples = setting.halo.sample_grid();
  frame.lattice = std::make_unique<SampleLattice<dim>>(samples, true);

  std::array<const double*, dim> velocity;
  std::array<std::array<bool, 2>, dim> inflow;
  for (int a = 0; a < dim; ++a) {
    velocity[a] =
        setting.halo.fetch(setting.advection_velocity[a], velocity_storage[a], 0.0).data();
    inflow[a] = {setting.sides[a][0].inflow, setting.sides[a][1].inflow};
  }
  mark_usable();
  frame.tracer = std::make_unique<RayTracer<dim>>(*frame.lattice, inflow, velocity,
                                                  setting.dt / setting.grid.spacing());
  const double friction_speed =
      resolved_reynolds_number * setting.kinematic_viscosity / setting.grid.spacing();
  frame.near_surface = std::make_unique<SurfaceTransport<dim>>(
      samples, *frame.tracer, usable, setting.surface, setting.kept,
      RayExtent{frame.largest_displacement, stencil_reach, friction_speed});
  if (reach <= TileBlock<dim>::longest_reach)
    frame.block =
        std::make_unique<TileBlock<dim>>(*frame.lattice, *frame.tracer, reach, stencil_reach);
  for (int tile = 0; tile < setting.grid.n_owned_tiles(); ++tile)
    frame.plans.push_back(make_plan(tile));
}

template <int dim>
void Transport<dim>::Implementation::mark_usable() {
  const TransportSetting<dim>& setting = frame.setting;
  const int n = setting.grid.n_stored_cells();
  for (auto& samples : usable_samples)
    samples.resize(n);
  for (int a = 0; a < dim; ++a) {
    frame.invalid.faces[a].assign(n, 0);
    for (int i = 0; i < n; ++i)
      usable_samples[a][i] = setting.state.faces[a][i] != FaceState::inactive;
    usable.faces[a] = setting.halo.fetch(usable_samples[a], usable_storage[a], '\1').data();
    usable.closed_below[a] = setting.sides[a][0].closed;
  }
  frame.invalid.cells.assign(n, 0);
  for (int i = 0; i < n; ++i)
    usable_samples[dim][i] = setting.state.cells[i] == CellState::fluid;
  usable.cells = setting.halo.fetch(usable_samples[dim], usable_storage[dim], '\1').data();
}

template <int dim>
TilePlan Transport<dim>::Implementation::make_plan(int tile) const {
  const TiledGrid<dim>& grid = frame.setting.grid;
  bool near_inflow = false;
  for (int a = 0; a < dim; ++a) {
    const double lower_gap = grid.tile_begin(tile)[a];
    const double upper_gap = grid.n_cells()[a] - (grid.tile_begin(tile)[a] + tile_width<dim>);
    const double reach = frame.largest_displacement + 1;
    near_inflow = near_inflow || (frame.tracer->flows_in(a, 0) && lower_gap < reach) ||
                  (frame.tracer->flows_in(a, 1) && upper_gap < reach);
  }
  return {frame.block && !near_inflow, frame.near_surface->is_near_tile(grid.tile_begin(tile))};
}

template <int dim>
Transport<dim>::Transport(const TransportSetting<dim>& setting)
    : implementation_(std::make_unique<Implementation>(setting)) {}
template <int dim>
Transport<dim>::~Transport() = default;

template <int dim>
void Transport<dim>::advect_faces(AdvectionScheme scheme, const FaceField<dim>& u,
                                  FaceField<dim>& result) {
  TransportFrame<dim>& frame = implementation_->frame;
  std::vector<AdvectedField<dim>> fields(dim);
  for (int a = 0; a < dim; ++a) {
    AdvectedField<dim>& advected = fields[a];
    advected.scheme = scheme;
    advected.start = &u[a];
    advected.result = &result[a];
    advected.invalid = &frame.invalid.faces[a];
    advected.field.kind = a;
    advected.field.inflow = [&frame, a](const Ray<dim>& ray) {
      const TiledGrid<dim>& grid = frame.setting.grid;
      const Point<dim> place = grid.lower() + grid.spacing() * ray.end;
      return frame.setting.sides[ray.inflow_axis][ray.inflow_side].velocity(place)[a];
    };
  }
  FieldAdvection<dim>(frame).advect(fields);
}

template <int dim>
void Transport<dim>::advect_scalar(AdvectionScheme scheme, const CellField& s,
                                   const SideValues<dim>& inflow_values, CellField& result,
                                   const std::vector<char>* tiles, double beyond) {
  std::vector<AdvectedField<dim>> fields(1);
  AdvectedField<dim>& advected = fields[0];
  advected.beyond = beyond;
  advected.scheme = scheme;
  advected.start = &s;
  advected.result = &result;
  advected.invalid = &implementation_->frame.invalid.cells;
  advected.field.kind = cell_centers;
  advected.field.inflow = [&](const Ray<dim>& ray) {
    const TiledGrid<dim>& grid = implementation_->frame.setting.grid;
    const Point<dim> place = grid.lower() + grid.spacing() * ray.end;
    return inflow_values[ray.inflow_axis][ray.inflow_side](place);
  };
  FieldAdvection<dim>(implementation_->frame).advect(fields, tiles);
}

template <int dim>
void Transport<dim>::advect_distance(const CellField& distance, double cut_off,
                                     const std::vector<char>& tiles, CellField& result) {
  TransportFrame<dim>& frame = implementation_->frame;
  std::vector<AdvectedField<dim>> fields(1);
  AdvectedField<dim>& advected = fields[0];
  advected.beyond = cut_off;
  advected.start = &distance;
  advected.result = &result;
  advected.invalid = &frame.invalid.cells;
  advected.field.kind = cell_centers;
  advected.field.inflow_depth = bounded_depth;
  // The air beyond the side has its true distance. A surface along the side goes on to it from the
  // first two samples; one at right angles to it must not be pushed.
  advected.field.enters = [&frame, &advected](const Ray<dim>& ray, double inside) {
    const double h = frame.setting.grid.spacing(), past = ray.past;
    Point<dim> place = ray.end;
    place[ray.inflow_axis] =
        ray.inflow_side == 0 ? 1.5 : frame.lattice->n_cells()[ray.inflow_axis] - 1.5;
    const Stencil<dim> stencil = frame.lattice->locate(cell_centers, place);
    const double deeper =
        stencil.complete() ? interpolate<dim>(stencil, advected.field.values) : inside;
    const double slope = std::clamp((inside - deeper) / h, 0.0, 1.0);
    return std::max(inside + slope * std::max(0.0, 0.5 + past) * h, past * h);
  };
  FieldAdvection<dim>(frame).advect(fields, &tiles);
}

template <int dim>
const InvalidSamples<dim>& Transport<dim>::invalid() const {
  return implementation_->frame.invalid;
}

template <int dim>
double Transport<dim>::largest_displacement() const {
  return implementation_->frame.largest_displacement;
}

template <int dim>
TransportFrame<dim>& Transport<dim>::frame() {
  return implementation_->frame;
}

template class Transport<2>;
template class Transport<3>;

}  // namespace lockstep
