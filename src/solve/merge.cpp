#include "solve/merge.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

RCP<const CrsMatrix> need_assembled(const RCP<const LinearOperator>& op, const char* block,
                                    const BlockSystem& system) {
  const auto matrix = assembled(op);
  check_solve(!matrix.is_null(),
              "The {} of the {} is matrix-free, but a direct solve needs it assembled. Choose an "
              "iterative strategy.",
              block, system.name);
  return matrix;
}

/// Appends `factor` times the entries of `matrix`, columns shifted, to the rows from `first_row`
/// on.
void append(const CrsMatrix& matrix, double factor, GlobalIndex column_shift, int first_row,
            std::vector<std::vector<Entry>>& rows) {
  for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
    rows[first_row + row].push_back({column + column_shift, factor * value});
  });
}

/// Rows and columns of the multipliers; rank 0 owns them, and the other ranks send their entries.
void add_border(const BlockSystem& system, double scale, GlobalIndex first_id, CrsMatrix& matrix) {
  for (std::size_t k = 0; k < system.null_space.size(); ++k) {
    const RCP<const Vector> null_vector = system.null_space.vector(k);
    const auto values = null_vector->getData();
    const GlobalIndex multiplier = first_id + static_cast<GlobalIndex>(k);
    for (int i = 0; i < static_cast<int>(values.size()); ++i) {
      const GlobalIndex row = null_vector->getMap()->getGlobalElement(i);
      const double value = scale * values[i];
      if (value == 0)
        continue;
      matrix.insertGlobalValues(row, 1, &value, &multiplier);
      matrix.insertGlobalValues(multiplier, 1, &value, &row);
    }
  }
}

}  // namespace

MergedSystem merge(const BlockSystem& system) {
  const auto a = need_assembled(system.pressure_block(), "pressure block", system);
  MergedSystem merged;
  merged.n_local_pressure = static_cast<int>(a->getNodeNumRows());
  const auto comm = a->getComm();
  const auto n_pressure = static_cast<GlobalIndex>(a->getGlobalNumRows());
  GlobalIndex n_solid = 0;

  std::vector<std::vector<Entry>> rows(merged.n_local_pressure);
  std::vector<GlobalIndex> ids;
  for (int i = 0; i < merged.n_local_pressure; ++i) {
    ids.push_back(a->getRowMap()->getGlobalElement(i));
  }
  append(*a, 1, 0, 0, rows);
  if (system.has_solid()) {
    const auto c = need_assembled(system.solid_block(), "solid block", system);
    n_solid = static_cast<GlobalIndex>(c->getGlobalNumRows());
    merged.n_local_solid = static_cast<int>(c->getNodeNumRows());
    rows.resize(merged.n_local_pressure + merged.n_local_solid);
    for (int i = 0; i < merged.n_local_solid; ++i) {
      ids.push_back(n_pressure + c->getRowMap()->getGlobalElement(i));
    }
    Tpetra::RowMatrixTransposer<double, int, GlobalIndex> transposer(system.coupling_transposed());
    append(*transposer.createTranspose(), -1, n_pressure, 0, rows);
    append(*system.coupling_transposed(), -1, 0, merged.n_local_pressure, rows);
    append(*c, -1, n_pressure, merged.n_local_pressure, rows);
  }
  const auto n_null = static_cast<GlobalIndex>(system.null_space.size());
  for (GlobalIndex k = 0; is_root(comm) && k < n_null; ++k) {
    ids.push_back(n_pressure + n_solid + k);
  }

  const auto map =
      rcp(new Map(n_pressure + n_solid + n_null, Teuchos::arrayViewFromVector(ids), 0, comm));
  Teuchos::Array<std::size_t> counts(ids.size(), static_cast<std::size_t>(n_pressure));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    counts[row] = rows[row].size() + static_cast<std::size_t>(n_null);
  }
  const auto matrix = rcp(new CrsMatrix(map, counts()));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const Entry& entry : rows[row]) {
      matrix->insertGlobalValues(ids[row], 1, &entry.value, &entry.column);
    }
  }
  add_border(system, diagonal_of(*a)->normInf(), n_pressure + n_solid, *matrix);
  matrix->fillComplete();
  merged.matrix = matrix;
  return merged;
}

RCP<Vector> to_merged(const MergedSystem& merged, const BlockVector& vector) {
  const auto result = make_vector(merged.matrix->getRowMap());
  const auto to = result->getDataNonConst();
  const auto pressure = vector.pressure->getData();
  std::copy(pressure.begin(), pressure.end(), to.begin());
  if (!vector.solid.is_null()) {
    const auto solid = vector.solid->getData();
    std::copy(solid.begin(), solid.end(), to.begin() + merged.n_local_pressure);
  }
  return result;
}

void from_merged(const MergedSystem& merged, const Vector& vector, BlockVector& result) {
  const auto from = vector.getData();
  const auto solid_begin = from.begin() + merged.n_local_pressure;
  std::copy(from.begin(), solid_begin, result.pressure->getDataNonConst().begin());
  if (!result.solid.is_null())
    std::copy(solid_begin, solid_begin + merged.n_local_solid,
              result.solid->getDataNonConst().begin());
}

}  // namespace lockstep
