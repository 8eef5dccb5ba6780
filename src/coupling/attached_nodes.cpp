#include "coupling/attached_nodes.hpp"

#include <fmt/format.h>

#include <map>

#include "interfaces/solid_sides.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

namespace {

/// The solids that can carry nodes.
std::map<std::string, int> carriers_by_name(const std::vector<SolidDescription>& solids) {
  std::map<std::string, int> carriers;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (solids[s].rigid && !solids[s].prescribed)
      carriers.emplace(solids[s].name, static_cast<int>(s));
  }
  return carriers;
}

/// Makes the row of a point of a rigid solid that has no surface.
template <int dim>
void unseen_row(const JointableSolids<dim>& model, int solid, const Point<dim>& x,
                VelocityRow<dim>& row) {
  row.clear();
  const GlobalIndex first = model.first_dof(solid);
  for (int k = 0; k < RigidFrame<dim>::n; ++k)
    row.dofs.push_back(first + k);
  for (int a = 0; a < dim; ++a)
    row.coefficients.push_back(Point<dim>::Unit(a));
  const Point<dim> arm = x - model.rigid_frame(solid).position;
  for (int r = 0; r < n_rotations<dim>; ++r)
    row.coefficients.push_back(rotate<dim>(AngularVector<dim>::Unit(r), arm));
}

}  // namespace

std::string no_carrier(const std::string& solid, const std::string& line,
                       const std::vector<std::string>& carriers) {
  const std::string nearest = nearest_name(solid, carriers);
  const std::string meant = nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest);
  if (line.empty())
    return fmt::format(
        "Nodes are attached to \"{}\", which is no solid that is rigid and dynamic.{} Name one, or "
        "pin the nodes and give them a motion.",
        solid, meant);
  return fmt::format(
      "The line \"{}\" is attached to \"{}\", which is no solid that is rigid and dynamic.{} Name "
      "one, or \"space\" for an end that is held in place. To hold cloth or a soft body by a line, "
      "attach its nodes (\"Attachments\") to a rigid body and the line to that.",
      line, solid, meant);
}

template <int dim>
std::vector<AttachedNode<dim>> find_attached_nodes(
    const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
    const std::vector<ModelBegin>& begin, const std::vector<SolidDescription>& solids,
    std::string& failure) {
  std::vector<AttachedNode<dim>> nodes;
  std::map<std::string, int> carriers;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::vector<NodeAttachment<dim>> attachments = models[m]->attachments();
    if (!attachments.empty() && carriers.empty())
      carriers = carriers_by_name(solids);
    for (const NodeAttachment<dim>& attachment : attachments) {
      const auto carrier = carriers.find(attachment.solid);
      if (carrier == carriers.end()) {
        std::vector<std::string> names;
        for (const auto& [name, solid] : carriers)
          names.push_back(name);
        failure = no_carrier(attachment.solid, attachment.line, names);
        return {};
      }
      AttachedNode<dim> node{attachment.dofs, static_cast<int>(m), carrier->second,
                             attachment.position};
      for (GlobalIndex& dof : node.dofs)
        dof += begin[m].id;
      nodes.push_back(node);
    }
  }
  return nodes;
}

template <int dim>
void rigid_row(const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
               const std::vector<ModelBegin>& begin, const SolidDescription& solid,
               const Point<dim>& x, VelocityRow<dim>& row) {
  const SolidModel<dim>& model = *models[solid.model];
  const auto* jointable = model.jointable();
  if (jointable && solid.simplex_begin == solid.simplex_end) {
    unseen_row(*jointable, solid.index_in_model, x, row);
  } else {
    SurfacePoint<dim> point;
    point.simplex = solid.simplex_begin - begin[solid.model].simplex;
    model.velocity_row(point, x, row);
  }
  for (GlobalIndex& id : row.dofs)
    id += begin[solid.model].id;
}

template <int dim>
std::vector<Combination> combinations_of(
    const std::vector<AttachedNode<dim>>& nodes,
    const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
    const std::vector<ModelBegin>& begin, const std::vector<SolidDescription>& solids) {
  std::vector<Combination> combinations;
  VelocityRow<dim> row;
  for (const AttachedNode<dim>& node : nodes) {
    rigid_row(models, begin, solids[node.solid], node.position, row);
    for (int a = 0; a < dim; ++a) {
      Combination combination{node.dofs[a], {}};
      for (std::size_t k = 0; k < row.dofs.size(); ++k) {
        if (row.coefficients[k][a] != 0)
          combination.terms.emplace_back(row.dofs[k], row.coefficients[k][a]);
      }
      combinations.push_back(std::move(combination));
    }
  }
  return combinations;
}

template std::vector<AttachedNode<2>> find_attached_nodes(
    const std::vector<std::unique_ptr<SolidModel<2>>>&, const std::vector<ModelBegin>&,
    const std::vector<SolidDescription>&, std::string&);
template std::vector<AttachedNode<3>> find_attached_nodes(
    const std::vector<std::unique_ptr<SolidModel<3>>>&, const std::vector<ModelBegin>&,
    const std::vector<SolidDescription>&, std::string&);
template void rigid_row(const std::vector<std::unique_ptr<SolidModel<2>>>&,
                        const std::vector<ModelBegin>&, const SolidDescription&, const Point<2>&,
                        VelocityRow<2>&);
template void rigid_row(const std::vector<std::unique_ptr<SolidModel<3>>>&,
                        const std::vector<ModelBegin>&, const SolidDescription&, const Point<3>&,
                        VelocityRow<3>&);
template std::vector<Combination> combinations_of(
    const std::vector<AttachedNode<2>>&, const std::vector<std::unique_ptr<SolidModel<2>>>&,
    const std::vector<ModelBegin>&, const std::vector<SolidDescription>&);
template std::vector<Combination> combinations_of(
    const std::vector<AttachedNode<3>>&, const std::vector<std::unique_ptr<SolidModel<3>>>&,
    const std::vector<ModelBegin>&, const std::vector<SolidDescription>&);

}  // namespace lockstep
