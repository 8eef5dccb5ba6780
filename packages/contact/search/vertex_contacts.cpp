#include "contact/search/vertex_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "base/round_off.hpp"
#include "geometry/simplex_queries.hpp"

namespace lockstep {

namespace {
constexpr double same_direction = 0.85;  // normals closer than 30 degrees are one contact

/// Componentwise bounds of the displacement of `solid` as seen from `other`.
template <int dim>
Box<dim> relative_displacement(const SolidMotion<dim>& motion, int solid, int other, double dt) {
  const Point<dim> lower = dt * (motion.range(solid).min() - motion.range(other).max());
  const Point<dim> upper = dt * (motion.range(solid).max() - motion.range(other).min());
  return Box<dim>(lower.cwiseMin(0.0), upper.cwiseMax(0.0));
}
}  // namespace

template <int dim>
VertexContacts<dim>::VertexContacts(const ContactShapes<dim>& shapes,
                                    const SolidMotion<dim>& motion, const ContactReach& reach,
                                    int solid, int other)
    : shapes_(shapes),
      motion_(motion),
      reach_(reach),
      solid_(solid),
      other_(other),
      solid_closed_(shapes.solids()[solid].closed),
      other_closed_(shapes.solids()[other].closed),
      thickness_(reach.half_thickness[solid] + reach.half_thickness[other]),
      near_(reach.near + thickness_),
      farthest_(other_closed_ ? std::max(near_, reach.depth) : near_) {
  collect_simplices();
}

template <int dim>
void VertexContacts<dim>::collect_simplices() {
  Box<dim> region = shapes_.bounds_of_solid(solid_);
  if (reach_.swept) {
    const Box<dim> moved = relative_displacement(motion_, solid_, other_, reach_.dt);
    region = Box<dim>(region.min() + moved.min(), region.max() + moved.max());
  }
  region = inflated<dim>(region, farthest_);
  const SolidDescription& other = shapes_.solids()[other_];
  for (int s = other.simplex_begin; s < other.simplex_end; ++s) {
    if (region.intersects(shapes_.bounds(s))) {
      simplices_.push_back(s);
      simplices_box_.extend(shapes_.bounds(s));
    }
  }
}

template <int dim>
void VertexContacts<dim>::find(std::vector<Contact<dim>>& contacts) {
  if (simplices_.empty())
    return;
  Box<dim> region = inflated<dim>(simplices_box_, farthest_);
  if (reach_.swept) {
    const Box<dim> moved = relative_displacement(motion_, solid_, other_, reach_.dt);
    region = Box<dim>(region.min() - moved.max(), region.max() - moved.min());
  }
  const SolidDescription& solid = shapes_.solids()[solid_];
  const ContactTopology<dim>& topology = shapes_.topology();
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
    const Point<dim>& x = shapes_.mesh().vertices[v];
    if (region.contains(x) && topology.begin(v) != topology.end(v))
      against_surface(v, x, shapes_.vertex_normal(v), contacts);
  }
}

template <int dim>
bool VertexContacts<dim>::faces(const Point<dim>& vertex_normal, const Point<dim>& normal) const {
  // A vertex whose own surface looks away cannot be the first to touch; among coplanar boxes it
  // would catch on the rim.
  return !solid_closed_ || vertex_normal.dot(normal) < -0.05;
}

template <int dim>
void VertexContacts<dim>::against_surface(int vertex, const Point<dim>& x, const Point<dim>& normal,
                                          std::vector<Contact<dim>>& contacts) {
  std::vector<Point<dim>> found;
  const auto is_new = [&](const Point<dim>& direction) {
    return std::none_of(found.begin(), found.end(),
                        [&](const Point<dim>& one) { return one.dot(direction) > same_direction; });
  };
  inner_.clear();
  std::optional<Hit> hit = closest(x, normal);
  if (hit && !other_closed_ && solid_closed_ && !faces(normal, hit->normal))
    hit = crossed_shell(*hit, normal);
  if (hit && faces(normal, hit->normal)) {
    add(vertex, *hit, x, contacts);
    found.push_back(hit->normal);
    for (const Hit& inner : inner_) {
      if (hit->distance >= 0 && is_new(inner.normal) && faces(normal, inner.normal)) {
        add(vertex, inner, x, contacts);
        found.push_back(inner.normal);
      }
    }
  }
  if (!reach_.swept)
    return;
  const Point<dim> displacement =
      reach_.dt *
      (motion_.of_vertex(solid_, vertex) -
       motion_.at(
           other_,
           hit ? hit->point : shapes_.at_vertex(shapes_.mesh().simplices[simplices_.front()][0]),
           x));
  if (displacement.norm() <= 0.5 * reach_.near)
    return;
  const std::optional<Hit> ahead = swept(x, displacement);
  if (ahead && is_new(ahead->normal) && faces(normal, ahead->normal))
    add(vertex, *ahead, x, contacts);
}

template <int dim>
std::optional<typename VertexContacts<dim>::Hit> VertexContacts<dim>::closest(
    const Point<dim>& x, const Point<dim>& normal) {
  const double tie = 1e-7 * reach_.near, on_surface = 1e-4 * reach_.near;
  double nearest = farthest_;
  double best = -2;
  std::optional<Hit> hit;
  std::optional<bool> is_inside;  // true inside the other solid; set when it matters
  for (int s : simplices_) {
    const double range = std::max(nearest, near_) + tie;
    if (shapes_.bounds(s).squaredExteriorDistance(x) > range * range)
      continue;
    const auto point = closest_on_simplex<dim>(shapes_.corners(s), x);
    if (point.distance > range)
      continue;
    const Point<dim> face = shapes_.normal(s);
    const Point<dim> arm = x - point.position;
    const double height = face.dot(arm);
    // The direction of the arm, or where the vertex lies on the surface the face's own.
    Hit candidate;
    candidate.point.simplex = s;
    candidate.point.barycentric = point.barycentric;
    candidate.point.position = point.position;
    const double side = height < 0 ? -1 : 1;
    if (point.distance > on_surface) {
      candidate.normal = (other_closed_ ? side : 1) * arm / point.distance;
    } else {
      candidate.normal = other_closed_ || face.dot(normal) < 0 ? face : Point<dim>(-face);
    }
    candidate.distance = other_closed_ ? side * point.distance : point.distance;
    if (other_closed_) {
      // Where two faces of a box are equally near, the one that faces the vertex is meant; and
      // inside a solid the closest point lies straight below the vertex.
      if (height < 0 && point.distance > on_surface && -height < 0.7 * point.distance)
        continue;
      if (!faces(normal, candidate.normal))
        continue;
      if (-height > on_surface) {
        if (!is_inside)
          is_inside = shapes_.inside(simplices_, x, farthest_);
        if (!*is_inside)
          continue;
      }
    }
    if (point.distance <= near_ && candidate.distance >= 0 && point.barycentric.minCoeff() > 1e-6)
      inner_.push_back(candidate);
    if (point.distance > nearest + tie)
      continue;
    // Among simplices that share the closest point, the one that faces x decides on which side x
    // is, and for x on the surface the one that faces the vertex.
    const double facing = point.distance > on_surface ? std::abs(height) / point.distance
                                                      : -candidate.normal.dot(normal);
    if (point.distance < nearest - tie || facing > best) {
      hit = candidate;
      best = facing;
    }
    nearest = std::min(nearest, point.distance);
  }
  if (hit && hit->distance > near_)
    hit.reset();
  return hit;
}

template <int dim>
std::optional<typename VertexContacts<dim>::Hit> VertexContacts<dim>::crossed_shell(
    const Hit& hit, const Point<dim>& normal) const {
  // The vertex looks away from the shell: either it is on the far side of its own solid, or it has
  // come through; then the shell is inside the solid.
  if (normal.dot(hit.normal) < 0.3 ||
      !shapes_.inside(solid_, hit.point.position, 2 * std::max(near_, reach_.depth)))
    return {};
  Hit crossed = hit;
  crossed.normal = -hit.normal;
  crossed.distance = -hit.distance;
  return crossed;
}

template <int dim>
std::optional<typename VertexContacts<dim>::Hit> VertexContacts<dim>::swept(
    const Point<dim>& x, const Point<dim>& displacement) const {
  Box<dim> path(x);
  const Point<dim> end = x + displacement;
  path.extend(end);
  path = inflated<dim>(path, 1e-6 * reach_.near);
  std::optional<Hit> first;
  double fraction = 2;
  for (int s : simplices_) {
    if (!path.intersects(shapes_.bounds(s)))
      continue;
    const auto hit = hit_simplex<dim>(shapes_.corners(s), x, end, 1e-6 * reach_.near);
    if (!hit || hit->fraction >= fraction)
      continue;
    Point<dim> face = shapes_.normal(s);
    const double approach = face.dot(displacement);
    if (std::abs(approach) < rounding::differences * displacement.norm() ||
        (other_closed_ && approach > 0))
      continue;
    if (approach > 0)
      face = -face;
    fraction = hit->fraction;
    first = Hit();
    first->point.simplex = s;
    first->point.barycentric = hit->barycentric;
    first->point.position = hit->position;
    first->normal = face;
    first->distance = face.dot(x - hit->position);
  }
  return first;
}

template <int dim>
void VertexContacts<dim>::add(int vertex, const Hit& hit, const Point<dim>& x,
                              std::vector<Contact<dim>>& contacts) const {
  Contact<dim> contact;
  contact.solid = solid_;
  contact.other = other_;
  contact.point = shapes_.at_vertex(vertex);
  contact.other_point = hit.point;
  contact.normal = hit.normal;
  if (const auto smooth = shapes_.smooth_normal(hit.point)) {
    const double cosine = smooth->dot(hit.normal);
    if (std::abs(cosine) > same_direction)
      contact.normal = cosine > 0 ? *smooth : Point<dim>(-*smooth);
  }
  contact.gap = hit.distance - thickness_;
  contact.x = hit.distance > near_ ? x : Point<dim>(0.5 * (x + hit.point.position));
  contacts.push_back(contact);
}

template class VertexContacts<2>;
template class VertexContacts<3>;

}  // namespace lockstep
