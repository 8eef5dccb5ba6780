#include "contact/search/contact_search.hpp"

#include "contact/search/edge_contacts.hpp"
#include "contact/search/meeting_pairs.hpp"
#include "contact/search/surface_contacts.hpp"
#include "contact/search/vertex_contacts.hpp"

namespace lockstep {

namespace {

/// Returns the box that a solid may touch things in: its bounds and their motion, with all margins.
template <int dim>
Box<dim> reached_box(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                     const ContactReach& reach, int solid) {
  Box<dim> box = shapes.bounds_of_solid(solid);
  if (reach.swept) {
    const Box<dim>& velocity = motion.range(solid);
    box = Box<dim>(box.min() + reach.dt * velocity.min().cwiseMin(0.0),
                   box.max() + reach.dt * velocity.max().cwiseMax(0.0));
  }
  const double margin = 0.5 * reach.near + reach.half_thickness[solid];
  return Box<dim>(box.min().array() - margin, box.max().array() + margin);
}

template <int dim>
void add_wall_contacts(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                       const HalfSpace& wall, const ContactReach& reach, int solid,
                       std::vector<Contact<dim>>& contacts) {
  const SolidDescription& description = shapes.solids()[solid];
  const double thickness = reach.half_thickness[solid];
  for (int v = description.vertex_begin; v < description.vertex_end; ++v) {
    if (shapes.held(v))
      continue;
    const Point<dim>& x = shapes.mesh().vertices[v];
    const double gap = wall.sign * (x[wall.axis] - wall.coordinate) - thickness;
    if (gap > reach.near) {
      if (!reach.swept)
        continue;
      if (gap + reach.dt * wall.sign * motion.of_vertex(solid, v)[wall.axis] > 0)
        continue;
    }
    Contact<dim> contact;
    contact.solid = solid;
    contact.other = ~wall.side;
    contact.point = shapes.at_vertex(v);
    if (contact.point.simplex < 0)
      continue;
    contact.x = x;
    contact.normal = wall.sign * Point<dim>::Unit(wall.axis);
    contact.gap = gap;
    contact.wall_velocity = wall.velocity.head<dim>();
    contacts.push_back(contact);
  }
}

}  // namespace

template <int dim>
std::vector<Contact<dim>> find_contacts(const ContactShapes<dim>& shapes,
                                        const SolidMotion<dim>& motion,
                                        const std::vector<HalfSpace>& walls,
                                        const ContactReach& reach) {
  std::vector<Box<dim>> boxes;
  for (int i = 0; i < shapes.n_solids(); ++i)
    boxes.push_back(reached_box(shapes, motion, reach, i));
  const auto& solids = shapes.solids();
  std::vector<Contact<dim>> contacts;
  std::vector<Box<dim>> vertices;
  for (const Point<dim>& x : shapes.mesh().vertices)
    vertices.emplace_back(x);
  PrimitivePairs<dim> primitives(shapes, std::move(vertices));
  const auto any_moves = [&](int i, int j) {
    return (!solids[i].prescribed || !solids[j].prescribed) && shapes.may_meet(i, j);
  };
  for (const auto& [i, j] : meeting_pairs<dim>(boxes, any_moves)) {
    if (!solids[i].rigid || !solids[j].rigid) {
      add_surface_contacts(primitives, motion, reach, i, j, contacts);
      continue;
    }
    VertexContacts<dim>(shapes, motion, reach, i, j).find(contacts);
    VertexContacts<dim>(shapes, motion, reach, j, i).find(contacts);
    if constexpr (dim == 3)
      add_edge_contacts(shapes, reach, i, j, contacts);
  }
  for (int i = 0; i < shapes.n_solids(); ++i) {
    const SolidDescription& solid = solids[i];
    if (solid.prescribed || solid.simplex_begin == solid.simplex_end || shapes.is_image(i))
      continue;
    if (!solid.rigid)
      add_surface_contacts(primitives, motion, reach, i, i, contacts);
    for (const HalfSpace& wall : walls) {
      const double nearest = wall.sign > 0 ? boxes[i].min()[wall.axis] - wall.coordinate
                                           : wall.coordinate - boxes[i].max()[wall.axis];
      if (nearest < reach.near)
        add_wall_contacts(shapes, motion, wall, reach, i, contacts);
    }
  }
  return contacts;
}

template std::vector<Contact<2>> find_contacts<2>(const ContactShapes<2>&, const SolidMotion<2>&,
                                                  const std::vector<HalfSpace>&,
                                                  const ContactReach&);
template std::vector<Contact<3>> find_contacts<3>(const ContactShapes<3>&, const SolidMotion<3>&,
                                                  const std::vector<HalfSpace>&,
                                                  const ContactReach&);

}  // namespace lockstep
