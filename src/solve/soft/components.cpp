#include "solve/soft/components.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/disjoint_sets.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// Sets of this rank's columns, each with the lowest row id known to be in it.
class ColumnSets {
 public:
  explicit ColumnSets(const CrsMatrix& matrix)
      : sets_(static_cast<int>(matrix.getColMap()->getNodeNumElements())),
        lowest_(matrix.getColMap()->getNodeNumElements()) {
    for (std::size_t column = 0; column < lowest_.size(); ++column)
      lowest_[column] = matrix.getColMap()->getGlobalElement(static_cast<int>(column));
  }

  void join(int a, int b) {
    const GlobalIndex together = std::min(lowest(a), lowest(b));
    sets_.join(a, b);
    lowest_[sets_.root(a)] = together;
  }
  GlobalIndex lowest(int column) { return lowest_[sets_.root(column)]; }
  /// True if that is news.
  bool lower(int column, GlobalIndex id) {
    GlobalIndex& lowest = lowest_[sets_.root(column)];
    const bool is_news = id < lowest;
    lowest = std::min(lowest, id);
    return is_news;
  }

 private:
  DisjointSets sets_;
  std::vector<GlobalIndex> lowest_;
};

/// Returns the number of occurrences of each of these ids on all ranks, in the same order.
std::vector<GlobalIndex> occurrences(const std::vector<GlobalIndex>& ids,
                                     const RCP<const Map>& row_map) {
  std::vector<GlobalIndex> unique = ids;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  const auto map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                               Teuchos::arrayViewFromVector(unique), 0, row_map->getComm()));
  Vector here(map), everywhere(row_map);
  const auto place_of = [&unique](GlobalIndex id) {
    return std::lower_bound(unique.begin(), unique.end(), id) - unique.begin();
  };
  {
    const auto counts = here.getDataNonConst();
    for (const GlobalIndex id : ids)
      counts[place_of(id)] += 1;
  }
  everywhere.doExport(here, Tpetra::Export<int, GlobalIndex>(map, row_map), Tpetra::ADD);
  here.doImport(everywhere, Import(row_map, map), Tpetra::INSERT);
  const auto counts = here.getData();
  std::vector<GlobalIndex> result;
  for (const GlobalIndex id : ids)
    result.push_back(static_cast<GlobalIndex>(counts[place_of(id)]));
  return result;
}

}  // namespace

std::vector<RowComponent> components_of_rows(const CrsMatrix& matrix, const NearNullSpace& space) {
  const auto row_map = matrix.getRowMap();
  const auto column_map = matrix.getColMap();
  const std::vector<int> column_of = own_columns(matrix);
  ColumnSets sets(matrix);
  const auto n_rows = static_cast<int>(row_map->getNodeNumElements());
  for (int row = 0; row < n_rows; ++row) {
    const int own = column_of[row];
    typename CrsMatrix::local_inds_host_view_type columns;
    typename CrsMatrix::values_host_view_type values;
    matrix.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k) {
      if (values(k) != 0)
        sets.join(own, columns(k));
    }
  }
  for (const int first : first_rows_of_nodes(space)) {
    for (int axis = 1; axis < space.n_axes(); ++axis)
      sets.join(column_of[first], column_of[first + axis]);
  }
  const auto importer = matrix.getGraph()->getImporter();
  for (bool changed = !importer.is_null(); changed;) {
    Vector lowest(row_map), seen(column_map);  // integers, which a double holds exactly
    for (int row = 0; row < n_rows; ++row)
      lowest.replaceLocalValue(row, static_cast<double>(sets.lowest(column_of[row])));
    seen.doImport(lowest, *importer, Tpetra::INSERT);
    bool news = false;
    const auto ids = seen.getData();
    for (int column = 0; column < static_cast<int>(ids.size()); ++column)
      news = sets.lower(column, static_cast<GlobalIndex>(ids[column])) || news;
    changed = max_all(row_map->getComm(), news ? 1.0 : 0.0) > 0;
  }
  std::vector<GlobalIndex> ids;
  for (int row = 0; row < n_rows; ++row)
    ids.push_back(sets.lowest(column_of[row]));
  const std::vector<GlobalIndex> sizes = occurrences(ids, row_map);
  std::vector<RowComponent> result;
  for (int row = 0; row < n_rows; ++row)
    result.push_back({ids[row], sizes[row]});
  return result;
}

}  // namespace lockstep
