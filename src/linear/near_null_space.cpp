#include "linear/near_null_space.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/matrix_part.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// Rows of a node that no other row is tied to are held, or feel no D.
std::vector<bool> tied_rows(const CrsMatrix& c, const NearNullSpace& space) {
  std::vector<bool> tied(space.body_of_row.size(), false);
  const std::vector<int> own = own_columns(c);
  for (int row = 0; row < static_cast<int>(tied.size()); ++row) {
    typename CrsMatrix::local_inds_host_view_type columns;
    typename CrsMatrix::values_host_view_type values;
    c.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.extent(0) && space.body_of_row[row] >= 0; ++k)
      tied[row] = tied[row] || (values(k) != 0 && columns(k) != own[row]);
  }
  return tied;
}

}  // namespace

std::vector<int> first_rows_of_nodes(const RigidMotions& space) {
  std::vector<int> rows;
  const int n_rows = static_cast<int>(space.body_of_row.size());
  for (int row = 0; row < n_rows; ++row) {
    if (space.body_of_row[row] < 0)
      continue;
    LOCKSTEP_ASSERT(row + space.n_axes() <= n_rows);
    rows.push_back(row);
    row += space.n_axes() - 1;
  }
  return rows;
}

RCP<Vector> lumped_mass(const LinearOperator& mass, const RigidMotions& space) {
  const auto masses = make_vector(space.motions->getMap());
  const auto result = masses->getDataNonConst();
  Vector sums(space.motions->getMap());
  for (int a = 0; a < space.n_axes(); ++a) {
    apply(mass, *space.motions->getVector(a), sums);
    const auto values = sums.getData();
    const auto translation = space.motions->getData(a);
    for (int row = 0; row < static_cast<int>(values.size()); ++row) {
      if (translation[row] != 0)
        result[row] = values[row];
    }
  }
  return masses;
}

double stiffness_number(const CrsMatrix& c, const NearNullSpace& space) {
  if (space.empty())
    return 1;
  const std::vector<bool> tied = tied_rows(c, space);
  const RCP<const Vector> diagonal = diagonal_of(c);
  const auto mass = space.mass->getData(), entry = diagonal->getData();
  double of_c = 0, of_mass = 0;
  for (std::size_t row = 0; row < tied.size(); ++row) {
    if (tied[row]) {
      of_c += entry[row];
      of_mass += mass[row];
    }
  }
  sum_over_ranks(c.getComm(), of_c, of_mass);
  return of_mass > 0 ? of_c / of_mass : 1;
}

bool is_stiff(double stiffness_number) {
  constexpr double worth_a_cycle = 150;
  return stiffness_number > worth_a_cycle;
}

RCP<const LinearOperator> block_diagonal_mass_inverse(const RCP<const CrsMatrix>& c,
                                                      const NearNullSpace& space,
                                                      const std::string& name) {
  if (space.empty())
    return as_operator(block_diagonal_inverse(c, largest_dense_block, name).inverse);
  std::vector<bool> is_node, is_other;
  for (const int body : space.body_of_row) {
    is_node.push_back(body >= 0);
    is_other.push_back(body < 0);
  }
  const auto node_part = std::make_shared<const MatrixPart>(*c, is_node);
  const auto others = std::make_shared<const MatrixPart>(*c, is_other);
  const MatrixPart& nodes = *node_part;
  const RCP<Vector> inverse = nodes.restricted(*space.mass);
  std::string failure;
  for (double& value : inverse->getDataNonConst()) {
    if (!(value > 0))
      failure = fmt::format(
          "The {} has a node without mass, its own or of fluid lumped on it: \"Block Diagonal "
          "Mass\" cannot divide by it. Choose another \"Solid Inverse\".",
          name);
    value = 1 / value;
  }
  throw_on_all(c->getComm(), failure, static_cast<int>(ExitCode::solve_failed));
  const auto of_nodes = action_operator(nodes.map(), [inverse](const Vector& x, Vector& y) {
    y.elementWiseMultiply(1, *inverse, x, 0);
  });
  std::vector<PartInverse> parts{{node_part, of_nodes}};
  if (!others->empty())
    parts.push_back(part_of_blocks(others, name));
  return inverse_by_parts(c->getRowMap(), parts);
}

}  // namespace lockstep
