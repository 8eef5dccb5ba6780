#include "contact/impacts/impacts.hpp"

#include <algorithm>

#include "base/round_off.hpp"
#include "contact/search/meeting_pairs.hpp"
#include "contact/search/touching_side.hpp"

namespace lockstep {

template <int dim>
SurfacePath<dim>::SurfacePath(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                              double dt)
    : before(shapes.mesh().vertices), after(before) {
  for (int i = 0; i < shapes.n_solids(); ++i) {
    const SolidDescription& solid = shapes.solids()[i];
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
      after[v] = motion.end_of_vertex(i, v, dt);
  }
}

namespace {
/// Solids of which at least one is not rigid whose swept boxes meet, and such with themselves.
template <int dim>
std::vector<std::array<int, 2>> pairs_to_follow(const ContactShapes<dim>& shapes,
                                                const std::vector<Box<dim>>& swept) {
  const auto& solids = shapes.solids();
  auto pairs =
      meeting_pairs<dim>(swept, [&](int i, int j) { return !solids[i].rigid || !solids[j].rigid; });
  for (int i = 0; i < shapes.n_solids(); ++i) {
    if (!solids[i].rigid && !swept[i].isEmpty())
      pairs.push_back({i, i});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// True where one solid is glued to the other.
template <int dim>
bool hang_together(const ContactShapes<dim>& shapes, const PrimitivePair<dim>& pair) {
  const int n_first = pair.kind == PrimitiveKind::edge_edge ? 2 : 1;
  for (int k = 0; k <= dim; ++k) {
    if (shapes.hangs_on(pair.vertices[k], k < n_first ? pair.other : pair.solid))
      return true;
  }
  return false;
}
}  // namespace

template <int dim>
std::vector<FoundImpact<dim>> find_impacts(const ContactShapes<dim>& shapes,
                                           const SurfacePath<dim>& path) {
  std::vector<Box<dim>> swept, solid_swept(shapes.n_solids());
  for (std::size_t v = 0; v < path.before.size(); ++v) {
    swept.emplace_back(path.before[v]);
    swept.back().extend(path.after[v]);
  }
  for (int i = 0; i < shapes.n_solids(); ++i) {
    const SolidDescription& solid = shapes.solids()[i];
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
      solid_swept[i].extend(swept[v]);
  }
  const std::vector<Point<dim>>& unheld = path.unheld.empty() ? path.after : path.unheld;
  const PrimitivePair<dim>* current = nullptr;
  const SideAtStart<dim> side = [&](const PrimitiveWeights<dim>& weights,
                                    const Point<dim>& normal) -> Point<dim> {
    constexpr double negligible = rounding::differences;  // part of an edge [1]
    const auto start = points_of(*current, path.before);
    const Point<dim> motion =
        weighted<dim>(weights, points_of(*current, unheld)) - weighted<dim>(weights, start);
    return touching_side(shapes, *current, weights, normal, motion,
                         negligible * (start[1] - start[2]).norm());
  };
  std::vector<FoundImpact<dim>> found;
  const auto keep_impacts = [&](const std::vector<PrimitivePair<dim>>& pairs) {
    for (const PrimitivePair<dim>& pair : pairs) {
      current = &pair;
      const auto impact = first_impact<dim>(pair.kind, points_of(pair, path.before),
                                            points_of(pair, path.after), side);
      if (impact && !hang_together(shapes, pair))
        found.push_back({pair, *impact});
    }
  };
  PrimitivePairs<dim> primitives(shapes, std::move(swept));
  for (const auto& [i, j] : pairs_to_follow(shapes, solid_swept))
    primitives.for_each(0, i, j, keep_impacts);
  return found;
}

template <int dim>
Contact<dim> impact_contact(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                            const SurfacePath<dim>& path, const FoundImpact<dim>& found,
                            double clearance, double dt) {
  const auto& [pair, impact] = found;
  const auto points = surface_points(shapes, pair, impact.weights);
  Contact<dim> contact;
  contact.impact = true;
  contact.solid = pair.solid;
  contact.other = pair.other;
  contact.point = points[0];
  contact.other_point = points[1];
  contact.normal = impact.normal;
  const double start =
      impact.normal.dot(weighted<dim>(impact.weights, points_of(pair, path.before)));
  const double end = impact.normal.dot(weighted<dim>(impact.weights, points_of(pair, path.after)));
  const double speed = impact.normal.dot(motion.at(pair.solid, points[0], points[0].position) -
                                         motion.at(pair.other, points[1], points[1].position));
  contact.gap = end - dt * speed - std::min(clearance, 0.5 * std::max(start, 0.0));
  return contact;
}

template struct SurfacePath<2>;
template struct SurfacePath<3>;
template std::vector<FoundImpact<2>> find_impacts<2>(const ContactShapes<2>&,
                                                     const SurfacePath<2>&);
template std::vector<FoundImpact<3>> find_impacts<3>(const ContactShapes<3>&,
                                                     const SurfacePath<3>&);
template Contact<2> impact_contact<2>(const ContactShapes<2>&, const SolidMotion<2>&,
                                      const SurfacePath<2>&, const FoundImpact<2>&, double, double);
template Contact<3> impact_contact<3>(const ContactShapes<3>&, const SolidMotion<3>&,
                                      const SurfacePath<3>&, const FoundImpact<3>&, double, double);

}  // namespace lockstep
