#include "solve/soft/component_cholesky.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <iostream>  // which Eigen's METIS wrapper forgets
#include <map>
#include <memory>
#include <stdexcept>

#include <Eigen/MetisSupport>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/gathered_operator.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

class Cholesky
    : public Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::MetisOrdering<int>> {
 public:
  /// Multiplications of `factorize`, from the columns' counts, known after `analyzePattern`.
  double n_operations() const { return m_nonZerosPerCol.cast<double>().squaredNorm(); }
};

/// A component's rows, as they stand on rank 0, and its factors.
struct Factored {
  std::vector<int> rows;
  Cholesky factors;
};

SparseMatrix part_of(const std::vector<std::vector<Entry>>& all, const std::vector<int>& rows,
                     std::vector<int>& place_of) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    place_of[rows[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Entry& entry : all[rows[i]]) {
      if (entry.value != 0 && entry.column <= rows[i])
        entries.emplace_back(static_cast<int>(i), place_of[entry.column], entry.value);
    }
  }
  SparseMatrix result(static_cast<int>(rows.size()), static_cast<int>(rows.size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// All on rank 0: `components` by row, `is_factored` is written.
SolveInPlace factor_components(const CrsMatrix& gathered, const Vector& components,
                               double most_operations, Vector& is_factored) {
  const auto all = rows_of(gathered);
  std::map<double, std::vector<int>> rows_of_component;
  const auto ids = components.getData();
  for (std::size_t row = 0; row < all.size(); ++row)
    rows_of_component[ids[row]].push_back(static_cast<int>(row));
  const auto parts = std::make_shared<std::vector<std::unique_ptr<Factored>>>();
  std::vector<int> place_of(all.size());
  for (auto& [id, rows] : rows_of_component) {
    auto part = std::make_unique<Factored>();
    part->rows = std::move(rows);
    const SparseMatrix matrix = part_of(all, part->rows, place_of);
    {
      const HeldSignals held;  // METIS
      part->factors.analyzePattern(matrix);
    }
    if (part->factors.n_operations() > most_operations)
      continue;
    part->factors.factorize(matrix);
    if (part->factors.info() != Eigen::Success)
      throw std::runtime_error("A pivot of its Cholesky factors is not positive.");
    for (const int row : part->rows)
      is_factored.replaceLocalValue(row, 1.0);
    parts->push_back(std::move(part));
  }
  return [parts, n = all.size()](double* values) {
    std::vector<double> result(n, 0);
    for (const auto& part : *parts) {
      Eigen::VectorXd rhs(part->rows.size());
      for (std::size_t i = 0; i < part->rows.size(); ++i)
        rhs[i] = values[part->rows[i]];
      const Eigen::VectorXd solution = part->factors.solve(rhs);
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
