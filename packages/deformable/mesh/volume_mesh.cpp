#include "deformable/mesh/volume_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// Sides of a simplex of positive volume, seen from outside; side k is opposite corner k.
template <int dim>
std::array<std::array<int, dim>, dim + 1> sides() {
  if constexpr (dim == 2) {
    return {{{1, 2}, {2, 0}, {0, 1}}};
  } else {
    return {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  }
}

template <int dim>
struct Side {
  std::array<int, dim> sorted, corners;
  int element;
};

template <int dim>
std::vector<Side<dim>> sorted_sides(const VolumeMesh<dim>& mesh) {
  std::vector<Side<dim>> all;
  all.reserve(mesh.elements.size() * (dim + 1));
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    for (const auto& local : sides<dim>()) {
      Side<dim> side;
      for (int k = 0; k < dim; ++k)
        side.corners[k] = mesh.elements[e][local[k]];
      side.sorted = side.corners;
      std::sort(side.sorted.begin(), side.sorted.end());
      side.element = e;
      all.push_back(side);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.sorted < b.sorted; });
  return all;
}

template <int dim>
void check_corners(const VolumeMesh<dim>& mesh, const std::string& heading,
                   const MeshNames& names) {
  const int n_vertices = static_cast<int>(mesh.vertices.size());
  check_input(!mesh.elements.empty(), "{} has no {}.", heading,
              dim == 2 ? "triangles" : "tetrahedra");
  std::vector<char> used(n_vertices, 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (const int v : mesh.elements[e]) {
      if (v < 0 || v >= n_vertices)
        throw InputError(fmt::format("{}: {} refers to vertex {}, but the vertices are 0 to {}.",
                                     heading, simplex_text(names, static_cast<int>(e), dim + 1), v,
                                     n_vertices - 1));
      used[v] = 1;
    }
  }
  for (int v = 0; v < n_vertices; ++v) {
    if (mesh.vertices[v].allFinite() && used[v])
      continue;
    throw InputError(fmt::format(
        "{}: {} {}.", heading, vertex_text<dim>(names, v, mesh.vertices[v]),
        used[v] ? "is not a finite point" : "belongs to no element and would have no mass"));
  }
}

/// "element 7 (line 12) about (0, 0.5, 1)".
template <int dim>
std::string element_text(const VolumeMesh<dim>& mesh, const MeshNames& names, int element) {
  Point<dim> middle = Point<dim>::Zero();
  for (const int v : mesh.elements[element])
    middle += mesh.vertices[v] / (dim + 1);
  return fmt::format("{} about {}", simplex_text(names, element, dim + 1), point_text<dim>(middle));
}

}  // namespace

template <int dim>
double element_volume(const VolumeMesh<dim>& mesh, int element) {
  const auto& corners = mesh.elements[element];
  Eigen::Matrix<double, dim, dim> edges;
  for (int k = 0; k < dim; ++k)
    edges.col(k) = mesh.vertices[corners[k + 1]] - mesh.vertices[corners[0]];
  return edges.determinant() / (dim == 2 ? 2 : 6);
}

template <int dim>
double element_quality(const VolumeMesh<dim>& mesh, int element) {
  const auto& corners = mesh.elements[element];
  double sum = 0;
  for (int i = 0; i <= dim; ++i) {
    for (int j = 0; j < i; ++j)
      sum += (mesh.vertices[corners[i]] - mesh.vertices[corners[j]]).squaredNorm();
  }
  const int n_edges = dim * (dim + 1) / 2;
  const double edge = std::sqrt(sum / n_edges);
  if (edge == 0)
    return 0;
  // volume of the regular simplex of edge one: sqrt(3)/4 and sqrt(2)/12
  const double regular = dim == 2 ? 0.43301270189221932 : 0.11785113019775792;
  return element_volume(mesh, element) / (regular * std::pow(edge, dim));
}

template <int dim>
double mesh_volume(const VolumeMesh<dim>& mesh) {
  double volume = 0;
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e)
    volume += element_volume(mesh, e);
  return volume;
}

template <int dim>
void orient_elements(VolumeMesh<dim>& mesh) {
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    if (element_volume(mesh, e) < 0)
      std::swap(mesh.elements[e][0], mesh.elements[e][1]);
  }
}

template <int dim>
void check_volume_mesh(VolumeMesh<dim>& mesh, const std::string& name, double worst_quality,
                       const MeshNames& names) {
  const std::string heading = heading_text("Mesh", name, names);
  check_corners(mesh, heading, names);
  const int n = static_cast<int>(mesh.elements.size());
  std::vector<int> inverted, flat;
  double worst = 1;
  for (int e = 0; e < n; ++e) {
    if (element_volume(mesh, e) < 0)
      inverted.push_back(e);
    const double quality = std::abs(element_quality(mesh, e));
    if (!(quality >= worst_quality))
      flat.push_back(e);
    worst = std::min(worst, quality);
  }
  if (static_cast<int>(inverted.size()) == n) {
    orient_elements(mesh);
  } else if (!inverted.empty()) {
    throw InputError(fmt::format(
        "{}: {} is inverted (signed volume {:g}), one of {} of {} elements; repair the order of "
        "its corners, or let \"Orient\" do so.",
        heading, element_text(mesh, names, inverted.front()),
        element_volume(mesh, inverted.front()), inverted.size(), n));
  }
  if (flat.empty())
    return;
  throw InputError(fmt::format(
      "{}: {} is almost flat (quality {:.2g}), one of {} of {} elements under the least of "
      "{:.2g}, the worst of them has {:.2g}; improve the mesh, or accept less with \"Worst "
      "Quality\".",
      heading, element_text(mesh, names, flat.front()), element_quality(mesh, flat.front()),
      flat.size(), n, worst_quality, worst));
}

template <int dim>
BoundarySurface<dim> extract_surface(const VolumeMesh<dim>& mesh, const std::string& name,
                                     const MeshNames& names) {
  const std::vector<Side<dim>> all = sorted_sides(mesh);
  std::vector<Side<dim>> boundary;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next].sorted == all[i].sorted)
      ++next;
    if (next - i > 2)
      throw InputError(
          fmt::format("{}: {}, {} and {} share one side; a side has at most two elements.",
                      heading_text("Mesh", name, names), element_text(mesh, names, all[i].element),
                      element_text(mesh, names, all[i + 1].element),
                      element_text(mesh, names, all[i + 2].element)));
    if (next - i == 1)
      boundary.push_back(all[i]);
    i = next;
  }
  std::stable_sort(boundary.begin(), boundary.end(),
                   [](const auto& a, const auto& b) { return a.element < b.element; });
  BoundarySurface<dim> result;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const Side<dim>& side : boundary) {
    std::array<int, dim> corners;
    for (int k = 0; k < dim; ++k) {
      int& n = number[side.corners[k]];
      if (n < 0) {
        n = static_cast<int>(result.vertices.size());
        result.vertices.push_back(side.corners[k]);
        result.surface.vertices.push_back(mesh.vertices[side.corners[k]]);
      }
      corners[k] = n;
    }
    result.surface.simplices.push_back(corners);
  }
  return result;
}

template double element_volume<2>(const VolumeMesh<2>&, int);
template double element_volume<3>(const VolumeMesh<3>&, int);
template double element_quality<2>(const VolumeMesh<2>&, int);
template double element_quality<3>(const VolumeMesh<3>&, int);
template double mesh_volume<2>(const VolumeMesh<2>&);
template double mesh_volume<3>(const VolumeMesh<3>&);
template void orient_elements<2>(VolumeMesh<2>&);
template void orient_elements<3>(VolumeMesh<3>&);
template void check_volume_mesh<2>(VolumeMesh<2>&, const std::string&, double, const MeshNames&);
template void check_volume_mesh<3>(VolumeMesh<3>&, const std::string&, double, const MeshNames&);
template BoundarySurface<2> extract_surface<2>(const VolumeMesh<2>&, const std::string&,
                                               const MeshNames&);
template BoundarySurface<3> extract_surface<3>(const VolumeMesh<3>&, const std::string&,
                                               const MeshNames&);

}  // namespace lockstep
