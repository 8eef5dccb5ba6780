// Checkpoints of the deformable bodies.
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "deformable/deformable_solids.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

template <typename Bodies>
std::string joined_names(const Bodies& bodies) {
  std::string names;
  for (const auto& body : bodies)
    names += fmt::format("{} {}\n", body.name, body.node_end - body.node_begin);
  return names;
}

template <int dim>
std::vector<double> numbers_of(const std::vector<Point<dim>>& points, std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i)
    values.insert(values.end(), points[i].data(), points[i].data() + dim);
  return values;
}

template <int dim>
std::vector<Point<dim>> points_of(const std::vector<double>& values) {
  std::vector<Point<dim>> points(values.size() / dim);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Eigen::Map<const Point<dim>>(&values[dim * i]);
  return points;
}

/// Name in a checkpoint of the states of a body's elements.
std::string states_path(const std::string& type, int body) {
  return fmt::format("{}/element states {}", type, body);
}

/// Writes states of elements that laws keep, each by the rank that owns its first corner.
template <int dim>
void save_states(const ElementForces<dim>& forces, const std::string& type,
                 CheckpointWriter& writer) {
  for (const auto& one : forces.remembering) {
    const int n = one.group->n_state();
    const ElementCorners corners = one.group->corners();
    const std::vector<double>& states = *one.group->states();
    std::vector<GlobalIndex> ids;
    std::vector<double> values;
    for (std::size_t e = 0; e < one.numbers.size(); ++e) {
      if (corners.nodes[e * corners.n_corners] >= forces.nodes.n_owned())
        continue;
      ids.push_back(one.numbers[e]);
      values.insert(values.end(), &states[e * n], &states[e * n] + n);
    }
    writer.write_distributed(states_path(type, one.body), ids, values, n);
  }
}

template <int dim>
void load_states(ElementForces<dim>& forces, const std::string& type,
                 const CheckpointReader& reader) {
  for (auto& one : forces.remembering) {
    const std::vector<GlobalIndex> ids(one.numbers.begin(), one.numbers.end());
    std::vector<double>& states = *one.group->states();
    states =
        reader.read_distributed<double>(states_path(type, one.body), ids, one.group->n_state());
    reader.check(
        std::all_of(states.begin(), states.end(), [](double x) { return std::isfinite(x); }),
        "the states of elements of its soft solids are not finite");
  }
}

}  // namespace

template <int dim>
void DeformableSolids<dim>::save(CheckpointWriter& writer) const {
  std::vector<GlobalIndex> ids;
  for (int i = 0; i < nodes_.n_owned(); ++i)
    ids.push_back(nodes_.space.original(i));
  writer.file().create_group(type_);
  writer.file().write_text(type_ + "/names", joined_names(nodes_.bodies));
  writer.write_distributed(type_ + "/positions", ids, numbers_of<dim>(nodes_.x, ids.size()), dim);
  writer.write_distributed(type_ + "/velocities", ids,
                           numbers_of<dim>(nodes_.space.owned(*nodes_.velocity), ids.size()), dim);
  writer.file().write_replicated(type_ + "/surface velocities",
                                 numbers_of<dim>(surface_.velocity(), surface_.velocity().size()),
                                 dim);
  save_states(forces_, type_, writer);
}

template <int dim>
void DeformableSolids<dim>::load(const CheckpointReader& reader) {
  const Hdf5File& file = reader.file();
  check_input(
      file.exists(type_ + "/names") &&
          file.read_text(type_ + "/names") == joined_names(nodes_.bodies),
      "{}: the checkpoint does not hold the solids of type \"{}\" of this scene; restart with the "
      "scene that wrote it.",
      file.path(), type_);
  std::vector<GlobalIndex> ids;
  for (int i = 0; i < nodes_.space.n_local(); ++i)
    ids.push_back(nodes_.space.original(i));
  nodes_.x = points_of<dim>(reader.read_distributed<double>(type_ + "/positions", ids, dim));
  ids.resize(nodes_.n_owned());
  nodes_.velocity = nodes_.space.vector(
      points_of<dim>(reader.read_distributed<double>(type_ + "/velocities", ids, dim)));
  const std::vector<double> velocity = file.read_all<double>(type_ + "/surface velocities");
  reader.check(velocity.size() == dim * surface_.velocity().size(),
               "the surface velocities of its soft solids are incomplete");
  surface_.place(points_of<dim>(velocity));
  load_states(forces_, type_, reader);
  implicit_.end_step();
  update();
}

template void DeformableSolids<2>::save(CheckpointWriter&) const;
template void DeformableSolids<3>::save(CheckpointWriter&) const;
template void DeformableSolids<2>::load(const CheckpointReader&);
template void DeformableSolids<3>::load(const CheckpointReader&);

}  // namespace lockstep
