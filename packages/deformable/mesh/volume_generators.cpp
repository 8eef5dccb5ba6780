#include "deformable/mesh/volume_generators.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "geometry/surface_builder.hpp"

namespace lockstep {

namespace {

/// The paths from (0, ..) to (1, ..) of a unit cube along its edges: the corners of its Kuhn
/// simplices.
template <int dim>
std::vector<std::array<Index<dim>, dim + 1>> kuhn_simplices() {
  std::array<int, dim> order;
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::array<Index<dim>, dim + 1>> all;
  do {
    std::array<Index<dim>, dim + 1> path{};
    for (int k = 0; k < dim; ++k) {
      path[k + 1] = path[k];
      path[k + 1][order[k]] += 1;
    }
    all.push_back(path);
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

/// Vertices that are made once for each key.
template <int dim, typename Key>
class VertexPool {
 public:
  explicit VertexPool(VolumeMesh<dim>& mesh) : mesh_(mesh) {}
  template <typename Place>
  int at(const Key& key, const Place& place) {
    const auto [entry, is_new] = numbers_.emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new)
      mesh_.vertices.push_back(place());
    return entry->second;
  }

 private:
  VolumeMesh<dim>& mesh_;
  std::map<Key, int> numbers_;
};

/// Cones from the origin over the sides of a polyhedron (of corners at distance one), each cut into
/// n^dim simplices; layer k of n is blown up to the sphere of radius k/n. The lattice points of a
/// cone are n >= i_0 >= i_1 >= .. >= 0 with its corners in ascending order, so that neighbours fit.
template <int dim>
VolumeMesh<dim> round_cones(const SurfaceMesh<dim>& polyhedron, int n) {
  VolumeMesh<dim> mesh;
  VertexPool<dim, std::map<int, int>> pool(mesh);
  const auto simplices = kuhn_simplices<dim>();
  for (auto side : polyhedron.simplices) {
    std::sort(side.begin(), side.end());
    const auto inside = [n](const Index<dim>& i) {
      return i[0] <= n && std::is_sorted(i.rbegin(), i.rend()) && i[dim - 1] >= 0;
    };
    const auto vertex = [&](const Index<dim>& i) {
      std::map<int, int> weights;  // weights of the corners; the rest belongs to the origin
      Point<dim> x = Point<dim>::Zero();
      for (int k = 0; k < dim; ++k) {
        const int weight = k + 1 < dim ? i[k] - i[k + 1] : i[k];
        if (weight > 0)
          weights[side[k]] = weight;
        x += weight * polyhedron.vertices[side[k]];
      }
      return pool.at(weights, [&]() -> Point<dim> {
        return i[0] == 0 ? x : Point<dim>(x.normalized() * i[0] / n);
      });
    };
    Index<dim> cube{};
    const auto visit = [&](const auto& self, int axis) -> void {
      if (axis < dim) {
        for (cube[axis] = 0; cube[axis] < n; ++cube[axis])
          self(self, axis + 1);
        return;
      }
      for (const auto& path : simplices) {
        std::array<Index<dim>, dim + 1> corners;
        bool all_inside = true;
        for (int c = 0; c <= dim; ++c) {
          for (int a = 0; a < dim; ++a)
            corners[c][a] = cube[a] + path[c][a];
          all_inside = all_inside && inside(corners[c]);
        }
        if (!all_inside)
          continue;
        typename VolumeMesh<dim>::Element element;
        for (int c = 0; c <= dim; ++c)
          element[c] = vertex(corners[c]);
        mesh.elements.push_back(element);
      }
    };
    visit(visit, 0);
  }
  orient_elements(mesh);
  return mesh;
}

SurfaceMesh<2> hexagon() {
  SurfaceMesh<2> mesh;
  for (int k = 0; k < 6; ++k) {
    mesh.vertices.push_back({std::cos(pi / 3 * k), std::sin(pi / 3 * k)});
    mesh.simplices.push_back({k, (k + 1) % 6});
  }
  return mesh;
}

SurfaceMesh<3> icosahedron() {
  SurfaceMesh<3> mesh;
  const double g = 0.5 * (1 + std::sqrt(5.0));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double one : {-1.0, 1.0}) {
      for (const double golden : {-g, g}) {
        Point<3> x = Point<3>::Zero();
        x[(axis + 1) % 3] = one;
        x[(axis + 2) % 3] = golden;
        mesh.vertices.push_back(x);
      }
    }
  }
  const auto adjacent = [&](int a, int b) {
    return std::abs((mesh.vertices[a] - mesh.vertices[b]).norm() - 2) < rounding::differences;
  };
  for (int a = 0; a < 12; ++a) {
    for (int b = 0; b < a; ++b) {
      for (int c = 0; c < b; ++c) {
        if (adjacent(a, b) && adjacent(b, c) && adjacent(a, c))
          mesh.simplices.push_back({a, b, c});
      }
    }
  }
  for (auto& vertex : mesh.vertices)
    vertex.normalize();
  return mesh;
}

/// Scales about the origin, only the first `n_axes` axes, to the volume wanted.
template <int dim>
void scale_to_volume(VolumeMesh<dim>& mesh, double volume, int n_axes) {
  const double factor = std::pow(volume / mesh_volume(mesh), 1.0 / n_axes);
  for (auto& vertex : mesh.vertices)
    vertex.head(n_axes) *= factor;
}

/// Prisms between copies of a plane mesh, each of them three tetrahedra. Layers of a ring close.
VolumeMesh<3> extruded(const VolumeMesh<2>& section, int n_layers, bool ring) {
  VolumeMesh<3> mesh;
  const int n = static_cast<int>(section.vertices.size());
  for (int layer = 0; layer < n_layers + (ring ? 0 : 1); ++layer) {
    for (const auto& x : section.vertices)
      mesh.vertices.push_back({x.x(), x.y(), static_cast<double>(layer) / n_layers});
  }
  for (int layer = 0; layer < n_layers; ++layer) {
    const int below = layer * n, above = (ring ? (layer + 1) % n_layers : layer + 1) * n;
    for (auto t : section.elements) {
      std::sort(t.begin(), t.end());  // neighbours cut their common side the same way
      mesh.elements.push_back({below + t[0], below + t[1], below + t[2], above + t[2]});
      mesh.elements.push_back({below + t[0], below + t[1], above + t[1], above + t[2]});
      mesh.elements.push_back({below + t[0], above + t[0], above + t[1], above + t[2]});
    }
  }
  return mesh;
}

}  // namespace

template <int dim>
VolumeMesh<dim> box_volume(const Point<dim>& size, double spacing) {
  check_shape("Box", size.minCoeff(), size.maxCoeff(), spacing);
  Index<dim> n;
  std::size_t n_cubes = 1;
  for (int a = 0; a < dim; ++a) {
    n[a] = n_steps(size[a], spacing);
    n_cubes *= n[a];
  }
  VolumeMesh<dim> mesh;
  VertexPool<dim, Index<dim>> pool(mesh);
  const auto simplices = kuhn_simplices<dim>();
  for (std::size_t c = 0; c < n_cubes; ++c) {
    Index<dim> cube;
    std::size_t rest = c;
    for (int a = 0; a < dim; ++a) {
      cube[a] = static_cast<int>(rest % n[a]);
      rest /= n[a];
    }
    for (const auto& path : simplices) {
      typename VolumeMesh<dim>::Element element;
      for (int k = 0; k <= dim; ++k) {
        Index<dim> i;
        Point<dim> x;
        for (int a = 0; a < dim; ++a) {
          i[a] = cube[a] + (cube[a] % 2 == 0 ? path[k][a] : 1 - path[k][a]);
          x[a] = (static_cast<double>(i[a]) / n[a] - 0.5) * size[a];
        }
        element[k] = pool.at(i, [&] { return x; });
      }
      mesh.elements.push_back(element);
    }
  }
  orient_elements(mesh);
  return mesh;
}

template <int dim>
VolumeMesh<dim> ball_volume(double radius, double spacing) {
  check_shape("Ball", radius, radius, spacing);
  const int n = n_steps(radius, spacing);
  VolumeMesh<dim> mesh;
  if constexpr (dim == 2) {
    mesh = round_cones<2>(hexagon(), n);
  } else {
    mesh = round_cones<3>(icosahedron(), n);
  }
  scale_to_volume(mesh, (dim == 2 ? pi : 4 * pi / 3) * std::pow(radius, dim), dim);
  return mesh;
}

template <int dim>
VolumeMesh<dim> cylinder_volume(double radius, double length, double spacing) {
  if constexpr (dim == 2) {
    return box_volume<2>({2 * radius, length}, spacing);
  } else {
    check_shape("Cylinder", std::min(radius, length), std::max(radius, length), spacing);
    VolumeMesh<3> mesh = extruded(ball_volume<2>(radius, spacing), n_steps(length, spacing), false);
    for (auto& x : mesh.vertices)
      x.z() = (x.z() - 0.5) * length;
    orient_elements(mesh);
    return mesh;
  }
}

template <int dim>
VolumeMesh<dim> torus_volume(double radius, double tube, double spacing) {
  if constexpr (dim == 2) {
    throw InputError("A torus exists in 3D only; in 2D use \"ball\" or a mesh file.");
  } else {
    check_shape("Torus", tube, radius, spacing);
    check_input(tube < radius,
                "Torus: the radius of the tube ({} m) must be smaller than that of the ring "
                "({} m), or it meets itself.",
                tube, radius);
    const int n_layers = std::max(3, n_steps(2 * pi * radius, spacing));
    VolumeMesh<3> mesh = extruded(ball_volume<2>(tube, spacing), n_layers, true);
    for (auto& x : mesh.vertices) {
      const double angle = 2 * pi * x.z(), r = radius + x.x(), z = x.y();
      x = {r * std::cos(angle), r * std::sin(angle), z};
    }
    orient_elements(mesh);
    scale_to_volume(mesh, 2 * pi * radius * pi * tube * tube, 3);
    return mesh;
  }
}

namespace {
double between_stations(const SpindleShape& shape, const std::vector<double>& values, double x) {
  const auto& at = shape.stations;
  const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, x) - at.begin();
  const double part = (x - at[above - 1]) / (at[above] - at[above - 1]);
  return (1 - part) * values[above - 1] + part * values[above];
}
}  // namespace

template <int dim>
VolumeMesh<dim> spindle_volume(const SpindleShape& shape, double spacing) {
  const auto ascends = [&](double a, double b) { return a >= b; };
  const auto& at = shape.stations;
  const std::size_t n = at.size();
  check_input(n >= 2 && std::adjacent_find(at.begin(), at.end(), ascends) == at.end(),
              "Spindle: the places of the sections must ascend, two or more.");
  check_input(shape.half_heights.size() == n && (dim == 2 || shape.half_widths.size() == n),
              "Spindle: there are {} places, so there must be as many half heights and widths.", n);
  const double length = at.back() - at.front();
  double half = *std::max_element(shape.half_heights.begin(), shape.half_heights.end());
  if constexpr (dim == 2) {
    VolumeMesh<2> mesh = box_volume<2>({length, 2 * half}, spacing);
    for (auto& x : mesh.vertices) {
      x.x() += at.front() + 0.5 * length;
      x.y() *= between_stations(shape, shape.half_heights, x.x()) / half;
    }
    return mesh;
  } else {
    half = std::max(half, *std::max_element(shape.half_widths.begin(), shape.half_widths.end()));
    check_shape("Spindle", std::min(half, length), std::max(half, length), spacing);
    VolumeMesh<3> mesh = extruded(ball_volume<2>(half, spacing), n_steps(length, spacing), false);
    for (auto& v : mesh.vertices) {
      const double x = at.front() + v.z() * length;
      v = {x, v.x() / half * between_stations(shape, shape.half_heights, x),
           v.y() / half * between_stations(shape, shape.half_widths, x)};
    }
    orient_elements(mesh);
    return mesh;
  }
}

template VolumeMesh<2> spindle_volume<2>(const SpindleShape&, double);
template VolumeMesh<3> spindle_volume<3>(const SpindleShape&, double);
template VolumeMesh<2> box_volume<2>(const Point<2>&, double);
template VolumeMesh<3> box_volume<3>(const Point<3>&, double);
template VolumeMesh<2> ball_volume<2>(double, double);
template VolumeMesh<3> ball_volume<3>(double, double);
template VolumeMesh<2> cylinder_volume<2>(double, double, double);
template VolumeMesh<3> cylinder_volume<3>(double, double, double);
template VolumeMesh<2> torus_volume<2>(double, double, double);
template VolumeMesh<3> torus_volume<3>(double, double, double);

}  // namespace lockstep
