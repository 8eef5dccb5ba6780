#include "solve/soft/inverse_by_cost.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <map>

#include "linear/block_diagonal.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/soft/component_cholesky.hpp"
#include "solve/soft/components.hpp"

namespace lockstep {

namespace {

/// Components of more entries are not even analysed, which takes a tenth of a second for half of
/// them: a volume's factors would cost too much, and even a surface's come near the limit.
constexpr double most_entries = 6e6;
/// About a second, which pays where the iteration takes a hundred steps an application and is
/// applied a few dozen times: the factors of a sheet of 14 900 nodes take 3e9 and .25 s.
constexpr double most_operations = 1e10;
/// A component of this many rows is judged, and iterated on, by itself; at most so many of them.
constexpr GlobalIndex fewest_rows_alone = 2000;
constexpr std::size_t most_alone = 8;
/// Below this stiffness number an iteration takes less time than factors and the solves with them:
/// a few dozen steps on a cloth of 7 650 rows as much as .03 s.
constexpr double least_stiffness_for_factors = 300;
/// Up to this one they pay if they take few multiplications an entry, as those of sheets do: 1 150
/// on one of 14 900 nodes, where S2 takes .5 s with them and 1.9 s without at a stiffness number of
/// some 2 000. A ball of 8 000 nodes takes 4 700.
constexpr double great_stiffness = 5000, most_operations_an_entry = 2000;

template <typename Condition>
std::vector<bool> rows_where(const std::vector<RowComponent>& components, Condition condition) {
  std::vector<bool> result;
  for (const RowComponent& component : components)
    result.push_back(condition(component));
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

/// The ids of the largest components, in ascending order; the same on all ranks.
std::vector<GlobalIndex> large_components(const std::vector<RowComponent>& components,
                                          const Communicator& comm) {
  std::map<GlobalIndex, GlobalIndex> rows_of;
  for (const RowComponent& component : components) {
    if (component.n_rows >= fewest_rows_alone)
      rows_of[component.id] = component.n_rows;
  }
  std::vector<GlobalIndex> mine;
  for (const auto& [id, n_rows] : rows_of)
    mine.insert(mine.end(), {id, n_rows});
  const std::vector<GlobalIndex> all = gather_all(comm, mine);
  for (std::size_t i = 0; i < all.size(); i += 2)
    rows_of[all[i]] = all[i + 1];
  std::vector<std::pair<GlobalIndex, GlobalIndex>> by_size;
  for (const auto& [id, n_rows] : rows_of)
    by_size.emplace_back(-n_rows, id);
  std::sort(by_size.begin(), by_size.end());
  by_size.resize(std::min(by_size.size(), most_alone));
  std::vector<GlobalIndex> ids;
  for (const auto& component : by_size)
    ids.push_back(component.second);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// With the bodies that it holds on any rank, numbered anew. Collective.
NearNullSpace restricted(const NearNullSpace& all, const MatrixPart& part) {
  if (all.empty())
    return all;
  NearNullSpace result;
  const auto motions = rcp(new MultiVector(part.map(), all.motions->getNumVectors()));
  for (std::size_t j = 0; j < motions->getNumVectors(); ++j)
    part.restrict_to(*all.motions->getVector(j), *motions->getVectorNonConst(j));
  result.motions = motions;
  result.mass = part.restricted(*all.mass);
  std::vector<double> is_inside(all.n_bodies, 0);
  for (const int row : part.rows()) {
    if (all.body_of_row[row] >= 0)
      is_inside[all.body_of_row[row]] = 1;
  }
  sum_over_ranks(part.map()->getComm(), is_inside);
  std::vector<int> number(all.n_bodies, -1);
  for (int b = 0; b < all.n_bodies; ++b) {
    if (is_inside[b] > 0)
      number[b] = result.n_bodies++;
  }
  for (const int row : part.rows())
    result.body_of_row.push_back(all.body_of_row[row] < 0 ? -1 : number[all.body_of_row[row]]);
  return result;
}

InverseByCost::Rest rest_of(const std::shared_ptr<const MatrixPart>& part,
                            const NearNullSpace& space) {
  const NearNullSpace motions = restricted(space, *part);
  return {as_operator(RCP<const CrsMatrix>(part->matrix())), motions,
          stiffness_number(*part->matrix(), motions), part};
}

}  // namespace

InverseByCost::InverseByCost(const RCP<const LinearOperator>& op, const NearNullSpace& space,
                             const std::string& name, Costly* costly)
    : map_(domain_map(*op)), name_(name), costly_(costly) {
  const auto matrix = assembled(op);
  if (matrix.is_null())
    rests_.push_back({op, space, 1, nullptr});
  else
    split(matrix, space);
}

void InverseByCost::split(const RCP<const CrsMatrix>& matrix, const NearNullSpace& space) {
  const Communicator comm = map_->getComm();
  const std::vector<RowComponent> components = components_of_rows(*matrix, space);
  const auto is_block = rows_where(
      components, [](const RowComponent& one) { return one.n_rows <= largest_dense_block; });
  if (!any(rows_where(components,
                      [](const RowComponent& one) { return one.n_rows > largest_dense_block; }),
           comm)) {
    whole_ = as_operator(block_diagonal_inverse(matrix, largest_dense_block, name_).inverse);
    return;
  }
  const std::vector<GlobalIndex> large = large_components(components, comm);
  const auto is_small = rows_where(components, [&](const RowComponent& one) {
    return one.n_rows > largest_dense_block &&
           !std::binary_search(large.begin(), large.end(), one.id);
  });
  if (any(is_block, comm))
    cheap_.push_back(part_of_blocks(std::make_shared<const MatrixPart>(*matrix, is_block), name_));
  if (any(is_small, comm))
    take_small(*matrix, space, components, is_small);
  for (const GlobalIndex id : large)
    take_large(*matrix, space,
               rows_where(components, [id](const RowComponent& one) { return one.id == id; }));
}

/// All of them at once: those whose factors are cheap, and the others as one rest.
void InverseByCost::take_small(const CrsMatrix& matrix, const NearNullSpace& space,
                               const std::vector<RowComponent>& components,
                               std::vector<bool> is_small) {
  const auto part = std::make_shared<const MatrixPart>(matrix, is_small);
  const ComponentCholesky cholesky = cheap_component_cholesky(
      part->matrix(), chosen(components, is_small), most_operations, name_);
  if (any(cholesky.is_factored, map_->getComm()))
    cheap_.push_back({part, cholesky.inverse});
  auto is_factored = cholesky.is_factored.begin();
  for (std::size_t row = 0; row < is_small.size(); ++row) {
    if (is_small[row])
      is_small[row] = !*is_factored++;
  }
  if (any(is_small, map_->getComm()))
    rests_.push_back(rest_of(std::make_shared<const MatrixPart>(matrix, is_small), space));
}

/// Null if they take more multiplications than `most_operations`.
RCP<const LinearOperator> InverseByCost::factors(const Rest& rest, double most_operations) const {
  const CrsMatrix& matrix = *assembled(rest.op);
  const auto n_rows = static_cast<GlobalIndex>(matrix.getGlobalNumRows());
  const auto n_entries = static_cast<double>(matrix.getGlobalNumEntries());
  const std::array<double, 3> size{static_cast<double>(n_rows), n_entries, most_operations};
  if (n_entries > most_entries || (costly_ != nullptr && costly_->count(size) > 0))
    return Teuchos::null;
  const std::vector<RowComponent> as_one(matrix.getNodeNumRows(), {0, n_rows});
  const ComponentCholesky cholesky =
      cheap_component_cholesky(assembled(rest.op), as_one, most_operations, name_);
  if (any(cholesky.is_factored, map_->getComm()))
    return cholesky.inverse;
  if (costly_ != nullptr)
    costly_->insert(size);
  return Teuchos::null;
}

RCP<const LinearOperator> InverseByCost::cheap_factors(const Rest& rest) const {
  const auto matrix = assembled(rest.op);
  if (matrix.is_null())
    return Teuchos::null;
  const auto n_entries = static_cast<double>(matrix->getGlobalNumEntries());
  return factors(rest, std::min(most_operations, most_operations_an_entry * n_entries));
}

void InverseByCost::take_large(const CrsMatrix& matrix, const NearNullSpace& space,
                               const std::vector<bool>& rows) {
  const Rest rest = rest_of(std::make_shared<const MatrixPart>(matrix, rows), space);
  RCP<const LinearOperator> inverse;
  if (space.empty() || rest.stiffness > great_stiffness)
    inverse = factors(rest, most_operations);
  else if (rest.stiffness > least_stiffness_for_factors)
    inverse = cheap_factors(rest);
  if (inverse.is_null())
    rests_.push_back(rest);
  else
    cheap_.push_back({rest.part, inverse});
}

RCP<const LinearOperator> InverseByCost::with(const InverseOfRest& inverse_of_rest) const {
  if (!whole_.is_null())
    return whole_;
  std::vector<PartInverse> parts = cheap_;
  for (const Rest& rest : rests_) {
    if (rest.part == nullptr)
      return inverse_of_rest(rest);
    parts.push_back({rest.part, inverse_of_rest(rest)});
  }
  return inverse_by_parts(map_, parts);
}

}  // namespace lockstep
