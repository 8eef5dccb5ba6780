#include "coupling/reduction.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <unordered_map>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {
namespace {

/// One combination a dof, terms of the same dof added up. A sentence if a dof has two.
std::string merge(std::vector<Combination>& combinations, const Reduction::NameOf& name_of) {
  for (Combination& combination : combinations) {
    auto& terms = combination.terms;
    std::sort(terms.begin(), terms.end());
    std::size_t kept = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (kept > 0 && terms[kept - 1].first == terms[k].first)
        terms[kept - 1].second += terms[k].second;
      else
        terms[kept++] = terms[k];
    }
    terms.resize(kept);
  }
  std::sort(combinations.begin(), combinations.end(),
            [](const Combination& a, const Combination& b) { return a.dof < b.dof; });
  const auto same_dof = [](const Combination& a, const Combination& b) { return a.dof == b.dof; };
  for (std::size_t k = 1; k < combinations.size(); ++k) {
    if (same_dof(combinations[k - 1], combinations[k]) &&
        combinations[k - 1].terms != combinations[k].terms)
      return fmt::format("{} is to follow two motions that differ; let one of them go.",
                         name_of(combinations[k].dof));
  }
  combinations.erase(std::unique(combinations.begin(), combinations.end(), same_dof),
                     combinations.end());
  return "";
}

std::vector<int> local_rows(const Map& map, const std::vector<GlobalIndex>& ids) {
  std::vector<int> rows;
  for (const GlobalIndex id : ids)
    rows.push_back(map.getLocalElement(id));
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// Calls `visit(local column, value)`.
template <typename Visit>
void for_each_local_entry(const CrsMatrix& matrix, int row, Visit visit) {
  typename CrsMatrix::local_inds_host_view_type indices;
  typename CrsMatrix::values_host_view_type values;
  matrix.getLocalRowView(row, indices, values);
  for (std::size_t k = 0; k < indices.extent(0); ++k)
    visit(indices(k), values(k));
}

/// Sums up entries by the number of their column: a dense row and a list of what stands in it, so
/// that a row costs what goes into it, not what comes out times a search.
class RowSum {
 public:
  using Entries = std::vector<std::pair<int, double>>;

  explicit RowSum(std::size_t n_columns) : sums_(n_columns, 0.), is_named_(n_columns, 0) {}

  void add(int column, double value) {
    if (!is_named_[column]) {
      is_named_[column] = 1;
      named_.push_back(column);
    }
    sums_[column] += value;
  }
  /// Returns the sums, and begins anew from zero.
  Entries take() {
    Entries entries;
    entries.reserve(named_.size());
    for (const int column : named_) {
      entries.push_back({column, sums_[column]});
      sums_[column] = 0;
      is_named_[column] = 0;
    }
    named_.clear();
    return entries;
  }

 private:
  std::vector<double> sums_;
  std::vector<char> is_named_;
  std::vector<int> named_;
};

/// One count for the columns of several matrices.
class ColumnNumbers {
 public:
  /// Returns the numbers of a column map's local indices.
  std::vector<int> of(const Map& columns) {
    std::vector<int> numbers;
    for (int k = 0; k < static_cast<int>(columns.getNodeNumElements()); ++k) {
      const GlobalIndex id = columns.getGlobalElement(k);
      const auto [entry, is_new] = number_of_.emplace(id, static_cast<int>(ids_.size()));
      if (is_new)
        ids_.push_back(id);
      numbers.push_back(entry->second);
    }
    return numbers;
  }
  const std::vector<GlobalIndex>& ids() const { return ids_; }

 private:
  std::unordered_map<GlobalIndex, int> number_of_;
  std::vector<GlobalIndex> ids_;
};

/// The rows of a matrix that are named by the columns of another one, in their order: local row k
/// is that of local column k. Collective.
RCP<const CrsMatrix> rows_of_columns(const RCP<const CrsMatrix>& rows, const CrsMatrix& matrix) {
  const auto importer = matrix.getGraph()->getImporter();
  if (importer.is_null())
    return rows;
  return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(rows, *importer, rows->getDomainMap(),
                                                           rows->getRangeMap());
}

/// mask K mask + (1 - mask), in place. Collective.
void eliminate_masked(CrsMatrix& matrix, const Vector& mask) {
  matrix.leftScale(mask);
  matrix.rightScale(mask);
  matrix.resumeFill();
  const auto keep = mask.getData();
  for (int row = 0; row < keep.size(); ++row) {
    if (keep[row] != 0)
      continue;
    const GlobalIndex id = matrix.getRowMap()->getGlobalElement(row);
    const double one = 1;
    matrix.replaceGlobalValues(id, Teuchos::arrayView(&id, 1), Teuchos::arrayView(&one, 1));
  }
  matrix.fillComplete();
}

void set_zero(const std::vector<int>& rows, Vector& vector) {
  if (rows.empty())
    return;
  const auto values = vector.getDataNonConst();
  for (const int row : rows)
    values[row] = 0;
}

}  // namespace

Reduction::Reduction(const RCP<const Map>& map, std::vector<Combination> combinations,
                     std::vector<GlobalIndex> given, const NameOf& name_of)
    : map_(map) {
  const Communicator comm = map->getComm();
  std::size_t n_combinations = combinations.size(), n_given = given.size();
  sum_over_ranks(comm, n_combinations, n_given);
  has_given_ = n_given > 0;
  if (n_combinations + n_given == 0)
    return;
  const NameOf called =
      name_of ? name_of : [](GlobalIndex dof) { return fmt::format("Dof {} of the solids", dof); };
  const auto unknowns = make_vector(map);
  unknowns->putScalar(1);
  given_ = local_rows(*map, given);
  set_zero(given_, *unknowns);
  unknowns_ = unknowns;
  if (n_combinations == 0)
    return;
  std::string failure = merge(combinations, called);
  std::vector<Triplet> triplets;
  for (const Combination& combination : combinations) {
    const int row = map->getLocalElement(combination.dof);
    if (std::binary_search(given_.begin(), given_.end(), row))
      failure = fmt::format("{} is held and is to follow another motion; let one of them go.",
                            called(combination.dof));
    combined_.push_back(row);
    for (const auto& [dof, weight] : combination.terms)
      triplets.push_back({combination.dof, dof, weight});
  }
  throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
  std::sort(combined_.begin(), combined_.end());
  set_zero(combined_, *unknowns);
  terms_ = assemble_triplets(std::move(triplets), map, map);
  resolve(called);
}

/// Puts the rows of combinations in the place of their dofs, until none is left: each pass
/// resolves twice as many levels as there were.
void Reduction::resolve(const NameOf& name_of) {
  const Communicator comm = map_->getComm();
  const GlobalIndex n_combinations = sum_all(comm, static_cast<GlobalIndex>(combined_.size()));
  Vector is_combined(map_);
  for (const int row : combined_)
    is_combined.replaceLocalValue(row, 1.);
  combinations_ = terms_;
  for (n_levels_ = 1;; n_levels_ *= 2) {
    const RCP<const Vector> unresolved = on_columns(*combinations_, is_combined);
    const auto is_left = unresolved->getData();
    GlobalIndex first = no_index;
    GlobalIndex n_left = 0;
    for_each_entry(*combinations_, [&](int row, GlobalIndex column, double) {
      if (is_left[combinations_->getColMap()->getLocalElement(column)] == 0)
        return;
      ++n_left;
      first = first == no_index ? map_->getGlobalElement(row) : first;
    });
    if (sum_all(comm, n_left) == 0)
      return;
    std::string failure;
    if (n_levels_ >= n_combinations && n_left > 0)
      failure = fmt::format("{} follows motions that follow one another in a circle; let one go.",
                            name_of(first));
    throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
    const RCP<const CrsMatrix> of_columns = rows_of_columns(combinations_, *combinations_);
    ColumnNumbers numbers;
    const std::vector<int> outer = numbers.of(*combinations_->getColMap());
    const std::vector<int> inner = numbers.of(*of_columns->getColMap());
    RowSum sum(numbers.ids().size());
    std::vector<Triplet> triplets;
    for (const int row : combined_) {
      for_each_local_entry(*combinations_, row, [&](int column, double weight) {
        if (is_left[column] == 0)
          sum.add(outer[column], weight);
        else
          for_each_local_entry(*of_columns, column, [&](int k, double inner_weight) {
            sum.add(inner[k], weight * inner_weight);
          });
      });
      for (const auto& [column, weight] : sum.take())
        triplets.push_back({map_->getGlobalElement(row), numbers.ids()[column], weight});
    }
    combinations_ = assemble_triplets(std::move(triplets), map_, map_);
  }
}

Reduction Reduction::with_velocity(const RCP<const Vector>& velocity) const {
  Reduction result = *this;
  result.offset_ = Teuchos::null;
  if (is_identity() || velocity.is_null() || velocity->normInf() == 0)
    return result;
  const auto offset = rcp(new Vector(*velocity, Teuchos::Copy));
  if (has_combinations()) {
    Vector sum(map_);
    for (int level = 0; level < n_levels_; ++level) {
      sum.update(1, *velocity, 0);
      terms_->apply(*offset, sum, Teuchos::NO_TRANS, 1, 1);
      offset->update(1, sum, 0);
    }
  }
  result.offset_ = offset;
  return result;
}

bool Reduction::differs_in_unknowns(const Reduction& other) const {
  if (is_identity() || other.is_identity())
    return is_identity() != other.is_identity();
  Vector change(*unknowns_, Teuchos::Copy);
  change.update(-1, *other.unknowns_, 1);
  return change.normInf() > 0;
}

std::vector<GlobalIndex> Reduction::combinations_among(const std::vector<GlobalIndex>& dofs) const {
  std::vector<GlobalIndex> among;
  if (!has_combinations())
    return among;
  Vector is_combined(map_);
  for (const int row : combined_)
    is_combined.replaceLocalValue(row, 1.);
  const RCP<const Import> import = import_of(dofs, map_);
  Vector wanted(import->getTargetMap());
  wanted.doImport(is_combined, *import, Tpetra::INSERT);
  const auto values = wanted.getData();
  for (int k = 0; k < values.size(); ++k) {
    if (values[k] != 0)
      among.push_back(wanted.getMap()->getGlobalElement(k));
  }
  return among;
}

void Reduction::set_combinations(const Vector& source, Vector& velocity) const {
  Vector sums(map_);
  combinations_->apply(source, sums);
  const auto from = sums.getData();
  const auto values = velocity.getDataNonConst();
  for (const int row : combined_)
    values[row] = from[row];
}

void Reduction::expand(Vector& velocity) const {
  expand_change(velocity);
  if (!offset_.is_null())
    velocity.update(1, *offset_, 1);
}

void Reduction::expand_change(Vector& change) const {
  set_zero(given_, change);
  follow(change);
}

void Reduction::follow(Vector& velocity) const {
  if (has_combinations())
    set_combinations(velocity, velocity);
}

void Reduction::select(Vector& velocity) const {
  set_zero(given_, velocity);
  set_zero(combined_, velocity);
}

RCP<Vector> Reduction::on_given(const Vector& reactions) const {
  Vector sums(reactions, Teuchos::Copy);
  if (has_combinations())
    combinations_->apply(reactions, sums, Teuchos::TRANS, 1, 1);
  const RCP<Vector> result = make_vector(reactions.getMap());
  const auto from = sums.getData();
  const auto values = result->getDataNonConst();
  for (const int row : given_)
    values[row] = from[row];
  return result;
}

void Reduction::drop_given(Vector& momentum) const {
  set_zero(given_, momentum);
}

void Reduction::restrict(Vector& momentum) const {
  if (has_combinations()) {
    Vector taken(map_);
    combinations_->apply(momentum, taken, Teuchos::TRANS);
    momentum.update(1, taken, 1);
  }
  select(momentum);
}

void Reduction::keep_reactions(Vector& residual) const {
  const RCP<Vector> reactions = make_vector(residual.getMap());
  if (has_combinations())
    combinations_->apply(residual, *reactions, Teuchos::TRANS, -1);
  {
    const auto from = residual.getData();
    const auto values = reactions->getDataNonConst();
    for (const auto* rows : {&given_, &combined_}) {
      for (const int row : *rows)
        values[row] = from[row];
    }
  }
  residual.update(1, *reactions, 0);
}

/// P^T (C P), row by row: C P first, then for each carrier the rows of the dofs that follow it.
RCP<CrsMatrix> Reduction::combined(const CrsMatrix& matrix) const {
  const RCP<const CrsMatrix> of_columns = rows_of_columns(combinations_, matrix);
  ColumnNumbers numbers;
  const std::vector<int> direct = numbers.of(*matrix.getColMap());
  const std::vector<int> through = numbers.of(*of_columns->getColMap());
  const std::vector<int> carriers = numbers.of(*combinations_->getColMap());
  Vector is_combined(map_);
  for (const int row : combined_)
    is_combined.replaceLocalValue(row, 1.);
  const auto row_is_combined = is_combined.getData();
  const RCP<const Vector> on_column = on_columns(matrix, is_combined);
  const auto column_is_combined = on_column->getData();

  RowSum sum(numbers.ids().size());
  std::vector<Triplet> triplets;
  const auto end_row = [&](GlobalIndex row) {
    for (const auto& [column, value] : sum.take())
      triplets.push_back({row, numbers.ids()[column], value});
  };
  std::vector<RowSum::Entries> rows;  // rows of C P of followers
  std::vector<std::vector<std::pair<int, double>>> followers(
      numbers.ids().size());  // followers of a carrier
  for (int row = 0; row < row_is_combined.size(); ++row) {
    for_each_local_entry(matrix, row, [&](int column, double value) {
      if (column_is_combined[column] == 0)
        sum.add(direct[column], value);
      else
        for_each_local_entry(*of_columns, column, [&](int inner, double weight) {
          sum.add(through[inner], value * weight);
        });
    });
    const GlobalIndex id = map_->getGlobalElement(row);
    if (row_is_combined[row] == 0) {
      end_row(id);
      continue;
    }
    triplets.push_back({id, id, 1});
    for_each_local_entry(*combinations_, row, [&](int carrier, double weight) {
      followers[carriers[carrier]].push_back({static_cast<int>(rows.size()), weight});
    });
    rows.push_back(sum.take());
  }
  for (std::size_t carrier = 0; carrier < followers.size(); ++carrier) {
    for (const auto& [row, weight] : followers[carrier]) {
      for (const auto& [column, value] : rows[row])
        sum.add(column, weight * value);
    }
    end_row(numbers.ids()[carrier]);
  }
  return assemble_triplets(std::move(triplets), map_, map_);
}

RCP<CrsMatrix> Reduction::reduce(const RCP<CrsMatrix>& matrix) const {
  const RCP<CrsMatrix> result = has_combinations() ? combined(*matrix) : matrix;
  if (has_given_)
    eliminate_masked(*result, *unknowns_);
  return result;
}

RCP<const CrsMatrix> Reduction::reduce_rows(const RCP<const CrsMatrix>& matrix) const {
  if (is_identity())
    return matrix;
  RCP<CrsMatrix> result;
  if (has_combinations()) {
    std::vector<Triplet> triplets;
    std::size_t next = 0;
    for_each_entry(*matrix, [&](int row, GlobalIndex column, double value) {
      while (next < combined_.size() && combined_[next] < row)
        ++next;
      if (next == combined_.size() || combined_[next] != row) {
        triplets.push_back({map_->getGlobalElement(row), column, value});
        return;
      }
      for_each_local_entry(*combinations_, row, [&](int carrier, double weight) {
        triplets.push_back(
            {combinations_->getColMap()->getGlobalElement(carrier), column, weight * value});
      });
    });
    result = assemble_triplets(std::move(triplets), map_, matrix->getDomainMap());
  } else {
    result = rcp(new CrsMatrix(*matrix, Teuchos::Copy));
  }
  if (has_given_)
    result->leftScale(*unknowns_);
  return result;
}

}  // namespace lockstep
