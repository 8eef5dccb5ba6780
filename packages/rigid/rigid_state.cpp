// Checkpoints of the rigid bodies.
#include "base/errors.hpp"
#include "output/checkpoint.hpp"
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
void RigidBodies<dim>::save(CheckpointWriter& writer) const {
  std::vector<double> values{time_};
  for (RigidBody<dim> body : bodies_)
    for_each_value(body, [&](double& value) { values.push_back(value); });
  writer.file().create_group(group);
  writer.file().write_text(names_path, joined_names(bodies_));
  writer.file().write_replicated(values_path, values);
}

template <int dim>
void RigidBodies<dim>::load(const CheckpointReader& reader) {
  const Hdf5File& file = reader.file();
  check_input(file.exists(names_path) && file.read_text(names_path) == joined_names(bodies_),
              "{}: the checkpoint does not hold the rigid bodies of this scene; restart with the "
              "scene that wrote it.",
              file.path());
  const std::vector<double> values = file.read_all<double>(values_path);
  std::size_t next = 0;
  const auto take = [&](double& value) {
    check_input(next < values.size(),
                "{}: the checkpoint's rigid bodies are incomplete; restart from another one.",
                file.path());
    value = values[next++];
  };
  take(time_);
  for (RigidBody<dim>& body : bodies_)
    for_each_value(body, take);
  update_surface();
  mass_ = assemble_mass();
}

template void RigidBodies<2>::save(CheckpointWriter&) const;
template void RigidBodies<3>::save(CheckpointWriter&) const;
template void RigidBodies<2>::load(const CheckpointReader&);
template void RigidBodies<3>::load(const CheckpointReader&);

}  // namespace lockstep
