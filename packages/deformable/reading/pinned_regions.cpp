#include "deformable/reading/pinned_regions.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "deformable/reading/node_region.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

template <int dim>
std::vector<TypedSchema> motions() {
  ParameterList constant;
  declare_vector(constant, "Velocity", ParameterArray<double>(dim, 0.0), dim,
                 "Velocity of the origin of the body's coordinates [m/s].");
  declare_rotation<dim>(constant, "Angular Velocity",
                        "Angular velocity about that origin [rad/s].");
  std::vector<TypedSchema> all{{"static", "The nodes rest.", ParameterList()},
                               {"constant velocity", "They keep a velocity.", constant}};
  for (const TypedSchema& timed : timed_motion_schemas<dim>())
    all.push_back(timed);
  return all;
}

template <int dim>
MotionScript<dim> read_script(const ParameterList& list, const std::string& where) {
  const auto& type = list.get<std::string>("Type");
  if (type == "static")
    return {};
  if (type == "constant velocity") {
    return uniform_motion<dim>(vector_value<dim>(list, "Velocity"),
                               rotation_value<dim>(list, "Angular Velocity"));
  }
  return read_timed_motion<dim>(list, where);
}

/// A node that two regions hold must rest in both.
template <int dim>
void check_overlap(const NodeHold<dim>& hold, bool special,
                   const std::vector<std::array<char, dim>>& held, const std::string& where) {
  for (const int n : hold.nodes) {
    for (int a = 0; a < dim; ++a) {
      const bool twice = hold.axes[a] && held[n][a] != 0 && (special || held[n][a] == 2);
      check_input(!twice,
                  "The region \"{}\" holds node {} along {}, as another region does; regions that "
                  "move or are released must not overlap with others.",
                  where, n, "xyz"[a]);
    }
  }
}

}  // namespace

template <int dim>
void declare_pinned(ParameterList& body) {
  ParameterList pinned("pinned");
  declare_node_region<dim>(pinned);
  std::vector<std::string> axes{"x", "y", "z"};
  axes.resize(dim);
  declare(pinned, "Locked", ParameterArray<std::string>(axes),
          "Axes of space along which the nodes are held.");
  set_choices(pinned, "Locked", axes);
  declare_typed_sublist(pinned, "Motion",
                        "Motion of the nodes from their start; turns are about the origin of the "
                        "body's coordinates at the start.",
                        motions<dim>(), "static");
  declare_optional<double>(pinned, "End",
                           "When they are let go, with the velocity they have: at the begin of "
                           "the first step at or after it [s]. Absent: never.");
  declare_named_sublists(body, "Pinned", "Nodes held at rest, or moved by a script.", pinned);
}

template <int dim>
void read_pinned(const ParameterList& list, const std::vector<Point<dim>>& rest,
                 const Point<dim>& origin, DeformableBody<dim>& body) {
  body.locked.assign(rest.size(), {});
  std::vector<std::array<char, dim>> held(rest.size(), std::array<char, dim>{});
  const ParameterList& all = list.sublist("Pinned");
  for (auto entry = all.begin(); entry != all.end(); ++entry) {
    const ParameterList& region = all.sublist(all.name(entry));
    const std::string where = body.name + "/Pinned/" + all.name(entry);
    NodeHold<dim> hold;
    hold.nodes = nodes_in_region<dim>(region, rest, where);
    hold.script = read_script<dim>(region.sublist("Motion"), where + "/Motion");
    hold.origin = origin;
    for (const auto& direction : region.get<ParameterArray<std::string>>("Locked")) {
      bool& is_held = hold.axes[direction[0] - 'x'];
      check_input(!is_held, "The region \"{}\" has \"{}\" twice in \"Locked\"; once is enough.",
                  where, direction);
      is_held = true;
    }
    const bool released = region.isParameter("End");
    if (released)
      hold.release_time = region.get<double>("End");
    const bool special = released || hold.script;
    check_overlap<dim>(hold, special, held, where);
    for (const int n : hold.nodes) {
      for (int a = 0; a < dim; ++a) {
        if (!hold.axes[a])
          continue;
        body.locked[n][a] = true;
        held[n][a] = special ? 2 : 1;
      }
    }
    if (special)
      body.holds.push_back(std::move(hold));
  }
}

template <int dim>
void declare_attachments(ParameterList& body) {
  ParameterList attachment("attachment");
  declare_node_region<dim>(attachment);
  declare_required<std::string>(attachment, "Solid", "Name of a dynamic rigid body.");
  declare_named_sublists(body, "Attachments",
                         "Nodes that a rigid body carries, as if glued to it where they start.",
                         attachment);
}

template <int dim>
void read_attachments(const ParameterList& list, const std::vector<Point<dim>>& rest,
                      DeformableBody<dim>& body) {
  std::vector<char> taken(rest.size(), 0);
  const ParameterList& all = list.sublist("Attachments");
  for (auto entry = all.begin(); entry != all.end(); ++entry) {
    const ParameterList& region = all.sublist(all.name(entry));
    const std::string where = body.name + "/Attachments/" + all.name(entry);
    for (const int n : nodes_in_region<dim>(region, rest, where)) {
      const auto& locked = body.locked[n];
      check_input(!taken[n] && std::none_of(locked.begin(), locked.end(), [](bool l) { return l; }),
                  "The region \"{}\" attaches node {}, which is pinned or attached already.", where,
                  n);
      taken[n] = 1;
      body.attached.emplace_back(n, region.get<std::string>("Solid"));
    }
  }
}

template void declare_attachments<2>(ParameterList&);
template void declare_attachments<3>(ParameterList&);
template void read_attachments<2>(const ParameterList&, const std::vector<Point<2>>&,
                                  DeformableBody<2>&);
template void read_attachments<3>(const ParameterList&, const std::vector<Point<3>>&,
                                  DeformableBody<3>&);
template void declare_pinned<2>(ParameterList&);
template void declare_pinned<3>(ParameterList&);
template void read_pinned<2>(const ParameterList&, const std::vector<Point<2>>&, const Point<2>&,
                             DeformableBody<2>&);
template void read_pinned<3>(const ParameterList&, const std::vector<Point<3>>&, const Point<3>&,
                             DeformableBody<3>&);

}  // namespace lockstep
