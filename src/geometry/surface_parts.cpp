#include "geometry/surface_parts.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {

/// For each simplex, those that share a facet with it and no third one: {simplex, agrees}.
struct Neighbour {
  int simplex;
  bool agrees;
};

template <int dim>
std::vector<std::vector<Neighbour>> neighbours(const SurfaceMesh<dim>& mesh,
                                               std::vector<char>& at_odd_facet) {
  std::vector<std::vector<Neighbour>> result(mesh.simplices.size());
  at_odd_facet.assign(mesh.simplices.size(), 0);
  const std::vector<Facet> facets = sorted_facets(mesh);
  for_each_place(facets, [&](int i, int n) {
    if (n == 2) {
      const int a = facets[i].simplex, b = facets[i + 1].simplex;
      const bool agrees = facets[i].direction != facets[i + 1].direction;
      result[a].push_back({b, agrees});
      result[b].push_back({a, agrees});
    } else {
      for (int k = i; k < i + n; ++k)
        at_odd_facet[facets[k].simplex] = 1;
    }
  });
  return result;
}

template <int dim>
std::array<Point<dim>, dim> corners_of(const SurfaceMesh<dim>& mesh, int s,
                                       const Point<dim>& origin) {
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k)
    corners[k] = mesh.vertices[mesh.simplices[s][k]] - origin;
  return corners;
}

template <int dim>
double signed_volume(const SurfaceMesh<dim>& mesh, const std::vector<int>& simplices) {
  const Point<dim> origin = mesh.vertices[mesh.simplices[simplices.front()][0]];
  double volume = 0;
  for (const int s : simplices) {
    const auto corners = corners_of<dim>(mesh, s, origin);
    volume += area_vector<dim>(corners).dot(corners[0]) / dim;
  }
  return volume;
}

/// Angle under which a simplex is seen from the origin, by the whole angle.
double seen(const std::array<Point<2>, 2>& c) {
  const double cross = c[0].x() * c[1].y() - c[0].y() * c[1].x();
  return std::atan2(cross, c[0].dot(c[1])) / (2 * EIGEN_PI);
}
double seen(const std::array<Point<3>, 3>& c) {
  const double a = c[0].norm(), b = c[1].norm(), d = c[2].norm();
  const double volume = c[0].dot(c[1].cross(c[2]));
  const double product = a * b * d + c[0].dot(c[1]) * d + c[1].dot(c[2]) * a + c[2].dot(c[0]) * b;
  return 2 * std::atan2(volume, product) / (4 * EIGEN_PI);
}

template <int dim>
Point<dim> middle(const SurfaceMesh<dim>& mesh, int simplex) {
  Point<dim> sum = Point<dim>::Zero();
  for (const int v : mesh.simplices[simplex])
    sum += mesh.vertices[v];
  return sum / dim;
}

/// True if `part` lies inside the closed `other`. Where the two touch, a point of it may lie on the
/// other's surface: the majority of some decides.
template <int dim>
bool is_inside(const SurfaceMesh<dim>& mesh, const SurfacePart<dim>& part,
               const SurfacePart<dim>& other, const Box<dim>& box) {
  constexpr std::size_t n_wanted = 9;
  const std::size_t step = std::max<std::size_t>(1, part.simplices.size() / n_wanted);
  int n_inside = 0, n_samples = 0;
  for (std::size_t i = 0; i < part.simplices.size(); i += step, ++n_samples) {
    const Point<dim> place = middle(mesh, part.simplices[i]);
    if (!box.contains(place))
      continue;
    double winding = 0;
    for (const int s : other.simplices)
      winding += seen(corners_of<dim>(mesh, s, place));
    n_inside += std::abs(winding) > 0.5 ? 1 : 0;
  }
  return 2 * n_inside > n_samples;
}

template <int dim>
void find_depths(const SurfaceMesh<dim>& mesh, std::vector<SurfacePart<dim>>& parts) {
  std::vector<Box<dim>> boxes(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const int s : parts[p].simplices)
      for (const int v : mesh.simplices[s])
        boxes[p].extend(mesh.vertices[v]);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t q = 0; q < parts.size(); ++q) {
      if (p != q && parts[q].closed && boxes[q].intersects(boxes[p]) &&
          is_inside(mesh, parts[p], parts[q], boxes[q]))
        ++parts[p].depth;
    }
  }
}

/// Calls f(simplex, agrees with the first of its part) along neighbours, part after part;
/// begin(simplex) at the first of a part.
template <typename Begin, typename Function>
void walk(const std::vector<std::vector<Neighbour>>& next, const Begin& begin, const Function& f) {
  std::vector<char> known(next.size(), 0), agrees(next.size(), 1);
  std::vector<int> waiting;
  for (int first = 0; first < static_cast<int>(next.size()); ++first) {
    if (known[first])
      continue;
    begin(first);
    known[first] = 1;
    waiting.push_back(first);
    while (!waiting.empty()) {
      const int s = waiting.back();
      waiting.pop_back();
      f(s, agrees[s] != 0);
      for (const Neighbour& other : next[s]) {
        if (known[other.simplex])
          continue;
        known[other.simplex] = 1;
        agrees[other.simplex] = agrees[s] == (other.agrees ? 1 : 0);
        waiting.push_back(other.simplex);
      }
    }
  }
}

}  // namespace

template <int dim>
std::vector<Facet> sorted_facets(const SurfaceMesh<dim>& mesh) {
  std::vector<Facet> facets;
  facets.reserve(mesh.simplices.size() * dim);
  for (int s = 0; s < static_cast<int>(mesh.simplices.size()); ++s) {
    const auto& simplex = mesh.simplices[s];
    if constexpr (dim == 2) {
      facets.push_back({simplex[0], simplex[0], 1, s});
      facets.push_back({simplex[1], simplex[1], -1, s});
    } else {
      for (int k = 0; k < 3; ++k) {
        const int a = simplex[k], b = simplex[(k + 1) % 3];
        facets.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1, s});
      }
    }
  }
  std::sort(facets.begin(), facets.end(), [](const Facet& l, const Facet& r) {
    return std::array<int, 3>{l.first, l.second, l.simplex} <
           std::array<int, 3>{r.first, r.second, r.simplex};
  });
  return facets;
}

template <int dim>
std::vector<SurfacePart<dim>> surface_parts(const SurfaceMesh<dim>& mesh) {
  std::vector<char> at_odd_facet;
  const auto next = neighbours(mesh, at_odd_facet);
  std::vector<SurfacePart<dim>> parts;
  walk(
      next, [&](int) { parts.emplace_back().closed = true; },
      [&](int s, bool) {
        parts.back().simplices.push_back(s);
        parts.back().closed = parts.back().closed && !at_odd_facet[s];
      });
  for (SurfacePart<dim>& part : parts)
    part.volume = part.closed ? signed_volume(mesh, part.simplices) : 0;
  if (parts.size() > 1)
    find_depths(mesh, parts);
  return parts;
}

template <int dim>
void orient_surface(SurfaceMesh<dim>& mesh) {
  const auto turn = [&](int s) { std::swap(mesh.simplices[s][0], mesh.simplices[s][1]); };
  std::vector<char> at_odd_facet;
  walk(
      neighbours(mesh, at_odd_facet), [](int) {},
      [&](int s, bool agrees) {
        if (!agrees)
          turn(s);
      });
  for (const SurfacePart<dim>& part : surface_parts(mesh)) {
    if (part.closed && !part.faces_right())
      std::for_each(part.simplices.begin(), part.simplices.end(), turn);
  }
}

template std::vector<Facet> sorted_facets(const SurfaceMesh<2>&);
template std::vector<Facet> sorted_facets(const SurfaceMesh<3>&);
template std::vector<SurfacePart<2>> surface_parts(const SurfaceMesh<2>&);
template std::vector<SurfacePart<3>> surface_parts(const SurfaceMesh<3>&);
template void orient_surface(SurfaceMesh<2>&);
template void orient_surface(SurfaceMesh<3>&);

}  // namespace lockstep
