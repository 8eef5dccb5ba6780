#include "studies/surface_rows.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "output/xdmf.hpp"
#include "studies/frame_file.hpp"

namespace lockstep {

namespace {

using Vector = Eigen::Vector3d;

/// Surface of one frame; in 2D z = 0.
struct Surface {
  std::vector<Vector> vertices;
  int corners = 0;  ///< corners of a simplex: 2 or 3
  std::vector<int> simplices;
};

Surface read_surface(const FrameFile& file, const std::string& solid) {
  const std::string group = "/solids/" + xdmf::stored_name(solid);
  const auto vertices = file.dataset(group + "/vertices");
  const auto simplices = file.dataset(group + "/simplices");
  check_output(
      vertices.extents.size() == 2 && vertices.extents[1] == 3 && simplices.extents.size() == 2,
      "The surface of \"{}\" has an unknown shape.", solid);
  Surface surface;
  for (std::size_t v = 0; v < vertices.extents[0]; ++v)
    surface.vertices.emplace_back(Eigen::Map<const Vector>(&vertices.values[3 * v]));
  surface.corners = static_cast<int>(simplices.extents[1]);
  surface.simplices.assign(simplices.values.begin(), simplices.values.end());
  return surface;
}

std::size_t nearest_vertex(const Surface& surface, const Vector& point) {
  std::size_t nearest = 0;
  for (std::size_t v = 1; v < surface.vertices.size(); ++v) {
    if ((surface.vertices[v] - point).norm() < (surface.vertices[nearest] - point).norm())
      nearest = v;
  }
  return nearest;
}

void add_sizes(const Surface& surface, const Vector& point, Variables& row) {
  double volume = 0, area = 0;
  const std::size_t n = surface.corners;
  for (std::size_t s = 0; s + n <= surface.simplices.size(); s += n) {
    const auto arm = [&](std::size_t k) -> Vector {
      return surface.vertices[surface.simplices[s + k]] - point;
    };
    const Vector a = arm(0), b = arm(1);
    if (n == 2) {
      volume += a.cross(b).z() / 2;
      area += (b - a).norm();
    } else {
      const Vector c = arm(2);
      volume += a.dot(b.cross(c)) / 6;
      area += (b - a).cross(c - a).norm() / 2;
    }
  }
  row["volume"] = volume;
  row["area"] = area;
}

/// Adds the extents of the box around the surface.
void add_extents(const Surface& surface, Variables& row) {
  Eigen::AlignedBox3d box;
  for (const Vector& vertex : surface.vertices)
    box.extend(vertex);
  for (int a = 0; a < 3; ++a)
    row[std::string("xyz").substr(a, 1) + "_extent"] = box.sizes()[a];
}

}  // namespace

std::vector<Variables> read_surface_rows(const std::string& run_directory, const std::string& solid,
                                         const std::array<double, 3>& point) {
  const Vector origin(point[0], point[1], point[2]);
  std::vector<Variables> rows;
  std::size_t vertex = 0, n_vertices = 0;
  for (const std::string& path : frame_files(run_directory)) {
    const FrameFile file(path);
    const Surface surface = read_surface(file, solid);
    if (rows.empty() || surface.vertices.size() != n_vertices)
      vertex = nearest_vertex(surface, origin);
    n_vertices = surface.vertices.size();
    check_output(n_vertices > 0, "The surface of \"{}\" is empty in {}.", solid, path);
    Variables row;
    for (int a = 0; a < 3; ++a)
      row[std::string(1, "xyz"[a])] = surface.vertices.at(vertex)[a];
    add_sizes(surface, origin, row);
    add_extents(surface, row);
    const Variables start = rows.empty() ? row : rows.front();
    for (const char* name : {"x", "y", "z", "volume", "area", "x_extent", "y_extent", "z_extent"})
      row[std::string(name) + "0"] = start.at(name);
    row["time"] = file.attribute("/", "time");
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace lockstep
