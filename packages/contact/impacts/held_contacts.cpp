#include "contact/impacts/held_contacts.hpp"

#include <map>
#include <set>

#include "contact/search/surface_contacts.hpp"

namespace lockstep {

namespace {

/// A rigid solid that meets a vertex of one that is not.
template <int dim>
struct RigidSide {
  int solid = -1;
  SurfacePoint<dim> point;
  Point<dim> outward;  ///< to the vertex
};

template <int dim>
using SidesOfVertex = std::map<int, std::vector<RigidSide<dim>>>;

template <int dim>
void add_rigid_side(const ContactShapes<dim>& shapes, const FoundImpact<dim>& found,
                    const Contact<dim>& contact, SidesOfVertex<dim>& sides) {
  const auto& solids = shapes.solids();
  const bool first = solids[contact.solid].rigid;
  if (first == solids[contact.other].rigid)
    return;
  const RigidSide<dim> side{first ? contact.solid : contact.other,
                            first ? contact.point : contact.other_point,
                            first ? Point<dim>(-contact.normal) : contact.normal};
  const int n_first = found.pair.kind == PrimitiveKind::edge_edge ? 2 : 1;
  for (int k = 0; k <= dim; ++k) {
    if ((k < n_first) != first)
      sides[found.pair.vertices[k]].push_back(side);
  }
}

template <int dim>
void add_through_vertices(const ContactShapes<dim>& shapes, const SidesOfVertex<dim>& sides,
                          std::vector<Contact<dim>>& contacts) {
  const auto& solids = shapes.solids();
  for (const auto& [vertex, all] : sides) {
    std::set<std::pair<int, int>> met;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto &one = all[i], &other = all[j];
        if (one.solid == other.solid || one.outward.dot(other.outward) >= 0 ||
            (solids[one.solid].prescribed && solids[other.solid].prescribed) ||
            !met.insert(std::minmax(one.solid, other.solid)).second)
          continue;
        Contact<dim> contact;
        contact.solid = one.solid;
        contact.other = other.solid;
        contact.point = one.point;
        contact.other_point = other.point;
        contact.x = shapes.mesh().vertices[vertex];
        contact.normal = (other.outward - one.outward).normalized();
        contacts.push_back(contact);
      }
    }
  }
}

}  // namespace

template <int dim>
std::vector<Contact<dim>> held_contacts(const ContactShapes<dim>& shapes,
                                        const std::vector<FoundImpact<dim>>& held_back) {
  std::vector<Contact<dim>> contacts;
  SidesOfVertex<dim> sides;
  for (const FoundImpact<dim>& found : held_back) {
    const auto points = surface_points(shapes, found.pair, found.impact.weights);
    Contact<dim> contact;
    contact.solid = found.pair.solid;
    contact.other = found.pair.other;
    contact.point = points[0];
    contact.other_point = points[1];
    contact.normal = found.impact.normal;
    contact.x = place_between(shapes, contact);
    contacts.push_back(contact);
    add_rigid_side(shapes, found, contact, sides);
  }
  add_through_vertices(shapes, sides, contacts);
  return contacts;
}

template std::vector<Contact<2>> held_contacts<2>(const ContactShapes<2>&,
                                                  const std::vector<FoundImpact<2>>&);
template std::vector<Contact<3>> held_contacts<3>(const ContactShapes<3>&,
                                                  const std::vector<FoundImpact<3>>&);

}  // namespace lockstep
