#include "geometry/surface_mesh.hpp"

#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// A rim of a simplex: an edge in 3D (its vertices in ascending order), a vertex in 2D (twice).
struct Rim {
  int first = 0, second = 0;
  int direction =
      0;  ///< of traversal: +1 or -1; two neighbours of like orientation have opposite ones
  int simplex = 0;
};

template <int dim>
std::vector<Rim> sorted_rims(const SurfaceMesh<dim>& mesh) {
  std::vector<Rim> rims;
  rims.reserve(mesh.simplices.size() * dim);
  for (int s = 0; s < static_cast<int>(mesh.simplices.size()); ++s) {
    const auto& simplex = mesh.simplices[s];
    if constexpr (dim == 2) {
      rims.push_back({simplex[0], simplex[0], 1, s});
      rims.push_back({simplex[1], simplex[1], -1, s});
    } else {
      for (int k = 0; k < 3; ++k) {
        const int a = simplex[k], b = simplex[(k + 1) % 3];
        rims.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1, s});
      }
    }
  }
  std::sort(rims.begin(), rims.end(), [](const Rim& l, const Rim& r) {
    return std::array<int, 3>{l.first, l.second, l.simplex} <
           std::array<int, 3>{r.first, r.second, r.simplex};
  });
  return rims;
}

/// Why the surface is not closed, or an empty string.
template <int dim>
std::string defect_of_closure(const SurfaceMesh<dim>& mesh) {
  const std::vector<Rim> rims = sorted_rims(mesh);
  for (std::size_t i = 0, n = 0; i < rims.size(); i += n) {
    const auto same = [&](const Rim& r) {
      return r.first == rims[i].first && r.second == rims[i].second;
    };
    for (n = 1; i + n < rims.size() && same(rims[i + n]);)
      ++n;
    const std::string rim = dim == 2 ? fmt::format("vertex {}", rims[i].first)
                                     : fmt::format("edge {}-{}", rims[i].first, rims[i].second);
    if (n != 2)
      return fmt::format("{} of simplex {} is shared by {} simplices instead of two", rim,
                         rims[i].simplex, n);
    if (rims[i].direction == rims[i + 1].direction)
      return fmt::format("simplices {} and {}, which share {}, are oriented against each other",
                         rims[i].simplex, rims[i + 1].simplex, rim);
  }
  return {};
}

template <int dim>
double signed_volume(const SurfaceMesh<dim>& mesh) {
  if (mesh.vertices.empty())
    return 0;
  const Point<dim> origin = mesh.vertices.front();
  double volume = 0;
  for (const auto& simplex : mesh.simplices) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = mesh.vertices[simplex[k]] - origin;
    volume += area_vector<dim>(corners).dot(corners[0]) / dim;
  }
  return volume;
}

template <int dim>
void check_simplex(const SurfaceMesh<dim>& mesh, int s, const std::string& name) {
  const int n_vertices = static_cast<int>(mesh.vertices.size());
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k) {
    const int v = mesh.simplices[s][k];
    check_input(v >= 0 && v < n_vertices,
                "Surface '{}': simplex {} refers to vertex {}, but the vertices are 0 to {}.", name,
                s, v, n_vertices - 1);
    corners[k] = mesh.vertices[v];
  }
  double longest = 0;
  for (int k = 0; k < dim; ++k)
    longest = std::max(longest, (corners[(k + 1) % dim] - corners[k]).norm());
  const double smallest_measure = dim == 2 ? 0 : 1e-12 * longest * longest;
  check_input(area_vector<dim>(corners).norm() > smallest_measure,
              "Surface '{}': simplex {} is degenerate (its corners coincide or lie on one line); "
              "remove it from the mesh.",
              name, s);
}

}  // namespace

template <int dim>
Point<dim> area_vector(const std::array<Point<dim>, dim>& corners) {
  const Point<dim> edge = corners[1] - corners[0];
  if constexpr (dim == 2) {
    return Point<2>(edge.y(), -edge.x());
  } else {
    return 0.5 * edge.cross(corners[2] - corners[0]);
  }
}

template <int dim>
bool is_closed(const SurfaceMesh<dim>& mesh) {
  return defect_of_closure(mesh).empty();
}

template <int dim>
void check_surface(SurfaceMesh<dim>& mesh, bool closed, const std::string& name) {
  check_input(!mesh.simplices.empty(), "Surface '{}' has no simplices.", name);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    check_input(mesh.vertices[v].allFinite(), "Surface '{}': vertex {} is not a finite point.",
                name, v);
  for (int s = 0; s < static_cast<int>(mesh.simplices.size()); ++s)
    check_simplex(mesh, s, name);
  if (!closed)
    return;
  const std::string defect = defect_of_closure(mesh);
  check_input(defect.empty(),
              "Surface '{}' should enclose a volume, but {}; repair the mesh, or declare the solid "
              "a shell.",
              name, defect);
  if (signed_volume(mesh) < 0)
    for (auto& simplex : mesh.simplices)
      std::swap(simplex[0], simplex[1]);
}

template Point<2> area_vector<2>(const std::array<Point<2>, 2>&);
template Point<3> area_vector<3>(const std::array<Point<3>, 3>&);
template bool is_closed<2>(const SurfaceMesh<2>&);
template bool is_closed<3>(const SurfaceMesh<3>&);
template void check_surface<2>(SurfaceMesh<2>&, bool, const std::string&);
template void check_surface<3>(SurfaceMesh<3>&, bool, const std::string&);

}  // namespace lockstep
