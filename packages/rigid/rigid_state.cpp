// Checkpoints and frames of the rigid bodies.
#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "output/frames.hpp"
#include "rigid/rigid_bodies.hpp"

namespace lockstep {

namespace {

constexpr const char* group = "rigid bodies";
const std::string names_path = std::string(group) + "/names";
const std::string values_path = std::string(group) + "/values";

/// Calls f with a pointer to every number of a body's state, in a fixed order.
template <typename Body, typename Function>
void for_each_value(Body& body, const Function& f) {
  const auto all = [&](auto& vector) {
    for (int k = 0; k < vector.size(); ++k)
      f(vector[k]);
  };
  all(body.pose.position);
  if constexpr (std::is_same_v<std::decay_t<decltype(body.pose.orientation)>, Orientation<2>>) {
    f(body.pose.orientation.angle());
  } else {
    all(body.pose.orientation.coeffs());
  }
  all(body.velocity);
  all(body.momentum);
  all(body.last_move.origin);
  all(body.last_move.linear);
  all(body.last_move.angular);
}

template <int dim>
std::string joined_names(const std::vector<RigidBody<dim>>& bodies) {
  std::string names;
  for (const auto& body : bodies)
    names += body.name + "\n";
  return names;
}

}  // namespace

template <int dim>
std::vector<double> RigidBodies<dim>::state() const {
  std::vector<double> values{time_};
  for (const RigidBody<dim>& body : bodies_)
    for_each_value(body, [&](double value) { values.push_back(value); });
  return values;
}

template <int dim>
void RigidBodies<dim>::set_state(const std::vector<double>& values) {
  auto next = values.begin();
  time_ = *next++;
  for (RigidBody<dim>& body : bodies_)
    for_each_value(body, [&](double& value) { value = *next++; });
  update_surface();
  mass_ = assemble_mass();
}

template <int dim>
void RigidBodies<dim>::save(CheckpointWriter& writer) const {
  writer.file().create_group(group);
  writer.file().write_text(names_path, joined_names(bodies_));
  writer.file().write_replicated(values_path, state());
}

template <int dim>
void RigidBodies<dim>::load(const CheckpointReader& reader) {
  const Hdf5File& file = reader.file();
  check_input(file.exists(names_path) && file.read_text(names_path) == joined_names(bodies_),
              "{}: the checkpoint does not hold the rigid bodies of this scene; restart with the "
              "scene that wrote it.",
              file.path());
  const std::vector<double> values = file.read_all<double>(values_path);
  check_input(values.size() == state().size(),
              "{}: the checkpoint's rigid bodies are incomplete; restart from another one.",
              file.path());
  set_state(values);
}

template <int dim>
void RigidBodies<dim>::add_frames(std::vector<SurfaceFrame>& frames) const {
  for (const RigidBody<dim>& body : bodies_) {
    if (body.seen_by_fluid)
      continue;
    SurfaceFrame frame;
    frame.name = body.name;
    frame.dimension = dim;
    frame.simplex_size = dim;
    for (const Point<dim>& x : body.surface.vertices) {
      const Point<dim> place = body.pose.position + body.pose.orientation * x;
      frame.vertices.insert(frame.vertices.end(), place.data(), place.data() + dim);
    }
    SurfaceField velocity{"velocity", "m/s", dim, SurfaceField::Place::simplices, {}};
    for (const auto& simplex : body.surface.simplices) {
      frame.simplices.insert(frame.simplices.end(), simplex.begin(), simplex.end());
      Point<dim> middle = Point<dim>::Zero();
      for (const int vertex : simplex)
        middle += body.surface.vertices[vertex] / dim;
      const Point<dim> place = body.pose.position + body.pose.orientation * middle;
      const Point<dim> v = body.last_move.velocity(place);
      velocity.values.insert(velocity.values.end(), v.data(), v.data() + dim);
    }
    frame.fields.push_back(std::move(velocity));
    frames.push_back(std::move(frame));
  }
}

template void RigidBodies<2>::add_frames(std::vector<SurfaceFrame>&) const;
template void RigidBodies<3>::add_frames(std::vector<SurfaceFrame>&) const;
template void RigidBodies<2>::save(CheckpointWriter&) const;
template void RigidBodies<3>::save(CheckpointWriter&) const;
template void RigidBodies<2>::load(const CheckpointReader&);
template void RigidBodies<3>::load(const CheckpointReader&);

}  // namespace lockstep
