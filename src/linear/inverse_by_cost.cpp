#include "linear/inverse_by_cost.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/block_diagonal.hpp"
#include "linear/component_cholesky.hpp"
#include "linear/components.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// Components of more entries are not even analysed: a volume's factors would cost too much, and
/// even a surface's come near the limit.
constexpr double most_entries = 800000;
/// About half a second, which pays where the iteration takes a hundred steps an application and is
/// applied a few dozen times.
constexpr double most_operations = 1e9;

template <typename Condition>
std::vector<bool> rows_where(const std::vector<RowComponent>& components, Condition condition) {
  std::vector<bool> result;
  for (const RowComponent& component : components)
    result.push_back(condition(component.n_rows));
  return result;
}

std::vector<RowComponent> chosen(const std::vector<RowComponent>& all,
                                 const std::vector<bool>& is_chosen) {
  std::vector<RowComponent> result;
  for (std::size_t row = 0; row < all.size(); ++row) {
    if (is_chosen[row])
      result.push_back(all[row]);
  }
  return result;
}

bool any(const std::vector<bool>& rows, const Communicator& comm) {
  const bool here = std::find(rows.begin(), rows.end(), true) != rows.end();
  return max_all(comm, here ? 1.0 : 0.0) > 0;
}

}  // namespace

InverseByCost::InverseByCost(const RCP<const LinearOperator>& op, const std::string& name)
    : map_(domain_map(*op)) {
  const auto matrix = assembled(op);
  if (matrix.is_null())
    rest_ = op;
  else
    split(matrix, name);
}

void InverseByCost::split(const RCP<const CrsMatrix>& matrix, const std::string& name) {
  const Communicator comm = map_->getComm();
  const std::vector<RowComponent> components = components_of_rows(*matrix);
  const auto is_small =
      rows_where(components, [](GlobalIndex n) { return n <= largest_dense_block; });
  auto is_rest = rows_where(components, [](GlobalIndex n) { return n > largest_dense_block; });
  if (!any(is_rest, comm)) {
    whole_ = as_operator(block_diagonal_inverse(matrix, largest_dense_block, name).inverse);
    return;
  }
  const double entries_of_row = static_cast<double>(matrix->getGlobalNumEntries()) /
                                static_cast<double>(matrix->getGlobalNumRows());
  const auto is_medium = rows_where(components, [&](GlobalIndex n) {
    return n > largest_dense_block && static_cast<double>(n) * entries_of_row <= most_entries;
  });
  if (any(is_medium, comm)) {
    const auto part = std::make_shared<const MatrixPart>(*matrix, is_medium);
    const ComponentCholesky cholesky = cheap_component_cholesky(
        part->matrix(), chosen(components, is_medium), most_operations, name);
    if (any(cholesky.is_factored, comm))
      cheap_.push_back({part, cholesky.inverse});
    auto factored = cholesky.is_factored.begin();
    for (std::size_t row = 0; row < is_medium.size(); ++row) {
      if (is_medium[row])
        is_rest[row] = !*factored++;
    }
  }
  if (any(is_small, comm))
    cheap_.push_back(part_of_blocks(std::make_shared<const MatrixPart>(*matrix, is_small), name));
  if (!any(is_rest, comm))
    return;
  if (cheap_.empty()) {
    rest_ = as_operator(matrix);
    return;
  }
  rest_part_ = std::make_shared<const MatrixPart>(*matrix, is_rest);
  rest_ = as_operator(RCP<const CrsMatrix>(rest_part_->matrix()));
}

NearNullSpace InverseByCost::of_rest(const NearNullSpace& all) const {
  if (!rest_part_ || all.empty())
    return all;
  NearNullSpace result;
  const auto motions = rcp(new MultiVector(rest_part_->map(), all.motions->getNumVectors()));
  for (std::size_t j = 0; j < motions->getNumVectors(); ++j)
    rest_part_->restrict_to(*all.motions->getVector(j), *motions->getVectorNonConst(j));
  result.motions = motions;
  result.n_bodies = all.n_bodies;
  for (const int row : rest_part_->rows())
    result.body_of_row.push_back(all.body_of_row[row]);
  return result;
}

RCP<const LinearOperator> InverseByCost::with(const RCP<const LinearOperator>& of_rest) const {
  if (!whole_.is_null())
    return whole_;
  if (cheap_.empty())
    return of_rest;
  std::vector<PartInverse> parts = cheap_;
  if (rest_part_)
    parts.push_back({rest_part_, of_rest});
  return inverse_by_parts(map_, parts);
}

}  // namespace lockstep
