#include "mac/row_builder.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

RowBuilder::RowBuilder(const RCP<const Map>& map, int entries_per_row)
    : map_(map),
      first_(map->getMinGlobalIndex()),
      n_rows_(static_cast<int>(map->getNodeNumElements())),
      starts_(n_rows_ + 1, 0) {
  columns_.reserve(static_cast<std::size_t>(n_rows_) * entries_per_row);
  values_.reserve(static_cast<std::size_t>(n_rows_) * entries_per_row);
}

void RowBuilder::add(GlobalIndex column, double value) {
  const GlobalIndex local = column - first_;
  if (local >= 0 && local < n_rows_) {
    columns_.push_back(static_cast<int>(local));
  } else {
    ghosts_.push_back({columns_.size(), column});
    columns_.push_back(-1);
  }
  values_.push_back(value);
}

void RowBuilder::end_row() {
  starts_[++row_] = columns_.size();
}

void RowBuilder::sort_rows() {
  for (int row = 0; row < n_rows_; ++row)
    for (std::size_t i = starts_[row] + 1; i < starts_[row + 1]; ++i)
      for (std::size_t j = i; j > starts_[row] && columns_[j] < columns_[j - 1]; --j) {
        std::swap(columns_[j], columns_[j - 1]);
        std::swap(values_[j], values_[j - 1]);
      }
}

RCP<const CrsMatrix> RowBuilder::finish() {
  LOCKSTEP_ASSERT(row_ == n_rows_);
  // Ids of other ranks ascend with the rank, so sorting groups them by owner, as imports want it.
  std::vector<GlobalIndex> remote;
  for (const GhostEntry& entry : ghosts_)
    remote.push_back(entry.column);
  std::sort(remote.begin(), remote.end());
  remote.erase(std::unique(remote.begin(), remote.end()), remote.end());
  for (const GhostEntry& entry : ghosts_)
    columns_[entry.position] =
        n_rows_ + static_cast<int>(std::lower_bound(remote.begin(), remote.end(), entry.column) -
                                   remote.begin());
  sort_rows();

  RCP<const Map> column_map = map_;
  RCP<const Import> importer;
  if (map_->getComm()->getSize() > 1) {
    std::vector<GlobalIndex> ids(n_rows_ + remote.size());
    for (int i = 0; i < n_rows_; ++i)
      ids[i] = first_ + i;
    std::copy(remote.begin(), remote.end(), ids.begin() + n_rows_);
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    column_map = rcp(new Map(unknown, Teuchos::arrayViewFromVector(ids), 0, map_->getComm()));
    importer = rcp(new Import(map_, column_map));
  }
  const std::size_t n = columns_.size();
  Teuchos::ArrayRCP<int> columns(n);
  Teuchos::ArrayRCP<double> values(n);
  std::copy(columns_.begin(), columns_.end(), columns.begin());
  std::copy(values_.begin(), values_.end(), values.begin());
  const auto matrix = rcp(new CrsMatrix(map_, column_map, starts_, columns, values));
  matrix->expertStaticFillComplete(map_, map_, importer);
  columns_ = {};
  values_ = {};
  return matrix;
}

}  // namespace lockstep
