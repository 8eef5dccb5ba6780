#include "linear/block_diagonal.hpp"

#include <Eigen/Cholesky>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <map>
#include <set>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

namespace {

using Row = std::vector<Entry>;
using Component = std::set<GlobalIndex>;  // sorted, so that all ranks invert it in the same order

/// Marks the rows of this rank with a nonzero beside the diagonal, in the row or in its column. The
/// others, which are all of them where masses are lumped, are blocks of their own. Collective.
std::vector<char> find_tied_rows(const CrsMatrix& matrix) {
  const auto rows = matrix.getRowMap(), columns = matrix.getColMap();
  std::vector<char> tied(rows->getNodeNumElements(), 0);
  Vector in_column(columns);
  {
    const auto values_in_column = in_column.getDataNonConst();
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    for (std::size_t row = 0; row < tied.size(); ++row) {
      matrix.getLocalRowView(static_cast<int>(row), indices, values);
      const int own = columns->getLocalElement(rows->getGlobalElement(static_cast<int>(row)));
      for (std::size_t k = 0; k < indices.extent(0); ++k) {
        if (values(k) == 0 || indices(k) == own)
          continue;
        tied[row] = 1;
        values_in_column[indices(k)] = 1;
      }
    }
  }
  Vector in_row(matrix.getDomainMap());
  if (const auto importer = matrix.getGraph()->getImporter(); importer.is_null())
    in_row.update(1, in_column, 0);
  else
    add_overlap(in_column, *importer, in_row);
  const auto entries = in_row.getData();
  for (std::size_t row = 0; row < tied.size(); ++row) {
    const GlobalIndex id = rows->getGlobalElement(static_cast<int>(row));
    if (entries[matrix.getDomainMap()->getLocalElement(id)] != 0)
      tied[row] = 1;
  }
  return tied;
}

/// The rows this rank knows: its own that are tied to others, and those of other ranks that its
/// components reach.
class KnownRows {
 public:
  KnownRows(const RCP<const CrsMatrix>& matrix, const std::vector<char>& is_tied)
      : matrix_(matrix) {
    add(*matrix, matrix->getRowMap()->getNodeElementList(), is_tied);
  }

  /// Fetches rows from the ranks that own them. Collective.
  void fetch(const std::vector<GlobalIndex>& ids) {
    const auto wanted =
        rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                    Teuchos::arrayViewFromVector(ids), 0, matrix_->getRowMap()->getComm()));
    CrsMatrix fetched(wanted, 0);
    fetched.doImport(*matrix_, Import(matrix_->getRowMap(), wanted), Tpetra::INSERT);
    fetched.fillComplete(matrix_->getDomainMap(), matrix_->getRangeMap());
    add(fetched, wanted->getNodeElementList(), std::vector<char>(ids.size(), 1));
  }

  /// The row, or null if it has not been fetched.
  const Row* find(GlobalIndex id) const {
    const auto found = rows_.find(id);
    return found == rows_.end() ? nullptr : &found->second;
  }

  /// The rows connected to `seed` as far as they are known, at most `limit` + 1 of them; those
  /// still missing are added to `missing`.
  Component component(GlobalIndex seed, int limit, Component& missing) const {
    Component members{seed};
    std::vector<GlobalIndex> stack{seed};
    Component unknown;
    while (!stack.empty() && static_cast<int>(members.size()) <= limit) {
      const GlobalIndex id = stack.back();
      stack.pop_back();
      const Row* row = find(id);
      if (row == nullptr) {
        unknown.insert(id);
        continue;
      }
      for (const Entry& entry : *row) {
        if (static_cast<int>(members.size()) <= limit && members.insert(entry.column).second)
          stack.push_back(entry.column);
      }
    }
    if (static_cast<int>(members.size()) <= limit)
      missing.insert(unknown.begin(), unknown.end());
    return members;
  }

 private:
  void add(const CrsMatrix& matrix, const Teuchos::ArrayView<const GlobalIndex>& ids,
           const std::vector<char>& is_wanted) {
    for (int row = 0; row < ids.size(); ++row) {
      if (is_wanted[row])
        rows_[ids[row]];
    }
    for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
      if (value != 0 && is_wanted[row])
        rows_[ids[row]].push_back({column, value});
    });
  }

  RCP<const CrsMatrix> matrix_;
  std::map<GlobalIndex, Row> rows_;
};

/// Joins components that share rows. They do where round-off has left a zero in one of two entries
/// that symmetry makes equal: then one row's component holds the other's, but not the reverse.
std::vector<Component> disjoint(std::vector<Component> components) {
  std::vector<Component> result;
  std::map<GlobalIndex, std::size_t> place_of;
  for (Component& component : components) {
    std::set<std::size_t> met;
    for (const GlobalIndex id : component) {
      if (const auto found = place_of.find(id); found != place_of.end())
        met.insert(found->second);
    }
    for (const std::size_t place : met) {
      component.insert(result[place].begin(), result[place].end());
      result[place].clear();
    }
    for (const GlobalIndex id : component)
      place_of[id] = result.size();
    result.push_back(std::move(component));
  }
  return result;
}

/// The components of this rank's tied rows, at most those up to `limit` whole; fetches what is
/// missing. Collective.
std::vector<Component> find_components(KnownRows& rows, const Map& map,
                                       const std::vector<char>& is_tied, int limit) {
  while (true) {
    std::vector<Component> small, large;
    Component missing, done;
    for (std::size_t row = 0; row < is_tied.size(); ++row) {
      const GlobalIndex id = map.getGlobalElement(static_cast<int>(row));
      if (!is_tied[row] || done.count(id) > 0)
        continue;
      Component component = rows.component(id, limit, missing);
      const bool is_small = static_cast<int>(component.size()) <= limit;
      if (is_small)
        done.insert(component.begin(), component.end());
      (is_small ? small : large).push_back(std::move(component));
    }
    if (max_all(map.getComm(), static_cast<GlobalIndex>(missing.size())) == 0) {
      std::vector<Component> all = disjoint(std::move(small));
      all.insert(all.end(), large.begin(), large.end());
      return all;
    }
    rows.fetch({missing.begin(), missing.end()});
  }
}

Eigen::MatrixXd dense(const KnownRows& rows, const std::vector<GlobalIndex>& ids) {
  const auto n = static_cast<Eigen::Index>(ids.size());
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const Entry& entry : *rows.find(ids[i])) {
      const auto position = std::lower_bound(ids.begin(), ids.end(), entry.column) - ids.begin();
      block(i, position) += entry.value;
    }
  }
  return block;
}

/// Inverse by Cholesky of the block scaled to a unit diagonal, so that kg and kg m^2 may differ by
/// any factor. An empty matrix if it is not positive definite.
template <typename Real>
Eigen::MatrixXd inverse_spd_in(const Eigen::MatrixXd& block) {
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  if (!(block.diagonal().minCoeff() > 0))
    return {};
  const auto scale = block.diagonal().template cast<Real>().cwiseSqrt().cwiseInverse().eval();
  const Eigen::LLT<Matrix> factor(scale.asDiagonal() * block.cast<Real>() * scale.asDiagonal());
  if (factor.info() != Eigen::Success)
    return {};
  const Matrix identity = Matrix::Identity(block.rows(), block.cols());
  const Matrix inverse = scale.asDiagonal() * factor.solve(identity) * scale.asDiagonal();
  return (Real(0.5) * (inverse + inverse.transpose())).template cast<double>();
}

/// Small blocks in extended precision: those of a few bodies whose contacts are held are stiff, and
/// in double the inverse would lose the digits of what is free.
Eigen::MatrixXd inverse_spd(const Eigen::MatrixXd& block) {
  constexpr Eigen::Index most_extended = 48;
  return block.rows() <= most_extended ? inverse_spd_in<long double>(block)
                                       : inverse_spd_in<double>(block);
}

}  // namespace

std::string not_positive_definite(const std::string& name) {
  return fmt::format(
      "The {} is not positive definite: masses must be positive and D negative semidefinite. A "
      "node without mass that no mixed face sees needs a stiffness or damping that is implicit: "
      "give its body a mass, bending stiffness or a coarser mesh. Contact knows no stiffness: with "
      "it bodies need a mass, or \"Contact/Type\" is \"none\".",
      name);
}

bool has_small_blocks(const RCP<const CrsMatrix>& matrix, int largest_block) {
  const auto map = matrix->getRowMap();
  const std::vector<char> is_tied = find_tied_rows(*matrix);
  KnownRows rows(matrix, is_tied);
  const std::vector<Component> components = find_components(rows, *map, is_tied, largest_block);
  const bool are_small =
      std::all_of(components.begin(), components.end(), [&](const Component& component) {
        return static_cast<int>(component.size()) <= largest_block;
      });
  return min_all(map->getComm(), are_small ? 1.0 : 0.0) > 0;
}

BlockDiagonalInverse block_diagonal_inverse(const RCP<const CrsMatrix>& matrix, int largest_block,
                                            const std::string& name) {
  const auto map = matrix->getRowMap();
  const std::vector<char> is_tied = find_tied_rows(*matrix);
  const bool any_tied = std::find(is_tied.begin(), is_tied.end(), 1) != is_tied.end();
  if (max_all(map->getComm(), any_tied ? 1.0 : 0.0) == 0)
    return {jacobi_inverse(*matrix, name), true};
  KnownRows rows(matrix, is_tied);
  std::vector<Row> inverse_rows(map->getNodeNumElements());
  std::string failure;
  bool exact = true;
  for (const Component& component : find_components(rows, *map, is_tied, largest_block)) {
    if (component.empty())
      continue;
    std::vector<GlobalIndex> ids(component.begin(), component.end());
    if (static_cast<int>(ids.size()) > largest_block) {
      exact = false;
      continue;
    }
    const Eigen::MatrixXd inverse = inverse_spd(dense(rows, ids));
    if (inverse.size() == 0) {
      failure = not_positive_definite(name);
      continue;
    }
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const int row = map->getLocalElement(ids[i]);
      for (std::size_t j = 0; row >= 0 && j < ids.size(); ++j) {
        inverse_rows[row].push_back({ids[j], inverse(i, j)});
      }
    }
  }
  const auto diagonal = diagonal_of(*matrix);
  const auto values = diagonal->getData();
  for (std::size_t row = 0; row < inverse_rows.size(); ++row) {
    const GlobalIndex id = map->getGlobalElement(static_cast<int>(row));
    if (!inverse_rows[row].empty())
      continue;
    if (!(values[row] > 0))
      failure = not_positive_definite(name);
    inverse_rows[row].push_back({id, 1 / values[row]});
  }
  throw_on_all(map->getComm(), failure, static_cast<int>(ExitCode::solve_failed));
  return {matrix_from_rows(map, inverse_rows), min_all(map->getComm(), exact ? 1.0 : 0.0) > 0};
}

RCP<Vector> inverse_diagonal(const CrsMatrix& matrix, const std::string& name) {
  const auto result = diagonal_of(matrix);
  std::string failure;
  for (double& value : result->getDataNonConst()) {
    if (!(value > 0))
      failure = not_positive_definite(name);
    value = 1 / value;
  }
  throw_on_all(matrix.getComm(), failure, static_cast<int>(ExitCode::solve_failed));
  return result;
}

RCP<const CrsMatrix> jacobi_inverse(const CrsMatrix& matrix, const std::string& name) {
  const auto map = matrix.getRowMap();
  const RCP<const Vector> diagonal = inverse_diagonal(matrix, name);
  const auto values = diagonal->getData();
  std::vector<Row> rows(map->getNodeNumElements());
  for (std::size_t row = 0; row < rows.size(); ++row)
    rows[row].push_back({map->getGlobalElement(static_cast<int>(row)), values[row]});
  return matrix_from_rows(map, rows);
}

}  // namespace lockstep
