#include "base/errors.hpp"
#include "coupling/attachments.hpp"

namespace lockstep {

namespace {

int carrier_named(const std::string& name, const std::vector<SolidDescription>& solids,
                  std::string& failure) {
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (solids[s].name == name && solids[s].rigid && !solids[s].prescribed)
      return static_cast<int>(s);
  }
  failure = fmt::format(
      "Nodes are attached to \"{}\", which is no solid that is rigid and dynamic; name one, or pin "
      "the nodes and give them a motion.",
      name);
  return 0;
}

/// This rank's nodes, each as the solid, the model, the dofs and the position.
template <int dim>
std::vector<double> packed_nodes(const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
                                 const std::vector<ModelBegin>& begin,
                                 const std::vector<SolidDescription>& solids,
                                 std::string& failure) {
  std::vector<double> packed;
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (const NodeAttachment<dim>& node : models[m]->attachments()) {
      packed.push_back(carrier_named(node.solid, solids, failure));
      packed.push_back(static_cast<double>(m));
      for (const GlobalIndex dof : node.dofs)
        packed.push_back(static_cast<double>(begin[m].id + dof));
      packed.insert(packed.end(), node.position.data(), node.position.data() + dim);
    }
  }
  return packed;
}

template <int dim>
typename Attachments<dim>::Node unpacked_node(const double* value) {
  typename Attachments<dim>::Node node;
  node.solid = static_cast<int>(*value++);
  node.model = static_cast<int>(*value++);
  for (GlobalIndex& dof : node.dofs)
    dof = static_cast<GlobalIndex>(*value++);
  node.position = Eigen::Map<const Point<dim>>(value);
  return node;
}

}  // namespace

template <int dim>
Attachments<dim> find_attachments(const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
                                  const std::vector<ModelBegin>& begin,
                                  const std::vector<SolidDescription>& solids,
                                  const Communicator& comm) {
  std::string failure;
  const std::vector<double> mine = packed_nodes<dim>(models, begin, solids, failure);
  throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
  const std::vector<double> all = gather_all(comm, mine);
  std::vector<typename Attachments<dim>::Node> nodes;
  std::vector<VelocityRow<dim>> rows;
  for (std::size_t k = 0; k < all.size(); k += 2 + 2 * dim) {
    nodes.push_back(unpacked_node<dim>(&all[k]));
    const SolidDescription& carrier = solids[nodes.back().solid];
    SurfacePoint<dim> point;
    point.simplex = carrier.simplex_begin - begin[carrier.model].simplex;
    rows.emplace_back();
    models[carrier.model]->velocity_row(point, nodes.back().position, rows.back());
    for (GlobalIndex& id : rows.back().dofs)
      id += begin[carrier.model].id;
  }
  Attachments<dim> attachments;
  attachments.set(std::move(nodes), rows);
  return attachments;
}

template Attachments<2> find_attachments(const std::vector<std::unique_ptr<SolidModel<2>>>&,
                                         const std::vector<ModelBegin>&,
                                         const std::vector<SolidDescription>&, const Communicator&);
template Attachments<3> find_attachments(const std::vector<std::unique_ptr<SolidModel<3>>>&,
                                         const std::vector<ModelBegin>&,
                                         const std::vector<SolidDescription>&, const Communicator&);

}  // namespace lockstep
