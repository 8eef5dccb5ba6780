#include "contact/search/surface_contacts.hpp"

#include <algorithm>
#include <optional>

#include "base/round_off.hpp"
#include "contact/search/approach.hpp"
#include "contact/search/touching_side.hpp"

namespace lockstep {

namespace {

/// A pair with its closest points.
template <int dim>
struct NearPair {
  const PrimitivePair<dim>* pair = nullptr;
  ClosestPrimitives<dim> closest;
  std::array<SurfacePoint<dim>, 2> points;
  Point<dim> arm = Point<dim>::Zero();  ///< from the second point to the first [m]
};

template <int dim>
class SurfaceContacts {
 public:
  /// With `approach`, of one solid with itself, those only that it does not rule out.
  SurfaceContacts(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                  const ContactReach& reach, const Approach<dim>* approach,
                  std::vector<Contact<dim>>& contacts)
      : shapes_(shapes), motion_(motion), reach_(reach), approach_(approach), contacts_(contacts) {}

  /// Adds the contacts of one first primitive.
  void add(const std::vector<PrimitivePair<dim>>& pairs) {
    if (pairs.front().kind == PrimitiveKind::vertex_simplex) {
      add_vertex(pairs);
      return;
    }
    for (const PrimitivePair<dim>& pair : pairs) {
      if (const auto near = near_pair(pair); near && on_outer_sides(*near))
        add_contact(*near);
    }
  }

 private:
  double thickness(const PrimitivePair<dim>& pair) const {
    return reach_.half_thickness[pair.solid] + reach_.half_thickness[pair.other];
  }

  std::optional<NearPair<dim>> near_pair(const PrimitivePair<dim>& pair) const {
    if (pair.solid == pair.other && are_neighbours(shapes_.topology(), pair))
      return {};
    const auto closest =
        closest_primitives<dim>(pair.kind, points_of(pair, shapes_.mesh().vertices));
    if (!closest)
      return {};
    NearPair<dim> near;
    near.pair = &pair;
    near.closest = *closest;
    near.points = surface_points(shapes_, pair, closest->weights);
    near.arm = near.points[0].position - near.points[1].position;
    return near;
  }

  bool is_closed(int solid) const { return shapes_.solids()[solid].closed; }

  Point<dim> outward(const SurfacePoint<dim>& point) const {
    Point<dim> sum = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k) {
      if (point.barycentric[k] > 0)
        sum += point.barycentric[k] *
               shapes_.vertex_normal(shapes_.mesh().simplices[point.simplex][k]);
    }
    return sum;
  }

  double range(const NearPair<dim>& near) const { return reach_.near + thickness(*near.pair); }

  /// True if the points are so near that they tell no direction.
  bool touches(const NearPair<dim>& near) const {
    return near.closest.distance <= rounding::differences * range(near);
  }

  Point<dim> normal_where_they_touch(const NearPair<dim>& near) const {
    const PrimitivePair<dim>& pair = *near.pair;
    if (!reach_.unheld)
      return Point<dim>::Zero();
    Point<dim> normal = shapes_.normal(pair.other_simplex);
    if constexpr (dim == 3) {
      if (pair.kind == PrimitiveKind::edge_edge) {
        const auto x = points_of(pair, shapes_.mesh().vertices);
        normal = (x[1] - x[0]).cross(x[3] - x[2]).normalized();
      }
    }
    const Point<dim> velocity = motion_.at(pair.solid, near.points[0], near.points[0].position) -
                                motion_.at(pair.other, near.points[1], near.points[1].position);
    return touching_side(shapes_, pair, near.closest.weights, normal,
                         Point<dim>(reach_.dt * velocity), rounding::differences * range(near));
  }

  bool on_outer_sides(const NearPair<dim>& near) const {
    if (touches(near))
      return true;
    return !(is_closed(near.pair->other) && outward(near.points[1]).dot(near.arm) <= 0) &&
           !(is_closed(near.pair->solid) && outward(near.points[0]).dot(near.arm) >= 0);
  }

  /// A vertex inside another closed solid.
  bool overlaps(const NearPair<dim>& near) const {
    return near.pair->solid != near.pair->other && is_closed(near.pair->other) &&
           outward(near.points[1]).dot(near.arm) < 0;
  }

  /// Chooses among simplices that are equally near but for round-off, as all around a node below
  /// the vertex, the first: friction acts on its corners, which must be the same on any number of
  /// ranks.
  std::size_t nearest_of(const std::vector<NearPair<dim>>& near) const {
    double least = near.front().closest.distance;
    for (const NearPair<dim>& one : near)
      least = std::min(least, one.closest.distance);
    std::size_t first = 0;
    while (near[first].closest.distance > least + rounding::differences * range(near[first]))
      ++first;
    return first;
  }

  /// All simplices near one vertex.
  void add_vertex(const std::vector<PrimitivePair<dim>>& pairs) {
    std::vector<NearPair<dim>> near;
    for (const PrimitivePair<dim>& pair : pairs) {
      if (const auto found = near_pair(pair))
        near.push_back(*found);
    }
    if (near.empty())
      return;
    const std::size_t nearest = nearest_of(near);
    if (!touches(near[nearest]) && overlaps(near[nearest])) {
      add_overlap(near[nearest]);
      return;
    }
    for (std::size_t i = 0; i < near.size(); ++i) {
      if ((near[i].closest.interior || i == nearest) && on_outer_sides(near[i]))
        add_contact(near[i]);
    }
  }

  void add_contact(const NearPair<dim>& near) {
    const double distance = near.closest.distance;
    if (approach_ != nullptr && !approach_->may_close(*near.pair, distance, thickness(*near.pair)))
      return;
    if (touches(near)) {
      if (const Point<dim> normal = normal_where_they_touch(near); !normal.isZero(0))
        append(near, normal, distance);
    } else if (distance <= range(near)) {
      append(near, near.arm / distance, distance);
    }
  }

  void add_overlap(const NearPair<dim>& near) {
    if (near.closest.distance <= reach_.depth)
      append(near, -near.arm / near.closest.distance, -near.closest.distance);
  }

  void append(const NearPair<dim>& near, const Point<dim>& normal, double distance) {
    Contact<dim> contact;
    contact.solid = near.pair->solid;
    contact.other = near.pair->other;
    contact.point = near.points[0];
    contact.other_point = near.points[1];
    contact.normal = normal;
    contact.gap = distance - thickness(*near.pair);
    contact.x = place_between(shapes_, contact);
    contacts_.push_back(contact);
  }

  const ContactShapes<dim>& shapes_;
  const SolidMotion<dim>& motion_;
  const ContactReach& reach_;
  const Approach<dim>* approach_;
  std::vector<Contact<dim>>& contacts_;
};

}  // namespace

template <int dim>
void add_surface_contacts(PrimitivePairs<dim>& primitives, const SolidMotion<dim>& motion,
                          const ContactReach& reach, int solid, int other,
                          std::vector<Contact<dim>>& contacts) {
  const ContactShapes<dim>& shapes = primitives.shapes();
  double range = reach.near + reach.half_thickness[solid] + reach.half_thickness[other];
  const bool any_closed = shapes.solids()[solid].closed || shapes.solids()[other].closed;
  if (solid != other && any_closed)
    range = std::max(range, reach.depth);
  if (reach.violated_only && solid == other) {
    const Approach<dim> approach(shapes, motion, solid, reach.dt);
    SurfaceContacts<dim> found(shapes, motion, reach, &approach, contacts);
    primitives.for_each_closing(range, solid, approach, 2 * reach.half_thickness[solid],
                                [&](const auto& pairs) { found.add(pairs); });
    return;
  }
  SurfaceContacts<dim> found(shapes, motion, reach, nullptr, contacts);
  primitives.for_each(range, solid, other, [&](const auto& pairs) { found.add(pairs); });
}

template void add_surface_contacts<2>(PrimitivePairs<2>&, const SolidMotion<2>&,
                                      const ContactReach&, int, int, std::vector<Contact<2>>&);
template void add_surface_contacts<3>(PrimitivePairs<3>&, const SolidMotion<3>&,
                                      const ContactReach&, int, int, std::vector<Contact<3>>&);

}  // namespace lockstep
