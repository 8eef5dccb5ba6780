#include "solve/soft/component_cholesky.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <list>
#include <map>
#include <memory>
#include <stdexcept>
#include <unordered_map>

#include "base/errors.hpp"
#include "base/signals.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/gathered_operator.hpp"
#include "solve/soft/multifrontal_cholesky.hpp"

namespace lockstep {

namespace {

/// A component's rows, as they stand on rank 0, and its factors.
struct Factored {
  std::vector<int> rows;
  MultifrontalCholesky factors;
};

/// The lower triangle of the block of these rows, a component, taken from the upper one. With the
/// zeros that are stored: which entries vanish changes from step to step, and each time the
/// analysis would be another.
MultifrontalCholesky::Matrix part_of(const CrsMatrix& all, const std::vector<int>& rows,
                                     const Teuchos::ArrayRCP<const double>& components,
                                     std::vector<int>& place_of) {
  const int n = static_cast<int>(rows.size());
  for (int i = 0; i < n; ++i)
    place_of[rows[i]] = i;
  MultifrontalCholesky::Matrix result(n, n);
  const auto global = all.getColMap()->getNodeElementList();
  typename CrsMatrix::local_inds_host_view_type columns;
  typename CrsMatrix::values_host_view_type values;
  for (int i = 0; i < n; ++i) {
    result.startVec(i);
    all.getLocalRowView(rows[i], columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k) {
      const auto column = static_cast<int>(global[columns(k)]);
      if (column >= rows[i] && components[column] == components[rows[i]])
        result.insertBack(place_of[column], i) = values(k);
    }
  }
  result.finalize();
  return result;
}

/// An analysis, and the places of the entries of which it is.
struct Analysis {
  explicit Analysis(const MultifrontalCholesky::Matrix& matrix)
      : begin(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1),
        rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()) {
    const HeldSignals held;  // METIS
    factors.analyze(matrix);
  }
  bool is_of(const MultifrontalCholesky::Matrix& matrix) const {
    return matrix.outerSize() + 1 == static_cast<Eigen::Index>(begin.size()) &&
           matrix.nonZeros() == static_cast<Eigen::Index>(rows.size()) &&
           std::equal(begin.begin(), begin.end(), matrix.outerIndexPtr()) &&
           std::equal(rows.begin(), rows.end(), matrix.innerIndexPtr());
  }
  std::vector<int> begin, rows;
  std::size_t hash = 0;          ///< hash of `begin` and `rows`
  MultifrontalCholesky factors;  ///< without values
};

std::size_t hash_of(const MultifrontalCholesky::Matrix& matrix) {
  std::size_t hash = static_cast<std::size_t>(matrix.outerSize());
  const auto add = [&hash](int value) {
    hash = (hash ^ static_cast<std::size_t>(value)) * 1099511628211u;  // FNV
  };
  std::for_each_n(matrix.outerIndexPtr(), matrix.outerSize() + 1, add);
  std::for_each_n(matrix.innerIndexPtr(), matrix.nonZeros(), add);
  return hash;
}

/// The last analyses: the matrices of a solid, several a step, mostly have their entries in the
/// same places, and an analysis takes as long as the factors.
class Analyses {
 public:
  /// Returns an analysis of the matrix, without numerical factors.
  const MultifrontalCholesky& of(const MultifrontalCholesky::Matrix& matrix) {
    const std::size_t hash = hash_of(matrix);
    const auto [begin, end] = places_.equal_range(hash);
    const auto found =
        std::find_if(begin, end, [&](const auto& place) { return place.second->is_of(matrix); });
    if (found != end) {
      kept_.splice(kept_.begin(), kept_, found->second);
      return kept_.front().factors;
    }
    kept_.emplace_front(matrix);
    places_.emplace(hash, kept_.begin());
    kept_.front().hash = hash;
    n_entries_ += kept_.front().rows.size();
    while (kept_.size() > 1 && n_entries_ > most_entries)
      forget_last();
    return kept_.front().factors;
  }

 private:
  static constexpr std::size_t most_entries = 20000000;

  void forget_last() {
    const Analysis& last = kept_.back();
    n_entries_ -= last.rows.size();
    const auto [begin, end] = places_.equal_range(last.hash);
    places_.erase(
        std::find_if(begin, end, [&](const auto& place) { return &*place.second == &last; }));
    kept_.pop_back();
  }

  std::list<Analysis> kept_;  ///< the last one used first
  std::unordered_multimap<std::size_t, std::list<Analysis>::iterator> places_;  ///< by hash
  std::size_t n_entries_ = 0;
};

/// All on rank 0: `components` by row, `is_factored` is written.
SolveInPlace factor_components(const CrsMatrix& gathered, const Vector& components,
                               double most_operations, Vector& is_factored) {
  static Analyses analyses;
  const std::size_t n_rows = gathered.getNodeNumRows();
  std::map<double, std::vector<int>> rows_of_component;
  const auto ids = components.getData();
  for (std::size_t row = 0; row < n_rows; ++row)
    rows_of_component[ids[row]].push_back(static_cast<int>(row));
  const auto parts = std::make_shared<std::vector<std::unique_ptr<Factored>>>();
  std::vector<int> place_of(n_rows);
  for (auto& [id, rows] : rows_of_component) {
    auto part = std::make_unique<Factored>();
    part->rows = std::move(rows);
    const MultifrontalCholesky::Matrix matrix = part_of(gathered, part->rows, ids, place_of);
    part->factors = analyses.of(matrix);
    if (part->factors.n_operations() > most_operations)
      continue;
    if (!part->factors.factorize(matrix))
      throw std::runtime_error("A pivot of its Cholesky factors is not positive.");
    for (const int row : part->rows)
      is_factored.replaceLocalValue(row, 1.0);
    parts->push_back(std::move(part));
  }
  return [parts, n_rows](double* values) {
    std::vector<double> result(n_rows, 0);
    for (const auto& part : *parts) {
      Eigen::VectorXd solution(part->rows.size());
      for (std::size_t i = 0; i < part->rows.size(); ++i)
        solution[i] = values[part->rows[i]];
      if (solution.isZero(0))
        continue;  // an impulse on one of many bodies
      part->factors.solve(solution);
      for (std::size_t i = 0; i < part->rows.size(); ++i)
        result[part->rows[i]] = solution[i];
    }
    std::copy(result.begin(), result.end(), values);
  };
}

}  // namespace

ComponentCholesky cheap_component_cholesky(const RCP<const CrsMatrix>& matrix,
                                           const std::vector<RowComponent>& components,
                                           double most_operations, const std::string& name) {
  const auto map = matrix->getRowMap();
  const auto n = static_cast<GlobalIndex>(map->getGlobalNumElements());
  const auto root_map =
      rcp(new Map(n, is_root(map->getComm()) ? static_cast<std::size_t>(n) : 0, 0, map->getComm()));
  const Import gather(map, root_map);
  Vector ids(map), ids_on_root(root_map), factored(map), factored_on_root(root_map);
  for (std::size_t row = 0; row < components.size(); ++row)
    ids.replaceLocalValue(static_cast<int>(row), static_cast<double>(components[row].id));
  ids_on_root.doImport(ids, gather, Tpetra::INSERT);
  ComponentCholesky result;
  result.inverse = gathered_operator(
      matrix,
      [&](const CrsMatrix& gathered) {
        return factor_components(gathered, ids_on_root, most_operations, factored_on_root);
      },
      not_positive_definite(name));
  factored.doExport(factored_on_root, gather, Tpetra::INSERT);
  for (const double flag : factored.getData())
    result.is_factored.push_back(flag != 0);
  return result;
}

}  // namespace lockstep
