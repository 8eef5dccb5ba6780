#include "mac/liquid/velocity_extension.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lockstep {

namespace {
/// Of sources that are no nearer: they count where there are no others [cells].
constexpr double least_weight = 1e-12;
/// Distances that differ by less are equal, so that round-off does not order faces [cells].
constexpr double same_distance = 1e-9;
}  // namespace

template <int dim>
VelocityExtension<dim>::VelocityExtension(const MacDomain<dim>& domain, const CellField& distance,
                                          double band, const std::vector<char>& near,
                                          const NearbySurface<dim>& surface, MacState<dim>& state)
    : domain_(domain), distance_(distance), near_(near), surface_(surface) {
  find_faces(band, state);
  for (int axis = 0; axis < dim; ++axis)
    find_sources(axis, state);
}

template <int dim>
void VelocityExtension<dim>::find_faces(double band, MacState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto in_band = [&](int cell) {
    return cell >= 0 && state.cells[cell] == CellState::empty && distance_[cell] < band;
  };
  for (int axis = 0; axis < dim; ++axis) {
    grid.for_each_owned_face(axis, [&](int cell) {
      FaceState& face = state.faces[axis][cell];
      if (is_wet(face))
        return;
      const FaceCells cells = cells_of_face(grid, state.cells, axis, cell);
      const bool is_extended = in_band(cells.lower) || in_band(cells.upper);
      face = is_extended ? FaceState::extended : FaceState::inactive;
      if (is_extended)
        faces_[axis].push_back({cell, is_shut(axis, cell, cells, state) ? -1 : 0, {}});
    });
    if (grid.comm()->getSize() > 1)
      fill_flags(domain_.full_halo, state.faces[axis]);
  }
}

template <int dim>
bool VelocityExtension<dim>::is_shut(int axis, int cell, const FaceCells& cells,
                                     const MacState<dim>& state) const {
  if (cells.at_side() && domain_.boundary.side(axis, cells.lower < 0 ? 0 : 1).prescribed())
    return true;
  for (const int side : {cells.lower, cells.upper})
    if (side >= 0 && state.cells[side] == CellState::solid)
      return true;
  if (near_.empty() || !near_[cell])
    return false;
  const Point<dim> x = domain_.grid.face_center(axis, cell);
  const Point<dim> half = Point<dim>::Unit(axis) * (0.5 * domain_.spacing());
  return surface_.first_hit(x - half, x + half).has_value();
}

/// Smallest where fluid is nearest.
template <int dim>
double VelocityExtension<dim>::distance_of_face(int axis, int cell,
                                                const MacState<dim>& state) const {
  const FaceCells cells = cells_of_face(domain_.grid, state.cells, axis, cell);
  const double lower = cells.lower < 0 ? distance_[cells.upper] : distance_[cells.lower];
  const double upper = cells.upper < 0 ? lower : distance_[cells.upper];
  return 0.5 * (lower + upper);
}

template <int dim>
void VelocityExtension<dim>::find_sources(int axis, const MacState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto& states = state.faces[axis];
  known_[axis].resize(grid.n_stored_cells());
  for (int cell = 0; cell < grid.n_stored_cells(); ++cell)
    known_[axis][cell] = is_wet(states[cell]);

  using Key = std::tuple<double, GlobalIndex>;
  const auto key = [&](int cell) {
    const double rank = distance_of_face(axis, cell, state) / (same_distance * grid.spacing());
    return Key(std::round(rank), grid.global_id(cell));
  };
  std::vector<std::pair<Key, Face>> sorted;
  for (Face face : faces_[axis]) {
    const Key own = key(face.cell);
    const Point<dim> x = grid.face_center(axis, face.cell);
    const bool is_near = !near_.empty() && near_[face.cell];
    const bool shut = face.n_sources < 0;
    face.n_sources = 0;
    for (int side = 0; side < 2 * dim && !shut; ++side) {
      const int other = grid.neighbor(face.cell, side / 2, side % 2);
      if (other < 0 || states[other] == FaceState::inactive)
        continue;
      if (states[other] == FaceState::extended && !(key(other) < own))
        continue;
      const Point<dim> step =
          Point<dim>::Unit(side / 2) * (side % 2 == 0 ? -grid.spacing() : grid.spacing());
      if ((is_near || (!near_.empty() && near_[other])) && surface_.first_hit(x, x + step))
        continue;
      Source& source = face.sources[face.n_sources++];
      source = find_source(axis, other, side, state);
      const double nearer = same_distance * (std::get<0>(own) - std::get<0>(key(other)));
      source.weight = std::max(nearer, least_weight);
    }
    sorted.emplace_back(own, face);
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < sorted.size(); ++i)
    faces_[axis][i] = sorted[i].second;
}

/// `side` is that at which the source is seen.
template <int dim>
typename VelocityExtension<dim>::Source VelocityExtension<dim>::find_source(
    int axis, int face, int side, const MacState<dim>& state) const {
  const auto is_plain = [&](int other) {
    return other >= 0 && state.faces[axis][other] == FaceState::free &&
           (near_.empty() || !near_[other]);
  };
  Source source;
  source.face = face;
  if (!is_plain(face))
    return source;
  const int second = domain_.grid.neighbor(face, side / 2, side % 2);
  const int third = second < 0 ? -1 : domain_.grid.neighbor(second, side / 2, side % 2);
  if (is_plain(second) && is_plain(third)) {
    source.second = second;
    source.third = third;
  }
  return source;
}

template <int dim>
double VelocityExtension<dim>::carried_on(const Source& source, const CellField& velocity) {
  const double value = velocity[source.face];
  if (source.second < 0)
    return value;
  const double change = value - velocity[source.second];
  const double before = velocity[source.second] - velocity[source.third];
  if (change * before <= 0)
    return value;
  return value + (std::abs(change) < std::abs(before) ? change : before);
}

template <int dim>
double VelocityExtension<dim>::given(
    int axis, int cell, double time,
    const std::function<Point<dim>(const SurfacePoint<dim>&)>& on_surface) const {
  const TiledGrid<dim>& grid = domain_.grid;
  for (int end = 0; end < 2; ++end) {
    const BoundarySide<dim>& side = domain_.boundary.side(axis, end);
    if (side.prescribed() && grid.coordinates(cell)[axis] == (end == 0 ? 0 : grid.n_cells()[axis]))
      return side.mean_velocity(axis, domain_.face_box(axis, cell), time)[axis];
  }
  if (surface_.empty() || near_.empty())
    return 0;
  const auto closest =
      surface_.snapshot().closest(grid.face_center(axis, cell), 1.5 * grid.spacing());
  return closest ? on_surface(*closest)[axis] : 0;
}

template <int dim>
void VelocityExtension<dim>::extend(
    double time, const std::function<Point<dim>(const SurfacePoint<dim>&)>& on_surface,
    FaceField<dim>& velocity) const {
  const bool alone = domain_.grid.comm()->getSize() == 1;
  domain_.full_halo.fill(velocity);  // sources look three faces far
  for (int axis = 0; axis < dim; ++axis) {
    CellField& u = velocity[axis];
    std::vector<char> known = known_[axis];
    std::vector<const Face*> waiting;
    for (const Face& face : faces_[axis])
      waiting.push_back(&face);
    GlobalIndex n_waiting = 1;
    while (n_waiting > 0) {
      std::vector<const Face*> behind;  // sources on another rank have no value yet
      for (const Face* face : waiting) {
        const auto end = face->sources.begin() + face->n_sources;
        if (!std::all_of(face->sources.begin(), end,
                         [&](const Source& source) { return known[source.face]; })) {
          behind.push_back(face);
          continue;
        }
        double sum = 0, weights = 0, base = 0;  // equal values have themselves as mean
        for (auto source = face->sources.begin(); source != end; ++source) {
          const double value = carried_on(*source, u);
          base = source == face->sources.begin() ? value : base;
          sum += source->weight * (value - base);
          weights += source->weight;
        }
        u[face->cell] =
            face->n_sources > 0 ? base + sum / weights : given(axis, face->cell, time, on_surface);
        known[face->cell] = 1;
      }
      waiting.swap(behind);
      domain_.halo.fill(u);
      n_waiting =
          alone ? 0 : sum_all(domain_.grid.comm(), static_cast<GlobalIndex>(waiting.size()));
      if (n_waiting > 0)
        domain_.halo.fill(known);
    }
  }
}

template class VelocityExtension<2>;
template class VelocityExtension<3>;

}  // namespace lockstep
