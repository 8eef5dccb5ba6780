#include "liquid/surface/surface_tension.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <optional>

#include "liquid/surface/closed_surfaces.hpp"
#include "staggered/state/face_moments.hpp"

namespace lockstep {

namespace {
/// Reach of the fit around a place of the surface [cells].
template <int dim>
constexpr int reach = dim == 2 ? 4 : 3;
/// Width of the fit's weights, a bell around the place [cells].
template <int dim>
constexpr double bell = dim == 2 ? 1.2 : 1.0;
template <int dim>
constexpr int width = 2 * reach<dim> + 1;

/// phi around a cell, mirrored at the sides of the domain; beyond the stored tiles there is air.
template <int dim>
class PhiAround {
 public:
  PhiAround(const TiledGrid<dim>& grid, const CellField& phi, int cell) {
    const Index<dim> middle = grid.coordinates(cell);
    for (int k = 0; k < n; ++k) {
      Index<dim> at = offset(k);
      for (int a = 0; a < dim; ++a) {
        at[a] += middle[a];
        const int last = grid.n_cells()[a] - 1;
        if (grid.description().periodic[a])
          continue;
        at[a] = at[a] < 0 ? -1 - at[a] : at[a] > last ? 2 * last + 1 - at[a] : at[a];
      }
      const int other = grid.cell(at);
      values_[k] = other < 0 ? 1e300 : phi[other];
    }
  }
  static constexpr int n =
      dim == 2 ? width<dim> * width<dim> : width<dim> * width<dim> * width<dim>;
  static Index<dim> offset(int k) {
    Index<dim> result;
    for (int a = 0; a < dim; ++a, k /= width<dim>)
      result[a] = k % width<dim> - reach<dim>;
    return result;
  }
  static constexpr int stride(int axis) {
    return axis == 0 ? 1 : axis == 1 ? width<dim> : width<dim> * width<dim>;
  }
  double operator[](int k) const { return values_[k]; }
  /// Central differences.
  Point<dim> slope(int k) const {
    Point<dim> result;
    for (int a = 0; a < dim; ++a)
      result[a] = 0.5 * (values_[k + stride(a)] - values_[k - stride(a)]);
    return result;
  }

 private:
  std::array<double, n> values_;
};

/// The surface near a place of it as z = c . (1, s, s^2) or (1, s, t, s^2, st, t^2) over its
/// tangent plane, with the least squares of where it crosses the lines between the centres of
/// cells: those places do not depend on how well phi is a distance farther off.
template <int dim>
class TangentFit {
 public:
  static constexpr int n = dim == 2 ? 3 : 6;
  TangentFit(const Point<dim>& origin, const Point<dim>& normal) : origin_(origin) {
    frame_.col(dim - 1) = normal;
    if constexpr (dim == 2) {
      frame_.col(0) = Point<2>(normal[1], -normal[0]);
    } else {
      int least = 0;
      normal.cwiseAbs().minCoeff(&least);
      frame_.col(0) = normal.cross(Point<3>::Unit(least)).normalized();
      frame_.col(1) = normal.cross(frame_.col(0));
    }
  }
  void add(const Point<dim>& x) {
    const Point<dim> local = frame_.transpose() * (x - origin_);
    // Bell-shaped: with a sharper end short waves would seem bent the wrong way, and grow.
    const double far = local.squaredNorm() / (2 * bell<dim> * bell<dim>), s = local[0];
    const double weight = std::exp(-far);
    Coefficients terms;
    if constexpr (dim == 2)
      terms << 1, s, s * s;
    else
      terms << 1, s, local[1], s * s, s * local[1], local[1] * local[1];
    matrix_ += weight * terms * terms.transpose();
    right_ += weight * local[dim - 1] * terms;
    ++n_points_;
  }
  /// div n [1 / cells], or nothing if there are too few places.
  std::optional<double> curvature() const {
    if (n_points_ <= n)
      return {};
    const Eigen::LDLT<Eigen::Matrix<double, n, n>> factors(matrix_);
    if (factors.rcond() < 1e-8)
      return {};
    const Coefficients c = factors.solve(right_);
    if constexpr (dim == 2)
      return -2 * c[2] / std::pow(1 + c[1] * c[1], 1.5);
    else
      return -2 * ((1 + c[2] * c[2]) * c[3] - c[1] * c[2] * c[4] + (1 + c[1] * c[1]) * c[5]) /
             std::pow(1 + c[1] * c[1] + c[2] * c[2], 1.5);
  }

 private:
  using Coefficients = Eigen::Matrix<double, n, 1>;
  Point<dim> origin_;
  Eigen::Matrix<double, dim, dim> frame_;
  Eigen::Matrix<double, n, n> matrix_ = Eigen::Matrix<double, n, n>::Zero();
  Coefficients right_ = Coefficients::Zero();
  int n_points_ = 0;
};
/// The sides of the domain around a cell. The surface there is mirrored about the plane that stands
/// on it where it meets a side at the side's contact angle: an arc that does so goes on as that
/// arc.
template <int dim>
class SidesAround {
 public:
  /// `slope`: of phi, which says in what direction along a side the liquid ends.
  SidesAround(const MacDomain<dim>& domain, int cell, const Point<dim>& slope) {
    const TiledGrid<dim>& grid = domain.grid;
    const Index<dim> middle = grid.coordinates(cell);
    for (int axis = 0; axis < dim; ++axis) {
      for (int end = 0; end < 2; ++end) {
        const double cotangent = domain.boundary.side(axis, end).contact_cotangent;
        if (cotangent == 0)
          continue;
        const double distance =
            0.5 + (end == 0 ? middle[axis] : grid.n_cells()[axis] - 1 - middle[axis]);
        Point<dim> along = slope;
        along[axis] = 0;
        // A surface along the side does not meet it.
        if (distance > reach<dim> || along.norm() < 0.1 * slope.norm())
          continue;
        sides_.push_back({axis, end == 0 ? -1. : 1., distance, cotangent * along.normalized()});
      }
    }
  }
  /// Takes a place beyond sides, mirrored about them, to where the surface goes on [cells from the
  /// cell].
  void lean(Point<dim>& x) const {
    for (const Side& side : sides_) {
      const double beyond = side.outward * x[side.axis] - side.distance;
      if (beyond > 0)
        x += 2 * beyond * side.lean;
    }
  }

 private:
  struct Side {
    int axis = 0;
    double outward = 1;   ///< along the axis
    double distance = 0;  ///< [cells] of the side
    Point<dim> lean;      ///< along the side, half of the way that one cell beyond it adds
  };
  boost::container::static_vector<Side, 2 * dim> sides_;
};
}  // namespace

template <int dim>
double curvature(const MacDomain<dim>& domain, const CellField& phi, int wet, int axis, int side,
                 double place) {
  const PhiAround<dim> around(domain.grid, phi, wet);
  using Around = PhiAround<dim>;
  const int middle = Around::n / 2, step = side == 0 ? -1 : 1;
  const Point<dim> origin = step * place * Point<dim>::Unit(axis);
  const Point<dim> slope = (1 - place) * around.slope(middle) +
                           place * around.slope(middle + step * Around::stride(axis));
  const double h = domain.spacing(), steepness = slope.norm();
  if (steepness < 1e-3 * h)
    return 0;
  TangentFit<dim> fit(origin, slope / steepness);
  const SidesAround<dim> sides(domain, wet, slope);
  for (int k = 0; k < Around::n; ++k) {
    const Index<dim> offset = Around::offset(k);
    for (int a = 0; a < dim; ++a) {
      if (offset[a] == reach<dim>)
        continue;
      const double below = around[k], above = around[k + Around::stride(a)];
      if ((below < 0) == (above < 0))
        continue;
      // skips crossings that bound another side of a thin sheet
      if ((above - below) * slope[a] < -0.3 * std::abs(above - below) * steepness)
        continue;
      Point<dim> x;
      for (int b = 0; b < dim; ++b)
        x[b] = offset[b];
      x[a] += below / (below - above);
      sides.lean(x);
      fit.add(x);
    }
  }
  const double most = dim - 1;
  return std::clamp(fit.curvature().value_or(0), -most, most) / h;
}

namespace {
/// Finds the pushes on owned faces. `is_dry`: of stored cells.
template <int dim>
std::vector<SurfacePush> find_pushes(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                     const FreeSurface<dim>& surface,
                                     const std::vector<char>& is_dry, double impulse) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<SurfacePush> pushes;
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int face) {
      if (geometry.state.faces[axis][face] != FaceState::free)
        return;
      const auto [lower, upper] = cells_of_face(grid, geometry.state.cells, axis, face);
      if (lower < 0 || upper < 0 || is_dry[lower] == is_dry[upper])
        return;
      const bool is_above = is_dry[upper];
      const int wet = is_above ? lower : upper, dry = is_above ? upper : lower;
      const double place = surface.at_true_place ? surface.crossing(wet, dry) : 1;
      const double kappa = surface.curvature(wet, axis, is_above ? 1 : 0, place);
      pushes.push_back({axis, face, (is_above ? -1 : 1) * impulse * kappa});
    });
  return pushes;
}
}  // namespace

template <int dim>
Momentum<dim> push_surface(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                           const FreeSurface<dim>& surface, double tension, double dt,
                           FaceField<dim>& velocity) {
  const auto& cells = geometry.state.cells;
  std::vector<char> is_dry(cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    is_dry[cell] =
        surface.has_gas() ? !surface.wet(static_cast<int>(cell)) : cells[cell] == CellState::air;
  std::vector<SurfacePush> pushes = find_pushes(domain, geometry, surface, is_dry, dt * tension);
  hold_closed_surfaces(domain, geometry, is_dry, pushes);
  Momentum<dim> impulse;
  auto push = pushes.begin();
  for (int axis = 0; axis < dim; ++axis) {
    FaceMoments<dim> moments(domain.grid, axis);
    for (; push != pushes.end() && push->axis == axis; ++push) {
      const double change = push->jump * geometry.face_table(axis, push->face).gradient;
      velocity[axis][push->face] += change;
      moments.add(push->face, geometry.mass(axis, push->face) * change);
    }
    impulse += moments.total();
  }
  return impulse;
}

template double curvature<2>(const MacDomain<2>&, const CellField&, int, int, int, double);
template double curvature<3>(const MacDomain<3>&, const CellField&, int, int, int, double);
template Momentum<2> push_surface<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                     const FreeSurface<2>&, double, double, FaceField<2>&);
template Momentum<3> push_surface<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                     const FreeSurface<3>&, double, double, FaceField<3>&);

}  // namespace lockstep
