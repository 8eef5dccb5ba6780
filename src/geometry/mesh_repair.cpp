#include "geometry/mesh_repair.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/surface_parts.hpp"
#include "geometry/unused_vertices.hpp"

namespace lockstep {

namespace {

/// For each vertex the earliest kept one closer than `distance`, or itself.
template <int dim>
std::vector<int> find_twins(const std::vector<Point<dim>>& vertices, double distance) {
  using Bin = std::array<double, dim>;
  std::map<Bin, std::vector<int>> kept;
  std::vector<int> twin(vertices.size());
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    Bin bin;
    for (int a = 0; a < dim; ++a)
      bin[a] = std::floor(vertices[v][a] / distance);
    twin[v] = v;
    for (int k = 0, n = dim == 2 ? 9 : 27; k < n; ++k) {
      Bin beside = bin;
      for (int a = 0, rest = k; a < dim; ++a, rest /= 3)
        beside[a] += rest % 3 - 1;
      const auto found = kept.find(beside);
      if (found == kept.end())
        continue;
      for (const int other : found->second)
        if ((vertices[other] - vertices[v]).norm() < distance)
          twin[v] = std::min(twin[v], other);
    }
    if (twin[v] == v)
      kept[bin].push_back(v);
  }
  return twin;
}

template <std::size_t n_corners>
bool has_all_corners(std::array<int, n_corners> simplex) {
  std::sort(simplex.begin(), simplex.end());
  return std::adjacent_find(simplex.begin(), simplex.end()) == simplex.end();
}

}  // namespace

void declare_mesh_repair(ParameterList& geometry) {
  declare_optional<double>(geometry, "Scale",
                           "Factor on the coordinates of the file [1]; default 1.");
  declare_optional<double>(geometry, "Weld",
                           "Vertices of the file that lie closer together than this, after "
                           "\"Scale\", become one [m]; default: none do.");
  for (const char* name : {"Scale", "Weld"})
    set_positive(geometry, name);
  declare_optional<bool>(geometry, "Orient",
                         "Turn simplices of the file so that neighbours agree in orientation and "
                         "closed surfaces face out of the solid, those of holes into the hole; "
                         "default false: such files are refused.");
}

MeshRepair read_mesh_repair(const ParameterList& geometry) {
  MeshRepair repair;
  if (geometry.isParameter("Scale"))
    repair.scale = geometry.get<double>("Scale");
  if (geometry.isParameter("Weld"))
    repair.weld = geometry.get<double>("Weld");
  if (geometry.isParameter("Orient"))
    repair.orient = geometry.get<bool>("Orient");
  return repair;
}

const std::vector<std::string>& mesh_repair_parameters() {
  static const std::vector<std::string> names{"Scale", "Weld", "Orient"};
  return names;
}

template <int dim, std::size_t n_corners>
void scale_and_weld(const MeshRepair& repair, std::vector<Point<dim>>& vertices,
                    std::vector<std::array<int, n_corners>>& simplices, MeshNames& names) {
  for (Point<dim>& vertex : vertices)
    vertex *= repair.scale;
  if (repair.weld <= 0)
    return;
  const std::vector<int> twin = find_twins(vertices, repair.weld);
  std::size_t n_left = 0;
  for (std::size_t s = 0; s < simplices.size(); ++s) {
    auto simplex = simplices[s];
    for (int& corner : simplex)
      corner = twin[corner];
    if (!has_all_corners(simplex))
      continue;
    for (auto* labels : {&names.simplices, &names.simplex_lines})
      if (!labels->empty())
        (*labels)[n_left] = (*labels)[s];
    simplices[n_left++] = simplex;
  }
  check_input(n_left > 0,
              "{}: \"Weld\" = {:g} m leaves nothing of the mesh; it must be smaller than the "
              "edges.",
              names.file, repair.weld);
  simplices.resize(n_left);
  for (auto* labels : {&names.simplices, &names.simplex_lines})
    if (!labels->empty())
      labels->resize(n_left);
  drop_unused_vertices(vertices, simplices, names.vertices);
}

template <int dim>
void repair_surface(const ParameterList& geometry, SurfaceMesh<dim>& mesh, MeshNames& names) {
  const MeshRepair repair = read_mesh_repair(geometry);
  scale_and_weld(repair, mesh.vertices, mesh.simplices, names);
  if (repair.orient)
    orient_surface(mesh);
}

template void scale_and_weld<2, 2>(const MeshRepair&, std::vector<Point<2>>&,
                                   std::vector<std::array<int, 2>>&, MeshNames&);
template void scale_and_weld<2, 3>(const MeshRepair&, std::vector<Point<2>>&,
                                   std::vector<std::array<int, 3>>&, MeshNames&);
template void scale_and_weld<3, 3>(const MeshRepair&, std::vector<Point<3>>&,
                                   std::vector<std::array<int, 3>>&, MeshNames&);
template void scale_and_weld<3, 4>(const MeshRepair&, std::vector<Point<3>>&,
                                   std::vector<std::array<int, 4>>&, MeshNames&);
template void repair_surface(const ParameterList&, SurfaceMesh<2>&, MeshNames&);
template void repair_surface(const ParameterList&, SurfaceMesh<3>&, MeshNames&);

}  // namespace lockstep
