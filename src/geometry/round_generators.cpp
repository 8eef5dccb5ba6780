// Round surfaces: ball, cylinder, capsule, torus, tube, ball with a hole.
#include <map>

#include "geometry/generators.hpp"
#include "geometry/surface_builder.hpp"

namespace lockstep {

namespace {

/// Radius of the regular polygon with n corners that has the area of a disc.
double polygon_radius(double radius, int n) {
  return radius * std::sqrt(2 * pi / (n * std::sin(2 * pi / n)));
}

SurfaceMesh<2> closed_polygon(std::vector<Point<2>> corners) {
  SurfaceMesh<2> mesh;
  const int n = static_cast<int>(corners.size());
  mesh.vertices = std::move(corners);
  for (int i = 0; i < n; ++i)
    mesh.simplices.push_back({i, (i + 1) % n});
  return mesh;
}

/// The unit icosahedron with every face divided in n^2 triangles, blown up to the unit sphere.
SurfaceMesh<3> icosphere(int n) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  const Point<3> corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  constexpr int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  SurfaceMesh<3> mesh;
  // A vertex is known by its weights on the icosahedron's corners, which neighbouring faces share.
  std::map<std::array<int, 6>, int> known;
  const auto vertex = [&](const int* face, int i, int j) {
    std::array<std::array<int, 2>, 3> weights{{{face[0], n - i - j}, {face[1], i}, {face[2], j}}};
    for (auto& weight : weights)
      if (weight[1] == 0)
        weight[0] = -1;
    std::sort(weights.begin(), weights.end());
    std::array<int, 6> key;
    Point<3> x = Point<3>::Zero();
    for (int k = 0; k < 3; ++k) {
      key[2 * k] = weights[k][0];
      key[2 * k + 1] = weights[k][1];
      if (weights[k][1] > 0)
        x += weights[k][1] * corners[weights[k][0]];
    }
    const auto [entry, is_new] = known.emplace(key, static_cast<int>(mesh.vertices.size()));
    if (is_new)
      mesh.vertices.push_back(x.normalized());
    return entry->second;
  };
  for (const auto& face : faces)
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const int a = vertex(face, i, j), b = vertex(face, i + 1, j), c = vertex(face, i, j + 1);
        mesh.simplices.push_back({a, b, c});
        if (i + j + 1 < n)
          mesh.simplices.push_back({b, vertex(face, i + 1, j + 1), c});
      }
  return mesh;
}

/// A circle of a surface of revolution about z; one point if the radius is zero.
struct Ring {
  double radius = 0, z = 0;
};

/// Joins rings, each with its own number of points, by a zipper of triangles; the rings run from
/// the lower pole to the upper one, the normal points away from the axis.
SurfaceMesh<3> revolve(const std::vector<Ring>& rings, double step, bool exact_area) {
  SurfaceMesh<3> mesh;
  int begin_below = 0, n_below = 0;
  for (const Ring& ring : rings) {
    const int n = ring.radius > 0 ? std::max(6, n_steps(2 * pi * ring.radius, step)) : 1;
    const double radius = n > 1 && exact_area ? polygon_radius(ring.radius, n) : ring.radius;
    const int begin = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * pi * i / n;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), ring.z);
    }
    int i = 0, j = 0;  // steps taken around the ring below and this one
    const int end_below = n_below > 1 ? n_below : 0, end = n > 1 ? n : 0;
    while (n_below > 0 && (i < end_below || j < end)) {
      const int below = begin_below + i % n_below, above = begin + j % n;
      // Compare (i + 1) / n_below with (j + 1) / n.
      const bool step_below = j == end || (i < end_below && (i + 1) * n <= (j + 1) * n_below);
      if (step_below) {
        mesh.simplices.push_back({below, begin_below + (i + 1) % n_below, above});
        ++i;
      } else {
        mesh.simplices.push_back({below, begin + (j + 1) % n, above});
        ++j;
      }
    }
    begin_below = begin;
    n_below = n;
  }
  return mesh;
}

}  // namespace

template <>
SurfaceMesh<2> ball_surface<2>(double radius, double spacing) {
  check_shape("Ball", radius, radius, spacing);
  return build_to_spacing<2>(spacing, [&](double target) {
    const int n = std::max(8, n_steps(2 * pi * radius, target));
    std::vector<Point<2>> corners;
    for (int i = 0; i < n; ++i)
      corners.push_back(polygon_radius(radius, n) *
                        Point<2>(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)));
    return closed_polygon(std::move(corners));
  });
}

template <>
SurfaceMesh<3> ball_surface<3>(double radius, double spacing) {
  check_shape("Ball", radius, radius, spacing);
  return build_to_spacing<3>(spacing, [&](double target) {
    SurfaceMesh<3> mesh = icosphere(n_steps(1.0515 * radius, target));
    const double volume = 4.0 / 3.0 * pi * radius * radius * radius;
    const double scale = std::cbrt(volume / volume_properties(mesh).measure);
    for (Point<3>& x : mesh.vertices)
      x *= scale;
    return mesh;
  });
}

template <>
SurfaceMesh<2> cylinder_surface<2>(double radius, double length, double spacing) {
  return box_surface<2>({2 * radius, length}, spacing);
}

template <>
SurfaceMesh<3> cylinder_surface<3>(double radius, double length, double spacing) {
  check_shape("Cylinder", std::min(radius, length), std::max(radius, length), spacing);
  return build_to_spacing<3>(spacing, [&](double step) {
    const int n_cap = n_steps(radius, step), n_side = n_steps(length, step);
    // The outer ring has the disc's area; all others belong to flat caps and may lie anywhere.
    std::vector<Ring> rings;
    for (int i = 0; i < n_cap; ++i)
      rings.push_back({radius * i / n_cap, -0.5 * length});
    for (int i = 0; i <= n_side; ++i)
      rings.push_back({radius, length * (static_cast<double>(i) / n_side - 0.5)});
    for (int i = n_cap - 1; i >= 0; --i)
      rings.push_back({radius * i / n_cap, 0.5 * length});
    return revolve(rings, step, true);
  });
}

template <>
SurfaceMesh<2> capsule_surface<2>(double radius, double length, double spacing) {
  check_shape("Capsule", std::min(radius, length), std::max(radius, length), spacing);
  const int n_arc = std::max(4, n_steps(pi * radius, spacing));
  const int n_side = n_steps(length, spacing);
  std::vector<Point<2>> corners;
  for (const int side : {1, -1}) {
    const Point<2> center(0, 0.5 * side * length);
    for (int i = 0; i <= n_arc; ++i) {
      const double angle = pi * i / n_arc;
      corners.push_back(center + side * radius * Point<2>(std::cos(angle), std::sin(angle)));
    }
    for (int i = 1; i < n_side; ++i)
      corners.emplace_back(-side * radius, center.y() - side * length * i / n_side);
  }
  return closed_polygon(std::move(corners));
}

template <>
SurfaceMesh<3> capsule_surface<3>(double radius, double length, double spacing) {
  check_shape("Capsule", std::min(radius, length), std::max(radius, length), spacing);
  return build_to_spacing<3>(spacing, [&](double step) {
    const int n_arc = std::max(2, n_steps(0.5 * pi * radius, step));
    const int n_side = n_steps(length, step);
    std::vector<Ring> rings;
    const auto add_cap_ring = [&](int i, int side) {
      const double angle = 0.5 * pi * i / n_arc;  // from the pole
      rings.push_back({i == 0 ? 0 : radius * std::sin(angle),
                       side * (0.5 * length + radius * std::cos(angle))});
    };
    for (int i = 0; i < n_arc; ++i)
      add_cap_ring(i, -1);
    for (int i = 0; i <= n_side; ++i)
      rings.push_back({radius, length * (static_cast<double>(i) / n_side - 0.5)});
    for (int i = n_arc - 1; i >= 0; --i)
      add_cap_ring(i, 1);
    return revolve(rings, step, false);
  });
}

template <>
SurfaceMesh<2> torus_surface<2>(double, double, double) {
  throw InputError("Torus: there is no torus in two dimensions; choose another shape.");
}

template <>
SurfaceMesh<3> torus_surface<3>(double radius, double tube, double spacing) {
  check_shape("Torus", std::min(radius, tube), std::max(radius, tube), spacing);
  check_input(tube < radius,
              "Torus: the radius of the section ({}) must be less than that of the ring ({}).",
              tube, radius);
  return build_to_spacing<3>(spacing, [&](double step) {
    const int n_ring = std::max(6, n_steps(2 * pi * (radius + tube), step));
    const int n_tube = std::max(6, n_steps(2 * pi * tube, step));
    SurfaceMesh<3> mesh;
    for (int i = 0; i < n_ring; ++i)
      for (int j = 0; j < n_tube; ++j) {
        const double around = 2 * pi * i / n_ring, section = 2 * pi * j / n_tube;
        const double arm = radius + tube * std::cos(section);
        mesh.vertices.emplace_back(arm * std::cos(around), arm * std::sin(around),
                                   tube * std::sin(section));
        const int next_i = (i + 1) % n_ring, next_j = (j + 1) % n_tube;
        const int p = i * n_tube + j, q = next_i * n_tube + j;
        const int r = next_i * n_tube + next_j, s = i * n_tube + next_j;
        mesh.simplices.push_back({p, q, r});
        mesh.simplices.push_back({p, r, s});
      }
    return mesh;
  });
}

template <>
SurfaceMesh<2> tube_surface<2>(double radius, double length, double spacing) {
  check_shape("Tube", std::min(radius, length), std::max(radius, length), spacing);
  SurfaceMesh<2> mesh;
  const int n = n_steps(length, spacing);
  for (const int side : {1, -1}) {
    const int begin = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i <= n; ++i)
      mesh.vertices.emplace_back(side * radius, side * length * (static_cast<double>(i) / n - 0.5));
    for (int i = 0; i < n; ++i)
      mesh.simplices.push_back({begin + i, begin + i + 1});
  }
  return mesh;
}

template <>
SurfaceMesh<3> tube_surface<3>(double radius, double length, double spacing) {
  check_shape("Tube", std::min(radius, length), std::max(radius, length), spacing);
  return build_to_spacing<3>(spacing, [&](double step) {
    const int n = n_steps(length, step);
    std::vector<Ring> rings;
    for (int i = 0; i <= n; ++i)
      rings.push_back({radius, length * (static_cast<double>(i) / n - 0.5)});
    return revolve(rings, step, true);
  });
}

namespace {
/// The arc from the lower pole to the facet of the hole [rad].
double open_arc(double radius, double opening, double spacing) {
  check_shape("Open ball", std::min(radius, opening), radius, spacing);
  check_input(opening < radius, "Open ball: the radius of the opening ({}) must be less than {}.",
              opening, radius);
  return pi - std::asin(opening / radius);
}
}  // namespace

template <>
SurfaceMesh<2> open_ball_surface<2>(double radius, double opening, double spacing) {
  const double arc = open_arc(radius, opening, spacing);
  const int n = n_steps(2 * arc * radius, spacing);
  SurfaceMesh<2> mesh;
  for (int i = 0; i <= n; ++i) {
    const double angle = arc * (2.0 * i / n - 1);  // from the lower pole, counterclockwise
    mesh.vertices.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
    if (i > 0)
      mesh.simplices.push_back({i - 1, i});
  }
  return mesh;
}

template <>
SurfaceMesh<3> open_ball_surface<3>(double radius, double opening, double spacing) {
  const double arc = open_arc(radius, opening, spacing);
  return build_to_spacing<3>(spacing, [&](double step) {
    const int n = n_steps(arc * radius, step);
    std::vector<Ring> rings;
    for (int i = 0; i <= n; ++i) {
      const double angle = arc * i / n;
      rings.push_back({i == 0 ? 0 : radius * std::sin(angle), -radius * std::cos(angle)});
    }
    SurfaceMesh<3> mesh = revolve(rings, step, false);
    for (auto& x : mesh.vertices)
      x = Point<3>(x.y(), x.z(), x.x());  // the axis becomes y
    return mesh;
  });
}

}  // namespace lockstep
