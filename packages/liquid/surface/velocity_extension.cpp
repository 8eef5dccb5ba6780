#include "liquid/surface/velocity_extension.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Weight of sources that are no nearer to the fluid: they count where there are no others [cells].
constexpr double least_weight = 1e-12;
/// Distances that differ by less are equal, so that round-off does not order faces [cells].
constexpr double same_distance = 1e-9;
}  // namespace

template <int dim>
VelocityExtension<dim>::VelocityExtension(const MacDomain<dim>& domain, const ExtensionRange& range,
                                          const std::vector<char>& near,
                                          const NearbySurface<dim>& surface, GridState<dim>& state)
    : domain_(domain), distance_(range.distance), near_(near), surface_(surface) {
  if (range.band > range.known)
    go_on(range.known, range.band, state);
  find_faces(range.band, state);
  for (int axis = 0; axis < dim; ++axis) {
    sort_faces(axis, state);
    find_sources(axis, state);
  }
}

/// Extends the distance from cell to cell where it is cut off: on a plateau no face would be nearer
/// to the fluid than another. Across a cell's corner a distance of h leads over as many cells as
/// there are axes; so no cell within the band is left out.
template <int dim>
void VelocityExtension<dim>::go_on(double known, double band, const GridState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  const double h = grid.spacing(), layer = h / std::sqrt(dim), unknown = band + 2 * h;
  std::vector<int> waiting, reached;
  grid.for_each_stored_cell([&](int cell) {
    if (state.cells[cell] != CellState::air || distance_[cell] < (1 - 1e-6) * known)
      return;
    distance_[cell] = unknown;
    if (grid.owned(cell))
      waiting.push_back(cell);
  });
  domain_.full_halo.fill(distance_);
  const auto is_next = [&](int cell) {
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = grid.neighbor(cell, i / 2, i % 2);
      if (other >= 0 && grid.in_domain(other) && state.cells[other] != CellState::solid &&
          distance_[other] < unknown && !is_hidden(cell, i / 2, i % 2))
        return true;
    }
    return false;
  };
  for (double value = known; value < band + h; value += layer) {
    const auto rest = std::stable_partition(waiting.begin(), waiting.end(), is_next);
    reached.assign(waiting.begin(), rest);
    waiting.erase(waiting.begin(), rest);
    for (const int cell : reached)
      distance_[cell] = value;
    if (sum_all(grid.comm(), static_cast<GlobalIndex>(reached.size())) == 0)
      break;
    domain_.full_halo.fill(distance_);
  }
}

/// True if a surface comes between the centres of a cell and its neighbour.
template <int dim>
bool VelocityExtension<dim>::is_hidden(int cell, int axis, int side) const {
  const int other = domain_.grid.neighbor(cell, axis, side);
  if (near_.empty() || !(near_[cell] || near_[other]))
    return false;
  const Point<dim> x = domain_.grid.center(cell);
  const double h = domain_.spacing();
  return surface_.first_hit(x, x + (side == 0 ? -h : h) * Point<dim>::Unit(axis)).has_value();
}

template <int dim>
void VelocityExtension<dim>::find_faces(double band, GridState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto in_band = [&](int cell) {
    return cell >= 0 && state.cells[cell] == CellState::air && distance_[cell] < band;
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
        faces_[axis].all.push_back({cell, 0, is_shut(axis, cell, cells, state) ? -1 : 0});
    });
    if (grid.comm()->getSize() > 1)
      fill_flags(domain_.full_halo, state.faces[axis]);
  }
}

template <int dim>
bool VelocityExtension<dim>::is_shut(int axis, int cell, const FaceCells& cells,
                                     const GridState<dim>& state) const {
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

template <int dim>
double VelocityExtension<dim>::rank_of_face(int axis, int cell, const GridState<dim>& state) const {
  const FaceCells cells = cells_of_face(domain_.grid, state.cells, axis, cell);
  const double lower = cells.lower < 0 ? distance_[cells.upper] : distance_[cells.lower];
  const double upper = cells.upper < 0 ? lower : distance_[cells.upper];
  return std::round(0.5 * (lower + upper) / (same_distance * domain_.grid.spacing()));
}

template <int dim>
void VelocityExtension<dim>::sort_faces(int axis, const GridState<dim>& state) {
  struct Place {
    double rank;
    GlobalIndex id;
    Face face;
  };
  std::vector<Face>& faces = faces_[axis].all;
  std::vector<Place> places;
  places.reserve(faces.size());
  for (const Face& face : faces)
    places.push_back(
        {rank_of_face(axis, face.cell, state), domain_.grid.global_id(face.cell), face});
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.rank != b.rank ? a.rank < b.rank : a.id < b.id;
  });
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces[i] = places[i].face;
}

template <int dim>
void VelocityExtension<dim>::find_sources(int axis, const GridState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  if (grid.comm()->getSize() > 1) {
    known_[axis].resize(grid.n_stored_cells());
    for (int cell = 0; cell < grid.n_stored_cells(); ++cell)
      known_[axis][cell] = is_wet(state.faces[axis][cell]);
  }
  Faces& faces = faces_[axis];
  CellField rank(grid.n_owned_cells());
  for (const Face& face : faces.all)
    rank[face.cell] = rank_of_face(axis, face.cell, state);
  faces.sources.reserve(2 * faces.all.size());
  for (Face& face : faces.all)
    find_sources_of(face, axis, rank, state);
}

template <int dim>
void VelocityExtension<dim>::find_sources_of(Face& face, int axis, const CellField& rank,
                                             const GridState<dim>& state) {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<Source>& sources = faces_[axis].sources;
  const bool shut = face.n_sources < 0;
  face.first_source = static_cast<int>(sources.size());
  face.n_sources = 0;
  if (shut)
    return;
  const double own = rank[face.cell];
  const bool is_near = !near_.empty() && near_[face.cell];
  for (int side = 0; side < 2 * dim; ++side) {
    const int other = grid.neighbor(face.cell, side / 2, side % 2);
    if (other < 0 || state.faces[axis][other] == FaceState::inactive)
      continue;
    const bool is_extended = state.faces[axis][other] == FaceState::extended;
    const double theirs =
        is_extended && grid.owned(other) ? rank[other] : rank_of_face(axis, other, state);
    if (is_extended &&
        !(theirs < own || (theirs == own && grid.global_id(other) < grid.global_id(face.cell))))
      continue;
    if (is_near || (!near_.empty() && near_[other])) {
      const Point<dim> x = grid.face_center(axis, face.cell);
      const double h = grid.spacing();
      if (surface_.first_hit(x, x + Point<dim>::Unit(side / 2) * (side % 2 == 0 ? -h : h)))
        continue;
    }
    sources.push_back({other, goes_on(axis, other, side, state) ? side : -1,
                       std::max(same_distance * (own - theirs), least_weight)});
    ++face.n_sources;
  }
}

/// `side` is that at which the source is seen.
template <int dim>
bool VelocityExtension<dim>::goes_on(int axis, int source, int side,
                                     const GridState<dim>& state) const {
  const auto is_regular = [&](int face) {
    return face >= 0 && state.faces[axis][face] == FaceState::free &&
           (near_.empty() || !near_[face]);
  };
  if (!is_regular(source))
    return false;
  const int second = domain_.grid.neighbor(source, side / 2, side % 2);
  return is_regular(second) && is_regular(domain_.grid.neighbor(second, side / 2, side % 2));
}

template <int dim>
double VelocityExtension<dim>::carried_on(const Source& source, const CellField& velocity) const {
  const double value = velocity[source.face];
  if (source.side < 0)
    return value;
  const int second = domain_.grid.neighbor(source.face, source.side / 2, source.side % 2);
  const int third = domain_.grid.neighbor(second, source.side / 2, source.side % 2);
  const double change = value - velocity[second];
  const double before = velocity[second] - velocity[third];
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
  domain_.full_halo.fill(velocity);  // sources look three faces far
  const bool alone = domain_.grid.comm()->getSize() == 1;
  for (int axis = 0; axis < dim; ++axis) {
    const auto set = [&](const Face& face) {
      velocity[axis][face.cell] = face.n_sources > 0 ? mean_of_sources(axis, face, velocity[axis])
                                                     : given(axis, face.cell, time, on_surface);
    };
    if (alone)
      std::for_each(faces_[axis].all.begin(), faces_[axis].all.end(), set);
    else
      extend_across_ranks(axis, set, velocity[axis]);
  }
}

template <int dim>
double VelocityExtension<dim>::mean_of_sources(int axis, const Face& face,
                                               const CellField& velocity) const {
  const Source* const first = faces_[axis].sources.data() + face.first_source;
  const double base = carried_on(*first, velocity);
  double sum = 0, weights = 0;  // equal values have themselves as mean
  for (const Source* source = first; source != first + face.n_sources; ++source) {
    sum += source->weight * (source == first ? 0 : carried_on(*source, velocity) - base);
    weights += source->weight;
  }
  return base + sum / weights;
}

/// Sources on another rank have a value in a later round.
template <int dim>
template <typename Set>
void VelocityExtension<dim>::extend_across_ranks(int axis, const Set& set, CellField& u) const {
  std::vector<char> known = known_[axis];
  std::vector<const Face*> waiting, behind;
  for (const Face& face : faces_[axis].all)
    waiting.push_back(&face);
  GlobalIndex n_waiting = 1;
  while (n_waiting > 0) {
    behind.clear();
    for (const Face* face : waiting) {
      const Source* const first = faces_[axis].sources.data() + face->first_source;
      if (!std::all_of(first, first + face->n_sources,
                       [&](const Source& source) { return known[source.face]; })) {
        behind.push_back(face);
        continue;
      }
      set(*face);
      known[face->cell] = 1;
    }
    waiting.swap(behind);
    domain_.halo.fill(u);
    n_waiting = sum_all(domain_.grid.comm(), static_cast<GlobalIndex>(waiting.size()));
    if (n_waiting > 0)
      domain_.halo.fill(known);
  }
}

template class VelocityExtension<2>;
template class VelocityExtension<3>;

}  // namespace lockstep
