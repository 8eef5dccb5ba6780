#include "contact/search/edge_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {

/// An edge with the directions in which its faces leave it.
struct EdgeGeometry {
  const SurfaceEdge* edge = nullptr;
  Point<3> start, along;
  std::array<Point<3>, 2> away;
  int n_faces = 0;
  Box<3> box;

  /// True if a plane with this normal that holds the edge has both faces behind it, or nearly: of
  /// faces that lie flush on each other but for a little tilt all crossings of facets carry, as
  /// before it tilted, not those alone that the tilt has made deeper.
  bool supports(const Point<3>& normal) const {
    constexpr double tilt = 0.05;
    for (int f = 0; f < n_faces; ++f) {
      if (normal.dot(away[f]) > tilt)
        return false;
    }
    return true;
  }
};

EdgeGeometry geometry_of(const ContactShapes<3>& shapes, const SurfaceEdge& edge) {
  const auto& vertices = shapes.mesh().vertices;
  EdgeGeometry geometry;
  geometry.edge = &edge;
  geometry.start = vertices[edge.vertices[0]];
  geometry.along = vertices[edge.vertices[1]] - geometry.start;
  geometry.box.extend(geometry.start);
  geometry.box.extend(vertices[edge.vertices[1]]);
  const Point<3> direction = geometry.along.normalized();
  for (int simplex : edge.simplices) {
    if (simplex < 0)
      continue;
    for (int vertex : shapes.mesh().simplices[simplex]) {
      if (vertex == edge.vertices[0] || vertex == edge.vertices[1])
        continue;
      const Point<3> arm = vertices[vertex] - geometry.start;
      geometry.away[geometry.n_faces++] = (arm - arm.dot(direction) * direction).normalized();
    }
  }
  return geometry;
}

std::vector<EdgeGeometry> edges_near(const ContactShapes<3>& shapes, int solid, const Box<3>& box) {
  std::vector<EdgeGeometry> edges;
  for (const SurfaceEdge& edge : shapes.topology().sharp_edges(solid)) {
    Box<3> bounds(shapes.mesh().vertices[edge.vertices[0]]);
    bounds.extend(shapes.mesh().vertices[edge.vertices[1]]);
    if (bounds.intersects(box))
      edges.push_back(geometry_of(shapes, edge));
  }
  return edges;
}

SurfacePoint<3> point_on(const ContactShapes<3>& shapes, const EdgeGeometry& geometry,
                         double fraction) {
  SurfacePoint<3> point;
  point.simplex = geometry.edge->simplices[0];
  point.position = geometry.start + fraction * geometry.along;
  const auto& simplex = shapes.mesh().simplices[point.simplex];
  for (int k = 0; k < 3; ++k) {
    if (simplex[k] == geometry.edge->vertices[0])
      point.barycentric[k] = 1 - fraction;
    if (simplex[k] == geometry.edge->vertices[1])
      point.barycentric[k] = fraction;
  }
  return point;
}

/// Fractions of the closest points of two lines; false if they are parallel or the points are not
/// well inside both edges, where vertices see the contact.
bool crossing(const EdgeGeometry& a, const EdgeGeometry& b, double& s, double& t) {
  const Point<3> normal = a.along.cross(b.along);
  const double square = normal.squaredNorm();
  if (square < 1e-4 * a.along.squaredNorm() * b.along.squaredNorm())
    return false;
  const Point<3> arm = b.start - a.start;
  s = arm.cross(b.along).dot(normal) / square;
  t = arm.cross(a.along).dot(normal) / square;
  const double facet = 1e-6;
  return s > facet && s < 1 - facet && t > facet && t < 1 - facet;
}

}  // namespace

void add_edge_contacts(const ContactShapes<3>& shapes, const ContactReach& reach, int solid,
                       int other, std::vector<Contact<3>>& contacts) {
  const double thickness = reach.half_thickness[solid] + reach.half_thickness[other];
  const double range = std::max(reach.near + thickness, reach.depth);
  Box<3> box = shapes.bounds_of_solid(solid).intersection(
      Box<3>(shapes.bounds_of_solid(other).min().array() - range,
             shapes.bounds_of_solid(other).max().array() + range));
  box = Box<3>(box.min().array() - range, box.max().array() + range);
  const auto edges = edges_near(shapes, solid, box), others = edges_near(shapes, other, box);
  for (const EdgeGeometry& a : edges) {
    for (const EdgeGeometry& b : others) {
      double s = 0, t = 0;
      if (a.box.squaredExteriorDistance(b.box) > range * range || !crossing(a, b, s, t))
        continue;
      Contact<3> contact;
      contact.point = point_on(shapes, a, s);
      contact.other_point = point_on(shapes, b, t);
      const Point<3> arm = contact.point.position - contact.other_point.position;
      if (arm.norm() > range)
        continue;
      Point<3> normal = a.along.cross(b.along).normalized();
      const bool forward = b.supports(normal) && a.supports(-normal);
      const bool backward = b.supports(-normal) && a.supports(normal);
      if (!forward && !backward)
        continue;
      // Two facets of shells fit both ways; then the side on which they are decides.
      if (!forward || (backward && arm.dot(normal) < 0))
        normal = -normal;
      contact.solid = solid;
      contact.other = other;
      contact.normal = normal;
      contact.gap = arm.dot(normal) - thickness;
      contact.x = 0.5 * (contact.point.position + contact.other_point.position);
      if (contact.gap <= reach.near)
        contacts.push_back(contact);
    }
  }
}

}  // namespace lockstep
