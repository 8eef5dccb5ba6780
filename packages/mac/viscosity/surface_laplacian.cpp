#include "mac/viscosity/surface_laplacian.hpp"

#include <bitset>
#include <cmath>
#include <limits>

namespace lockstep {

template <int dim>
double SurfaceLaplacian<dim>::distance_at(Index<dim> place) const {
  const TiledGrid<dim>& grid = domain_.grid;
  for (int a = 0; a < dim; ++a) {
    const int last = grid.n_cells()[a] - 1;
    if (!grid.description().periodic[a])
      place[a] = place[a] < 0      ? -1 - place[a]
                 : place[a] > last ? 2 * last + 1 - place[a]
                                   : place[a];
  }
  const int cell = grid.cell(place);
  return cell < 0 ? std::numeric_limits<double>::infinity() : distance_[cell];
}

template <int dim>
bool SurfaceLaplacian<dim>::look(int axis, const Index<dim>& lowest, double& delta,
                                 Point<dim>& normal) const {
  // Along the axis the middle is that of a cell, across between two.
  const double width = 1.5 * domain_.spacing();
  double distance = 0;
  normal.setZero();
  for (int corner = 0; corner < n_corners; ++corner) {
    if (corner >> axis & 1)
      continue;
    Index<dim> place = lowest;
    for (int a = 0; a < dim; ++a)
      place[a] += corner >> a & 1;
    const double here = distance_at(place);
    distance += here;
    for (int a = 0; a < dim; ++a)
      if (a != axis)
        normal[a] += corner >> a & 1 ? here : -here;
    --place[axis];
    const double below = distance_at(place);
    place[axis] += 2;
    // All corners have this part of the gradient, over twice the distance; others are pairs.
    normal[axis] += 0.25 * (distance_at(place) - below);
  }
  distance /= n_corners / 2;
  const double steepness = normal.norm();
  if (!(std::abs(distance) < width) || !(steepness > 0) || !std::isfinite(steepness))
    return false;
  normal /= steepness;
  delta = (1 + std::cos(M_PI * distance / width)) / (2 * width);
  return true;
}

/// Part of a cube's volume in the domain: half along each axis on which it is about a side.
template <int dim>
double SurfaceLaplacian<dim>::part_in_domain(int axis, const Index<dim>& lowest) const {
  double part = 1;
  for (int a = 0; a < dim; ++a) {
    if (domain_.boundary.periodic(a))
      continue;
    const int last = domain_.grid.n_cells()[a] - 1;
    if (lowest[a] < 0 || lowest[a] >= last + (a == axis ? 1 : 0))
      part *= a == axis ? 0 : 0.5;
  }
  return part;
}

template <int dim>
bool SurfaceLaplacian<dim>::is_coupled_across(int axis, int lower, int upper, int along) const {
  const auto is_free = [&](int cell) {
    return cell >= 0 && geometry_.state.faces[axis][cell] == FaceState::free;
  };
  if (!is_free(lower) || !is_free(upper))
    return false;
  if (along == axis || !geometry_.near_surface(lower))
    return true;
  const SurfaceSnapshot<dim>& solids = *geometry_.state.surface;
  const Point<dim> start = domain_.grid.face_center(axis, lower);
  const Point<dim> end = start + Point<dim>::Unit(along) * domain_.spacing();
  return !solids.first_hit(start, end) && !solids.first_hit(end, start);
}

template <int dim>
const typename SurfaceLaplacian<dim>::Cube* SurfaceLaplacian<dim>::cube_at(
    int axis, const Index<dim>& lowest) {
  if (axis != axis_) {
    cubes_.clear();
    axis_ = axis;
  }
  std::int64_t key = 0;
  for (int a = 0; a < dim; ++a)
    key = key * (domain_.grid.n_cells()[a] + 2) + lowest[a] + 1;
  const auto [found, is_new] = cubes_.try_emplace(key);
  if (is_new && !make_cube(axis, lowest, found->second))
    found->second.is_empty = true;
  return found->second.is_empty ? nullptr : &found->second;
}

template <int dim>
bool SurfaceLaplacian<dim>::make_cube(int axis, const Index<dim>& lowest, Cube& cube) const {
  const TiledGrid<dim>& grid = domain_.grid;
  double delta = 0;
  Point<dim> normal;
  const double part = part_in_domain(axis, lowest);
  if (part == 0 || !look(axis, lowest, delta, normal))
    return false;
  for (int corner = 0; corner < n_corners; ++corner) {
    Index<dim> place = lowest;
    for (int a = 0; a < dim; ++a)
      place[a] += corner >> a & 1;
    cube.cells[corner] = grid.cell(place);
    // Never where phi is a distance. Where it jumps all corners must find the same cubes.
    if (cube.cells[corner] >= 0 && !is_near(cube.cells[corner]))
      return false;
  }
  std::array<std::bitset<dim>, n_corners> coupled;
  for (int upper = 0; upper < n_corners; ++upper) {
    for (int a = 0; a < dim; ++a) {
      const int lower = upper ^ 1 << a;
      if (upper >> a & 1)
        coupled[lower][a] = coupled[upper][a] =
            is_coupled_across(axis, cube.cells[lower], cube.cells[upper], a);
    }
  }
  // The gradient is known best at the corners from which most couplings go.
  std::array<int, n_corners> couplings{};
  int most = 0, n_used = 0;
  for (int corner = 0; corner < n_corners; ++corner) {
    couplings[corner] = static_cast<int>(coupled[corner].count());
    if (couplings[corner] > most)
      n_used = 0;
    most = std::max(most, couplings[corner]);
    n_used += couplings[corner] == most ? 1 : 0;
  }
  if (most == 0)
    return false;
  cube.form.setZero();
  const double h = domain_.spacing();
  const double weight = part * domain_.cell_volume() * delta / n_used;
  for (int corner = 0; corner < n_corners; ++corner) {
    if (couplings[corner] != most)
      continue;
    Eigen::Matrix<double, dim, n_corners> gradient = Eigen::Matrix<double, dim, n_corners>::Zero();
    for (int a = 0; a < dim; ++a) {
      if (!coupled[corner][a])
        continue;
      gradient(a, corner | 1 << a) = 1 / h;
      gradient(a, (corner | 1 << a) ^ 1 << a) = -1 / h;
    }
    Eigen::Matrix<double, dim, dim> along =
        Eigen::Matrix<double, dim, dim>::Identity() - normal * normal.transpose();
    // A single coupling does not know how u changes across the surface: it is taken not to.
    if (most == 1)
      for (int a = 0; a < dim; ++a)
        along(a, a) = std::min(1.0, 2 * along(a, a));
    cube.form += weight * gradient.transpose() * along * gradient;
  }
  return true;
}

template class SurfaceLaplacian<2>;
template class SurfaceLaplacian<3>;

}  // namespace lockstep
