#include "liquid/surface/wet_bodies.hpp"

#include <Eigen/Dense>

#include "geometry/solid_volume.hpp"

namespace lockstep {

namespace {
/// Distance from bodies in which the free surface around them is searched [cells].
constexpr int reach_of_planes = 2;

/// The part of the way between two cells that is wet, phi being linear there.
double wet_fraction(double lower, double upper) {
  if ((lower < 0) == (upper < 0))
    return lower < 0 ? 1 : 0;
  return (lower < 0 ? lower : upper) / (lower < 0 ? lower - upper : upper - lower);
}

/// The plane through the free surface around a body: height + slope . (x - origin) across `up`.
template <int dim>
struct WaterPlane {
  using Values = Eigen::Matrix<double, dim, 1>;
  Point<dim> origin = Point<dim>::Zero(), up = Point<dim>::Zero();
  Eigen::Matrix<double, dim, dim> normal = Eigen::Matrix<double, dim, dim>::Zero();
  Values sums = Values::Zero();

  bool known() const { return normal(0, 0) > 0; }
  /// 1 and the coordinates across `up`.
  Values row(const Point<dim>& x) const {
    int vertical = 0;
    up.cwiseAbs().maxCoeff(&vertical);
    Values row;
    row[0] = 1;
    for (int k = 1; k < dim; ++k) {
      const int axis = (vertical + k) % dim;
      row[k] = (x - origin - up.dot(x - origin) * up)[axis];
    }
    return row;
  }
  void add(const Point<dim>& x) {
    const Values r = row(x);
    normal += r * r.transpose();
    sums += up.dot(x - origin) * r;
  }
  /// `spacing`: what points nearer than that to a line do not tell is left level.
  void solve(double spacing) {
    Eigen::Matrix<double, dim, dim> matrix = normal;
    for (int k = 1; k < dim; ++k)
      matrix(k, k) += 1e-3 * normal(0, 0) * spacing * spacing;
    values_ = matrix.ldlt().solve(sums);
  }
  double operator()(const Point<dim>& x) const { return up.dot(x - origin) - values_.dot(row(x)); }

 private:
  Values values_ = Values::Zero();
};

template <int dim>
class WetBodyFinder {
 public:
  WetBodyFinder(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                const CellField& distance, const Point<dim>& gravity)
      : grid_(domain.grid),
        domain_(domain),
        geometry_(geometry),
        distance_(distance),
        gravity_(gravity),
        surface_(*geometry.state.surface),
        bodies_(surface_.solids().size()),
        planes_(bodies_.size()) {}

  std::vector<WetBody<dim>> find() {
    find_partly_wet();
    if (std::any_of(bodies_.begin(), bodies_.end(), [](const auto& b) { return b.partly; })) {
      find_planes();
      add_volumes();
      for (int axis = 0; axis < dim; ++axis)
        grid_.for_each_owned_face(axis, [&](int cell) { add_face(axis, cell); });
      sum();
    }
    return std::move(bodies_);
  }

 private:
  bool is_solid(int cell) const {
    return cell >= 0 && geometry_.state.cells[cell] == CellState::solid;
  }
  /// The solid that holds the centre of a solid cell.
  int owner(int cell) const {
    const Point<dim> x = grid_.center(cell);
    surface_.solids_touching(Box<dim>(x, x), candidates_);
    int closed = -1, n = 0;
    for (const int s : candidates_)
      if (surface_.solids()[s].closed) {
        closed = s;
        ++n;
      }
    return n == 1 ? closed : surface_.inside(x);
  }
  /// Calls f(cell) for the owned cells of the domain that a box touches.
  template <typename Function>
  void for_each_cell_in(const Box<dim>& box, const Function& f) const {
    for (int tile = 0; tile < grid_.n_owned_tiles(); ++tile) {
      Index<dim> begin, end, cell;
      bool any = true;
      for (int a = 0; a < dim; ++a) {
        const auto place = [&](double x) {
          return static_cast<int>(
              std::floor(std::min(std::max((x - grid_.lower()[a]) / grid_.spacing(), -1.0), 1e9)));
        };
        begin[a] = std::max(place(box.min()[a]), grid_.tile_begin(tile)[a]);
        end[a] = std::min(place(box.max()[a]) + 1,
                          grid_.tile_begin(tile)[a] + grid_.tile_domain_extent(tile)[a]);
        any = any && begin[a] < end[a];
      }
      cell = begin;
      while (any) {
        f(grid_.cell(cell));
        int a = 0;
        while (a < dim && ++cell[a] == end[a])
          cell[a] = begin[a], ++a;
        any = a < dim;
      }
    }
  }
  Box<dim> near_solid(int solid, int n_cells = 1) const {
    const Point<dim> margin = Point<dim>::Constant(n_cells * grid_.spacing());
    const Box<dim> box = surface_.bounds_of_solid(solid);
    return Box<dim>(box.min() - margin, box.max() + margin);
  }

  /// Finds the bodies with air where their planes are searched: where it meets liquid there, a
  /// plane is found. phi is not used, since deep in solids it is that of an earlier place of the
  /// solid.
  void find_partly_wet() {
    std::vector<double> partly(bodies_.size(), 0);
    for (std::size_t s = 0; s < bodies_.size(); ++s)
      if (surface_.solids()[s].closed)
        for_each_cell_in(near_solid(static_cast<int>(s), reach_of_planes), [&](int cell) {
          if (geometry_.state.cells[cell] == CellState::air)
            partly[s] = 1;
        });
    sum_all(grid_.comm(), partly.data(), static_cast<int>(partly.size()));
    for (std::size_t s = 0; s < bodies_.size(); ++s)
      bodies_[s].partly = partly[s] > 0;
  }

  /// True if another solid comes between two points.
  bool parted(int solid, const Point<dim>& a, const Point<dim>& b) const {
    const auto hit = surface_.first_hit(a, b);
    return hit && surface_.solid_of(hit->simplex) != solid;
  }
  /// The free surface beyond a hull is none to what lies in it, nor is the hull.
  bool sees_surface(int solid, int cell, int axis, const Point<dim>& place) const {
    const Point<dim> x = grid_.center(cell);
    return !parted(solid, x, x - grid_.spacing() * Point<dim>::Unit(axis)) &&
           !parted(solid, place, surface_.closest_on_solid(place, solid).position);
  }

  /// Through where liquid meets air around it, in its sight.
  void find_planes() {
    if (gravity_.isZero(0))
      return;
    const double h = grid_.spacing();
    std::vector<double> flat;
    const auto each = [&](const auto& f) {
      for (WaterPlane<dim>& plane : planes_) {
        for (int i = 0; i < dim * dim; ++i)
          f(plane.normal.data()[i]);
        for (int i = 0; i < dim; ++i)
          f(plane.sums[i]);
      }
    };
    for (std::size_t s = 0; s < bodies_.size(); ++s) {
      if (!bodies_[s].partly)
        continue;
      const Box<dim> around = near_solid(static_cast<int>(s), reach_of_planes);
      planes_[s].origin = around.center();
      planes_[s].up = -gravity_.normalized();
      surface_.solids_touching(around, candidates_);
      const bool is_alone = candidates_.size() == 1;
      for_each_cell_in(around, [&](int cell) {
        const CellState own = geometry_.state.cells[cell];
        for (int axis = 0; axis < dim; ++axis) {
          const int lower = grid_.neighbor(cell, axis, 0);
          if (lower < 0)
            continue;
          const CellState other = geometry_.state.cells[lower];
          if ((own != CellState::fluid || other != CellState::air) &&
              (own != CellState::air || other != CellState::fluid))
            continue;
          const double part = distance_[cell] / (distance_[cell] - distance_[lower]);
          const Point<dim> place = grid_.center(cell) - part * h * Point<dim>::Unit(axis);
          if (is_alone || sees_surface(static_cast<int>(s), cell, axis, place))
            planes_[s].add(place);
        }
      });
    }
    each([&](double value) { flat.push_back(value); });
    sum_all(grid_.comm(), flat.data(), static_cast<int>(flat.size()));
    const double* value = flat.data();
    each([&](double& mine) { mine = *value++; });
    for (std::size_t s = 0; s < bodies_.size(); ++s) {
      WaterPlane<dim>& plane = planes_[s];
      if (!plane.known())
        continue;
      plane.solve(h);
      for (int a = 0; a < dim; ++a)
        bodies_[s].slope[a] = plane(plane.origin + Point<dim>::Unit(a)) - plane(plane.origin);
      bodies_[s].level = bodies_[s].slope.dot(plane.origin) - plane(plane.origin);
    }
  }

  void add_volumes() {
    const Point<dim> half = Point<dim>::Constant(0.5 * grid_.spacing());
    for (std::size_t s = 0; s < bodies_.size(); ++s) {
      WetBody<dim>& body = bodies_[s];
      if (!planes_[s].known())
        continue;
      for_each_cell_in(near_solid(static_cast<int>(s)), [&](int cell) {
        const bool near_surface = geometry_.near_surface(cell);
        if (!near_surface && !is_solid(cell))
          return;
        const Point<dim> x = grid_.center(cell);
        const Box<dim> wet = part_below<dim>(planes_[s], Box<dim>(x - half, x + half));
        if (wet.isEmpty())
          return;
        double volume = 0;
        if (near_surface)
          volume = solid_volume_in_box<dim>(surface_, wet, static_cast<int>(s));
        else if (owner(cell) == static_cast<int>(s))
          volume = wet.volume();
        body.volume += volume;
        body.centroid += volume * wet.center();
      });
    }
  }

  /// A face and the centres of the cells beside it.
  struct Places {
    Point<dim> lower, face, upper;
  };
  /// Where a periodic axis closes, at the one end of the domain or the other: solids are not
  /// repeated.
  Places places(int axis, int cell, const FaceCells& cells, bool at_upper_end) const {
    Places at{grid_.center(cells.lower), grid_.face_center(axis, cell), grid_.center(cells.upper)};
    if (grid_.coordinates(cell)[axis] > 0)
      return at;
    const Point<dim> period = grid_.n_cells()[axis] * grid_.spacing() * Point<dim>::Unit(axis);
    if (at_upper_end)
      return {at.lower, at.face + period, at.upper + period};
    return {at.lower - period, at.face, at.upper};
  }
  /// The closed solid of which a corner comes between two cells, or -1.
  int corner_between(const Places& at) const {
    const auto hit = surface_.first_hit(at.lower, at.upper);
    const int solid = hit ? surface_.solid_of(hit->simplex) : -1;
    return solid >= 0 && surface_.solids()[solid].closed ? solid : -1;
  }

  /// A dual cell that a solid blocks or fills.
  void add_face(int axis, int cell) {
    const FaceCells cells = cells_of_face(grid_, geometry_.state.cells, axis, cell);
    const bool lower = is_solid(cells.lower), upper = is_solid(cells.upper);
    std::array<int, 2> owners{lower ? owner(cells.lower) : -1, upper ? owner(cells.upper) : -1};
    bool at_upper_end = lower && !upper;
    if (!lower && !upper) {
      if (cells.at_side() || geometry_.state.faces[axis][cell] != FaceState::coupled)
        return;
      owners[0] = corner_between(places(axis, cell, cells, false));
      at_upper_end = owners[0] < 0 && grid_.coordinates(cell)[axis] == 0;
      if (at_upper_end)
        owners[0] = corner_between(places(axis, cell, cells, true));
      if (owners[0] < 0)
        return;
    }
    const int n = lower && upper && owners[0] != owners[1] ? 2 : 1;
    if (n == 1)
      owners[0] = std::max(owners[0], owners[1]);
    for (int k = 0; k < n; ++k) {
      if (owners[k] < 0 || !planes_[owners[k]].known())
        continue;
      WetBody<dim>& body = bodies_[owners[k]];
      const WaterPlane<dim>& plane = planes_[owners[k]];
      if (cells.at_side()) {
        body.at_side[axis] |= distance_[std::max(cells.lower, cells.upper)] < 0;
        continue;
      }
      const Places at = places(axis, cell, cells, n == 2 ? k == 0 : at_upper_end);
      const double volume =
          domain_.cell_volume() / n * wet_fraction(plane(at.lower), plane(at.upper));
      body.displaced[axis] += volume;
      body.moment[axis] += volume * at.face;
    }
    if (!grid_.description().store_upper_face[axis] && upper && owners[n - 1] >= 0 &&
        grid_.neighbor(cell, axis, 1) < 0)
      bodies_[owners[n - 1]].at_side[axis] |= distance_[cell] < 0;
  }

  void sum() {
    std::vector<double> flat;
    const auto each = [&](const auto& f) {
      for (WetBody<dim>& body : bodies_) {
        f(body.volume);
        for (int a = 0; a < dim; ++a)
          f(body.centroid[a]);
        for (int axis = 0; axis < dim; ++axis) {
          f(body.displaced[axis]);
          for (int a = 0; a < dim; ++a)
            f(body.moment[axis][a]);
        }
      }
    };
    each([&](double value) { flat.push_back(value); });
    for (const WetBody<dim>& body : bodies_)
      for (const bool at_side : body.at_side)
        flat.push_back(at_side);
    sum_all(grid_.comm(), flat.data(), static_cast<int>(flat.size()));
    const double* value = flat.data();
    each([&](double& mine) { mine = *value++; });
    for (WetBody<dim>& body : bodies_) {
      for (bool& at_side : body.at_side)
        at_side = *value++ > 0;
      if (body.volume > 0)
        body.centroid /= body.volume;
    }
  }

  const TiledGrid<dim>& grid_;
  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const CellField& distance_;
  Point<dim> gravity_;
  const SurfaceSnapshot<dim>& surface_;
  std::vector<WetBody<dim>> bodies_;
  std::vector<WaterPlane<dim>> planes_;
  mutable std::vector<int> candidates_;
};
}  // namespace

template <int dim>
std::vector<WetBody<dim>> find_wet_bodies(const MacDomain<dim>& domain,
                                          const MacGeometry<dim>& geometry,
                                          const CellField& distance, const Point<dim>& gravity) {
  if (!geometry.state.surface)
    return {};
  return WetBodyFinder<dim>(domain, geometry, distance, gravity).find();
}

template std::vector<WetBody<2>> find_wet_bodies<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                                    const CellField&, const Point<2>&);
template std::vector<WetBody<3>> find_wet_bodies<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                                    const CellField&, const Point<3>&);

}  // namespace lockstep
