#include "transport/uncovered_samples.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "transport/nearby_surface.hpp"
#include "transport/sample_lattice.hpp"

namespace lockstep {

namespace {

/// Largest distance of the neighbours beyond owned cells that are read [cells].
constexpr int sight = 2;

/// A sample that waits for a value, and those of its neighbours that it can see.
template <int dim>
struct Waiting {
  int id = 0;
  std::array<int, 2 * dim> visible{};
  int n_visible = 0;
  bool sees_wall = false;  ///< an upper side that has no samples: its velocity is zero
};

/// Fills the invalid samples of one kind.
template <int dim>
class Fronts {
 public:
  Fronts(const UncoveredGrid<dim>& uncovered, const NearbySurface<dim>& nearby, SampleKind kind,
         const std::vector<char>& invalid)
      : grid_(uncovered.grid),
        halo_(uncovered.halo),
        state_(uncovered.after),
        surface_(uncovered.surface),
        nearby_(nearby),
        weight_(uncovered.weight),
        kind_(kind),
        valid_(grid_.n_stored_cells()) {
    const auto look_at = [&](int id) {
      const bool has_no_value = !invalid.empty() && invalid[id];
      valid_[id] = in_fluid(id) && !has_no_value;
      if (in_fluid(id) && has_no_value && !is_extended(id))
        look_around(id);
    };
    if (kind == cell_centers)
      grid_.for_each_owned_cell(look_at);
    else
      grid_.for_each_owned_face(kind, look_at);
    halo_.fill(valid_);
  }

  UncoveredReport fill(CellField& values) {
    UncoveredReport report;
    report.n_invalid = sum_all(grid_.comm(), static_cast<GlobalIndex>(waiting_.size()));
    halo_.fill(values);
    GlobalIndex n_left = report.n_invalid;
    while (n_left > 0) {
      advance(values);
      const GlobalIndex n = sum_all(grid_.comm(), static_cast<GlobalIndex>(waiting_.size()));
      if (n == n_left)
        break;
      n_left = n;
      ++report.n_fronts;
    }
    report.n_left_over = n_left;
    return report;
  }

  /// Velocity of the nearest surface within three cells of a sample that is left over, or zero.
  double surface_velocity(int id) const {
    if (nearby_.empty())
      return 0;
    const auto closest = nearby_.snapshot().closest(position(id), 3 * grid_.spacing());
    if (!closest)
      return 0;
    // The velocity belongs to t^n: the same point of the simplex, where it was then.
    SurfacePoint<dim> point = *closest;
    if (surface_.before && surface_.before->n_simplices() > point.simplex) {
      const auto corners = surface_.before->corners(point.simplex);
      point.position.setZero();
      for (int k = 0; k < dim; ++k)
        point.position += point.barycentric[k] * corners[k];
    }
    return surface_.velocity(point)[kind_];
  }
  const std::vector<Waiting<dim>>& left_over() const { return waiting_; }

 private:
  bool in_fluid(int id) const {
    return kind_ == cell_centers ? state_.cells[id] == CellState::fluid
                                 : state_.faces[kind_][id] != FaceState::inactive;
  }
  /// Filled when the fluid is carried on, not before; one that has a value may be looked at.
  bool is_extended(int id) const {
    return kind_ != cell_centers && state_.faces[kind_][id] == FaceState::extended;
  }
  /// Prescribed faces are set by their side, whatever passed over them.
  bool is_prescribed(int id) const {
    return kind_ != cell_centers && state_.faces[kind_][id] == FaceState::prescribed;
  }
  bool is_below_wall(int face) const {
    const auto& description = grid_.description();
    return !description.periodic[kind_] && !description.store_upper_face[kind_] &&
           grid_.coordinates(face)[kind_] == description.n_cells[kind_] - 1 &&
           state_.cells[face] == CellState::fluid;
  }
  Point<dim> position(int id) const {
    return kind_ == cell_centers ? grid_.center(id) : grid_.face_center(kind_, id);
  }
  /// Where its fluid is, as seen from its regular position.
  Point<dim> shift(int id) const {
    if (kind_ == cell_centers)
      return Point<dim>::Zero();
    const auto& centers = state_.open_centers[kind_];
    const auto found = centers.find(id);
    if (found == centers.end())
      return Point<dim>::Zero();
    Point<dim> shift = found->second - position(id);
    for (int a = 0; a < dim; ++a)
      if (grid_.description().periodic[a]) {  // a face of the seam lies at either side
        const double period = grid_.n_cells()[a] * grid_.spacing();
        shift[a] -= period * std::round(shift[a] / period);
      }
    return shift;
  }
  /// A cell that is cut by a surface and holds fluid, though its centre is in a solid.
  bool center_is_covered(int id) const {
    return kind_ == cell_centers && state_.has_cut_cells &&
           state_.surface->inside(position(id)) >= 0;
  }

  void look_around(int id) {
    if (is_prescribed(id)) {
      valid_[id] = 1;
      return;
    }
    Waiting<dim> sample;
    sample.id = id;
    const Point<dim> x = position(id), eye = x + shift(id);
    const double h = grid_.spacing();
    const bool is_covered = center_is_covered(id);
    for (int a = 0; a < dim; ++a)
      for (int side = 0; side < 2; ++side) {
        const int neighbor = grid_.neighbor(id, a, side);
        const Point<dim> beside = x + (side == 0 ? -h : h) * Point<dim>::Unit(a);
        if (neighbor < 0 && a == kind_ && side == 1 && is_below_wall(id))
          sample.sees_wall = !nearby_.first_hit(eye, beside);
        if (neighbor < 0 || !in_fluid(neighbor))
          continue;
        if (is_covered ? state_.faces[a][side == 0 ? id : neighbor] == FaceState::free
                       : !nearby_.first_hit(eye, beside + shift(neighbor)))
          sample.visible[sample.n_visible++] = neighbor;
      }
    waiting_.push_back(sample);
  }

  double weight_of(int id) const {
    return weight_ && kind_ != cell_centers ? weight_(kind_, id) : 1;
  }

  /// One front: all samples that see a valid one get their value from those, at the same time.
  void advance(CellField& values) {
    std::vector<std::pair<int, double>> found;
    std::vector<Waiting<dim>> still_waiting;
    for (const Waiting<dim>& sample : waiting_) {
      double sum = 0, base = 0, weights = sample.sees_wall ? weight_of(sample.id) : 0;
      for (int k = 0; k < sample.n_visible; ++k) {
        const int neighbor = sample.visible[k];
        if (!valid_[neighbor])
          continue;
        const double weight = weight_of(neighbor);
        if (weights == 0)
          base = values[neighbor];
        weights += weight;
        sum += weight * (values[neighbor] - base);
      }
      if (weights > 0)
        found.emplace_back(sample.id, base + sum / weights);
      else
        still_waiting.push_back(sample);
    }
    for (const auto& [id, value] : found) {
      values[id] = value;
      valid_[id] = 1;
    }
    waiting_.swap(still_waiting);
    halo_.fill(values);
    halo_.fill(valid_);
  }

  const TiledGrid<dim>& grid_;
  const HaloExchange<dim>& halo_;
  const GridState<dim>& state_;
  const MovingSurface<dim>& surface_;
  const NearbySurface<dim>& nearby_;
  const std::function<double(int, int)>& weight_;
  SampleKind kind_;
  std::vector<char> valid_;
  std::vector<Waiting<dim>> waiting_;
};

}  // namespace

template <int dim>
UncoveredReport populate_uncovered_faces(const UncoveredGrid<dim>& uncovered, FaceField<dim>& u) {
  UncoveredReport total;
  const auto nearby = uncovered.kept.of(uncovered.after.surface, uncovered.grid, sight);
  for (int a = 0; a < dim; ++a) {
    Fronts<dim> fronts(uncovered, *nearby, a, uncovered.invalid.faces[a]);
    const UncoveredReport report = fronts.fill(u[a]);
    for (const auto& sample : fronts.left_over())
      u[a][sample.id] = fronts.surface_velocity(sample.id);
    if (report.n_left_over > 0)
      uncovered.halo.fill(u[a]);
    total.n_invalid += report.n_invalid;
    total.n_left_over += report.n_left_over;
    total.n_fronts = std::max(total.n_fronts, report.n_fronts);
  }
  return total;
}

template <int dim>
UncoveredReport populate_uncovered_scalar(const UncoveredGrid<dim>& uncovered, double ambient,
                                          CellField& s) {
  const auto nearby = uncovered.kept.of(uncovered.after.surface, uncovered.grid, sight);
  Fronts<dim> fronts(uncovered, *nearby, cell_centers, uncovered.invalid.cells);
  const UncoveredReport report = fronts.fill(s);
  for (const auto& sample : fronts.left_over())
    s[sample.id] = ambient;
  if (report.n_left_over > 0)
    uncovered.halo.fill(s);
  return report;
}

template UncoveredReport populate_uncovered_faces<2>(const UncoveredGrid<2>&, FaceField<2>&);
template UncoveredReport populate_uncovered_faces<3>(const UncoveredGrid<3>&, FaceField<3>&);
template UncoveredReport populate_uncovered_scalar<2>(const UncoveredGrid<2>&, double, CellField&);
template UncoveredReport populate_uncovered_scalar<3>(const UncoveredGrid<3>&, double, CellField&);

}  // namespace lockstep
