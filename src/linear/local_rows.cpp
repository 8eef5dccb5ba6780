#include "linear/local_rows.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <algorithm>
#include <string>
#include <utility>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// Those of other ranks, each once, by owner: as imports want them.
std::vector<GlobalIndex> of_other_ranks(const Map& map, std::vector<GlobalIndex> ids) {
  const auto is_here = [&](GlobalIndex id) { return map.isNodeGlobalElement(id); };
  ids.erase(std::remove_if(ids.begin(), ids.end(), is_here), ids.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<int> owners(ids.size());
  map.getRemoteIndexList(Teuchos::arrayViewFromVector(ids), Teuchos::arrayViewFromVector(owners));
  std::vector<std::pair<int, GlobalIndex>> by_owner;
  for (std::size_t i = 0; i < ids.size(); ++i)
    by_owner.emplace_back(owners[i], ids[i]);
  std::sort(by_owner.begin(), by_owner.end());
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = by_owner[i].second;
  return ids;
}

template <typename View, typename Value>
View view_of(const std::vector<Value>& values) {
  View view(Kokkos::view_alloc(std::string("local rows"), Kokkos::WithoutInitializing),
            values.size());
  std::copy(values.begin(), values.end(), view.data());
  return view;
}

}  // namespace

LocalColumns::LocalColumns(const RCP<const Map>& map, const std::vector<GlobalIndex>& ids)
    : map_(map), columns_(map) {
  if (map->getComm()->getSize() == 1)
    return;
  const auto own = map->getNodeElementList();
  std::vector<GlobalIndex> all(own.begin(), own.end());
  const std::vector<GlobalIndex> others = of_other_ranks(*map, ids);
  all.insert(all.end(), others.begin(), others.end());
  columns_ = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                         Teuchos::arrayViewFromVector(all), 0, map->getComm()));
  import_ = rcp(new Import(map, columns_));
}

void LocalRows::reserve(std::size_t n_entries) {
  indices_.reserve(n_entries);
  values_.reserve(n_entries);
}

void LocalRows::add(int column, double value) {
  std::ptrdiff_t& place = place_[column];
  if (place >= static_cast<std::ptrdiff_t>(begins_.back())) {
    values_[place] += value;
    return;
  }
  place = static_cast<std::ptrdiff_t>(values_.size());
  indices_.push_back(column);
  values_.push_back(value);
}

/// Most entries come in the order of their columns.
void LocalRows::end_row() {
  for (std::size_t i = begins_.back() + 1; i < indices_.size(); ++i) {
    for (std::size_t j = i; j > begins_.back() && indices_[j] < indices_[j - 1]; --j) {
      std::swap(indices_[j], indices_[j - 1]);
      std::swap(values_[j], values_[j - 1]);
    }
  }
  begins_.push_back(indices_.size());
}

RCP<CrsMatrix> LocalRows::matrix() {
  LOCKSTEP_ASSERT(begins_.size() == columns_.map()->getNodeNumElements() + 1);
  using Local = CrsMatrix::local_matrix_device_type;
  const auto matrix =
      rcp(new CrsMatrix(columns_.map(), columns_.columns(),
                        view_of<typename Local::row_map_type::non_const_type>(begins_),
                        view_of<typename Local::index_type::non_const_type>(indices_),
                        view_of<typename Local::values_type::non_const_type>(values_)));
  matrix->expertStaticFillComplete(columns_.map(), columns_.map(), columns_.import());
  return matrix;
}

}  // namespace lockstep
