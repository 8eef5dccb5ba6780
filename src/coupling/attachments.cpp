#include "coupling/attachments.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>

namespace lockstep {

template <int dim>
void Attachments<dim>::set(std::vector<Node> nodes, const std::vector<VelocityRow<dim>>& rows) {
  nodes_ = std::move(nodes);
  rows_.clear();
  carriers_.clear();
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const VelocityRow<dim>& row = rows[n];
    for (std::size_t k = 0; k < row.dofs.size(); ++k) {
      carriers_.emplace(row.dofs[k], carriers_.size());
      for (int a = 0; a < dim; ++a) {
        if (row.coefficients[k][a] != 0)
          rows_[nodes_[n].dofs[a]].emplace_back(row.dofs[k], row.coefficients[k][a]);
      }
    }
  }
}

template <int dim>
bool Attachments<dim>::holds_model(int model) const {
  return std::any_of(nodes_.begin(), nodes_.end(),
                     [&](const Node& node) { return node.model == model; });
}

template <int dim>
typename Attachments<dim>::Combination Attachments<dim>::combination(GlobalIndex dof) const {
  const auto found = rows_.find(dof);
  return found == rows_.end() ? Combination{{dof, 1.0}} : found->second;
}

template <int dim>
void Attachments<dim>::reduce(VelocityRow<dim>& row) const {
  if (empty())
    return;
  VelocityRow<dim> reduced;
  for (std::size_t k = 0; k < row.dofs.size(); ++k) {
    for (const auto& [dof, weight] : combination(row.dofs[k])) {
      reduced.dofs.push_back(dof);
      reduced.coefficients.push_back(weight * row.coefficients[k]);
    }
  }
  row = std::move(reduced);
}

template <int dim>
void Attachments<dim>::reduce(std::vector<Triplet>& triplets, const Map& map) const {
  if (empty())
    return;
  std::vector<Triplet> reduced;
  reduced.reserve(triplets.size());
  for (const Triplet& t : triplets) {
    const Combination columns = combination(t.column);
    for (const auto& [row, row_weight] : combination(t.row)) {
      for (const auto& [column, column_weight] : columns)
        reduced.push_back({row, column, row_weight * column_weight * t.value});
    }
  }
  for (const auto& row : rows_) {
    if (map.isNodeGlobalElement(row.first))
      reduced.push_back({row.first, row.first, 1});
  }
  triplets = std::move(reduced);
}

template <int dim>
void Attachments<dim>::reduce_momentum(Vector& momentum) const {
  if (empty())
    return;
  const Map& map = *momentum.getMap();
  std::vector<double> sums(carriers_.size(), 0);
  const auto values = momentum.getDataNonConst();
  for (const auto& [dof, row] : rows_) {
    if (!map.isNodeGlobalElement(dof))
      continue;
    double& own = values[map.getLocalElement(dof)];
    for (const auto& [carrier, weight] : row)
      sums[carriers_.at(carrier)] += weight * own;
    own = 0;
  }
  sum_all(map.getComm(), sums.data(), static_cast<int>(sums.size()));
  for (const auto& [carrier, number] : carriers_) {
    if (map.isNodeGlobalElement(carrier))
      values[map.getLocalElement(carrier)] += sums[number];
  }
}

template <int dim>
void Attachments<dim>::expand_velocity(Vector& velocity) const {
  if (empty())
    return;
  const Map& map = *velocity.getMap();
  std::vector<double> carried(carriers_.size(), 0);
  const auto values = velocity.getDataNonConst();
  for (const auto& [carrier, number] : carriers_) {
    if (map.isNodeGlobalElement(carrier))
      carried[number] = values[map.getLocalElement(carrier)];
  }
  sum_all(map.getComm(), carried.data(), static_cast<int>(carried.size()));
  for (const auto& [dof, row] : rows_) {
    if (!map.isNodeGlobalElement(dof))
      continue;
    double sum = 0;
    for (const auto& [carrier, weight] : row)
      sum += weight * carried[carriers_.at(carrier)];
    values[map.getLocalElement(dof)] = sum;
  }
}

template <int dim>
void Attachments<dim>::mask(Vector& values) const {
  const Map& map = *values.getMap();
  for (const auto& row : rows_) {
    if (map.isNodeGlobalElement(row.first))
      values.replaceGlobalValue(row.first, 0.);
  }
}

template class Attachments<2>;
template class Attachments<3>;

}  // namespace lockstep
