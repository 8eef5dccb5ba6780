#include "mac/pressure/row_builder.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

/// The arrays that the matrix will keep, filled in place.
struct RowBuilder::Arrays {
  using Local = CrsMatrix::local_matrix_device_type;
  typename Local::row_map_type::non_const_type starts;
  typename Local::index_type::non_const_type columns;
  typename Local::values_type::non_const_type values;
};

RowBuilder::RowBuilder(const RCP<const Map>& map, int entries_per_row)
    : map_(map),
      first_(map->getMinGlobalIndex()),
      n_rows_(static_cast<int>(map->getNodeNumElements())),
      arrays_(std::make_unique<Arrays>()) {
  const std::size_t capacity = static_cast<std::size_t>(n_rows_) * entries_per_row;
  const auto raw = [](const char* name) {
    return Kokkos::view_alloc(std::string(name), Kokkos::WithoutInitializing);
  };
  arrays_->starts = decltype(arrays_->starts)(raw("starts"), n_rows_ + 1);
  arrays_->columns = decltype(arrays_->columns)(raw("columns"), capacity);
  arrays_->values = decltype(arrays_->values)(raw("values"), capacity);
  columns_ = arrays_->columns.data();
  values_ = arrays_->values.data();
  starts_ = arrays_->starts.data();
  starts_[0] = 0;
}

RowBuilder::~RowBuilder() = default;

std::size_t RowBuilder::add(GlobalIndex column, double value) {
  LOCKSTEP_ASSERT(size_ < arrays_->columns.size());
  const GlobalIndex local = column - first_;
  if (local >= 0 && local < n_rows_) {
    columns_[size_] = static_cast<int>(local);
  } else {
    ghosts_.push_back({size_, column});
    columns_[size_] = -1;
  }
  values_[size_] = value;
  return size_++;
}

void RowBuilder::set(std::size_t place, double value) {
  values_[place] = value;
}

void RowBuilder::end_row() {
  starts_[++row_] = size_;
}

void RowBuilder::sort_rows() {
  for (int row = 0; row < n_rows_; ++row)
    for (std::size_t i = starts_[row] + 1; i < starts_[row + 1]; ++i)
      for (std::size_t j = i; j > starts_[row] && columns_[j] < columns_[j - 1]; --j) {
        std::swap(columns_[j], columns_[j - 1]);
        std::swap(values_[j], values_[j - 1]);
      }
}

std::vector<GlobalIndex> RowBuilder::number_ghosts() {
  // Ids of other ranks ascend with the rank, so sorting groups them by owner, as imports want it.
  std::vector<GlobalIndex> remote;
  for (const GhostEntry& entry : ghosts_)
    remote.push_back(entry.column);
  std::sort(remote.begin(), remote.end());
  remote.erase(std::unique(remote.begin(), remote.end()), remote.end());
  for (const GhostEntry& entry : ghosts_)
    columns_[entry.place] =
        n_rows_ + static_cast<int>(std::lower_bound(remote.begin(), remote.end(), entry.column) -
                                   remote.begin());
  return remote;
}

RCP<const CrsMatrix> RowBuilder::finish() {
  LOCKSTEP_ASSERT(row_ == n_rows_);
  const std::vector<GlobalIndex> remote = number_ghosts();
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
  const auto used = std::make_pair(std::size_t(0), size_);
  const auto matrix =
      rcp(new CrsMatrix(map_, column_map, arrays_->starts, Kokkos::subview(arrays_->columns, used),
                        Kokkos::subview(arrays_->values, used)));
  matrix->expertStaticFillComplete(map_, map_, importer);
  return matrix;
}

}  // namespace lockstep
