#include "solve/soft/additive_multilevel.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <memory>
#include <numeric>

#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "solve/soft/aggregation.hpp"
#include "solve/soft/component_cholesky.hpp"

namespace lockstep {

namespace {

/// Rows of a level that is solved exactly, which then takes less time than its messages.
constexpr GlobalIndex few_rows = 300;

RowsOfNodes nodes_of(const NearNullSpace& space) {
  RowsOfNodes nodes{space.n_axes(), first_rows_of_nodes(space),
                    std::vector<int>(space.body_of_row.size(), -1)};
  for (std::size_t node = 0; node < nodes.first.size(); ++node) {
    for (int a = 0; a < nodes.n_axes; ++a)
      nodes.of_row[nodes.first[node] + a] = static_cast<int>(node);
  }
  return nodes;
}

RowsOfNodes all_rows(int n_nodes, int n_axes) {
  RowsOfNodes nodes{n_axes, {}, {}};
  for (int node = 0; node < n_nodes; ++node) {
    nodes.first.push_back(n_axes * node);
    nodes.of_row.insert(nodes.of_row.end(), n_axes, node);
  }
  return nodes;
}

RCP<const LinearOperator> inverse_on_levels(const RCP<const CrsMatrix>& matrix,
                                            const RowsOfNodes& nodes, const std::string& name);

/// diag(A)^-1 + Q (the inverse of the next level) Q^T.
class Level {
 public:
  Level(const RCP<const CrsMatrix>& matrix, const RowsOfNodes& nodes, const Aggregates& aggregates,
        const std::string& name)
      : diagonal_inverse_(inverse_diagonal(*matrix, name)),
        coarse_rhs_(
            make_vector(make_map(nodes.n_axes * aggregates.n, matrix->getRowMap()->getComm()))),
        coarse_solution_(make_vector(coarse_rhs_->getMap())) {
    for (std::size_t row = 0; row < nodes.of_row.size(); ++row) {
      const int node = nodes.of_row[row];
      const int axis = node < 0 ? 0 : static_cast<int>(row) - nodes.first[node];
      place_.push_back(node < 0 ? -1 : aggregates.of_node[node] * nodes.n_axes + axis);
    }
    coarse_ = inverse_on_levels(coarse_matrix(*matrix, place_, coarse_rhs_->getMap()),
                                all_rows(aggregates.n, nodes.n_axes), name);
  }

  void apply(const Vector& x, Vector& y) const {
    restrict_to_coarse(x);
    lockstep::apply(*coarse_, *coarse_rhs_, *coarse_solution_);
    const auto from = x.getData(), scale = diagonal_inverse_->getData(),
               coarse = coarse_solution_->getData();
    const auto to = y.getDataNonConst();
    for (std::size_t row = 0; row < place_.size(); ++row)
      to[row] = scale[row] * from[row] + (place_[row] < 0 ? 0.0 : coarse[place_[row]]);
  }

 private:
  void restrict_to_coarse(const Vector& x) const {
    coarse_rhs_->putScalar(0);
    const auto from = x.getData();
    const auto to = coarse_rhs_->getDataNonConst();
    for (std::size_t row = 0; row < place_.size(); ++row) {
      if (place_[row] >= 0)
        to[place_[row]] += from[row];
    }
  }

  RCP<const Vector> diagonal_inverse_;
  std::vector<int> place_;  ///< by row: that of the coarse vector; -1: no node's
  RCP<Vector> coarse_rhs_, coarse_solution_;
  RCP<const LinearOperator> coarse_;
};

RCP<const LinearOperator> inverse_on_levels(const RCP<const CrsMatrix>& matrix,
                                            const RowsOfNodes& nodes, const std::string& name) {
  const auto map = matrix->getRowMap();
  const auto n = static_cast<GlobalIndex>(map->getGlobalNumElements());
  if (n <= few_rows) {
    const std::vector<RowComponent> as_one(map->getNodeNumElements(), {0, n});
    return cheap_component_cholesky(matrix, as_one, 1e300, name).inverse;
  }
  const Aggregates aggregates = aggregate(*matrix, nodes);
  const auto counted = [&](std::size_t count) {
    return sum_all(map->getComm(), static_cast<GlobalIndex>(count));
  };
  const GlobalIndex n_aggregates = counted(aggregates.n);
  if (n_aggregates == 0 || n_aggregates == counted(nodes.first.size()))
    return as_operator(jacobi_inverse(*matrix, name));
  const auto level = std::make_shared<const Level>(matrix, nodes, aggregates, name);
  return action_operator(map, [level](const Vector& x, Vector& y) { level->apply(x, y); });
}

}  // namespace

RCP<const LinearOperator> additive_multilevel_inverse(const RCP<const CrsMatrix>& c,
                                                      const NearNullSpace& space,
                                                      const std::string& name) {
  if (space.empty())
    return as_operator(jacobi_inverse(*c, name));
  return inverse_on_levels(c, nodes_of(space), name);
}

}  // namespace lockstep
