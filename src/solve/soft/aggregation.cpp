#include "solve/soft/aggregation.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <utility>

#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

namespace {

/// By local column: the node of this rank, or -1.
std::vector<int> nodes_of_columns(const CrsMatrix& matrix, const RowsOfNodes& nodes) {
  const auto columns = matrix.getColMap();
  std::vector<int> result;
  for (std::size_t column = 0; column < columns->getNodeNumElements(); ++column) {
    const int row =
        matrix.getRowMap()->getLocalElement(columns->getGlobalElement(static_cast<int>(column)));
    result.push_back(row < 0 ? -1 : nodes.of_row[row]);
  }
  return result;
}

/// Returns for each node the nodes that its first row is tied to, with the node itself.
std::vector<std::vector<int>> neighbors_of_nodes(const CrsMatrix& matrix,
                                                 const RowsOfNodes& nodes) {
  const std::vector<int> node_of_column = nodes_of_columns(matrix, nodes);
  std::vector<std::vector<int>> result;
  for (const int row : nodes.first) {
    std::vector<int> neighbors{nodes.of_row[row]};
    typename CrsMatrix::local_inds_host_view_type columns;
    typename CrsMatrix::values_host_view_type values;
    matrix.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k) {
      const int node = node_of_column[columns(k)];
      if (values(k) != 0 && node >= 0 && node != neighbors.back())
        neighbors.push_back(node);
    }
    result.push_back(std::move(neighbors));
  }
  return result;
}

/// By local column of A: the id of its row in the coarse matrix, or -1. Collective.
std::vector<GlobalIndex> coarse_ids(const CrsMatrix& matrix, const std::vector<int>& place_of_row,
                                    const Map& map) {
  Vector of_rows(matrix.getRowMap());
  {
    const auto ids = of_rows.getDataNonConst();
    for (std::size_t row = 0; row < place_of_row.size(); ++row) {
      const int place = place_of_row[row];
      ids[row] = place < 0 ? -1.0 : static_cast<double>(map.getGlobalElement(place));
    }
  }
  std::vector<GlobalIndex> result;
  for (const double id : on_columns(matrix, of_rows)->getData())
    result.push_back(static_cast<GlobalIndex>(id));
  return result;
}

}  // namespace

Aggregates aggregate(const CrsMatrix& matrix, const RowsOfNodes& nodes) {
  const std::vector<std::vector<int>> neighbors = neighbors_of_nodes(matrix, nodes);
  Aggregates result{0, std::vector<int>(neighbors.size(), -1)};
  const auto is_free = [&result](int node) { return result.of_node[node] < 0; };
  for (const std::vector<int>& around : neighbors) {
    if (std::all_of(around.begin(), around.end(), is_free)) {
      for (const int node : around)
        result.of_node[node] = result.n;
      ++result.n;
    }
  }
  const std::vector<int> begun = result.of_node;
  for (std::size_t node = 0; node < neighbors.size(); ++node) {
    if (begun[node] >= 0)
      continue;
    const auto beside = std::find_if(neighbors[node].begin(), neighbors[node].end(),
                                     [&begun](int other) { return begun[other] >= 0; });
    result.of_node[node] = beside == neighbors[node].end() ? result.n++ : begun[*beside];
  }
  return result;
}

RCP<CrsMatrix> coarse_matrix(const CrsMatrix& matrix, const std::vector<int>& place_of_row,
                             const RCP<const Map>& map) {
  const std::vector<GlobalIndex> id_of_column = coarse_ids(matrix, place_of_row, *map);
  std::vector<std::vector<int>> rows_of_place(map->getNodeNumElements());
  for (std::size_t row = 0; row < place_of_row.size(); ++row) {
    if (place_of_row[row] >= 0)
      rows_of_place[place_of_row[row]].push_back(static_cast<int>(row));
  }
  std::vector<std::vector<Entry>> rows(rows_of_place.size());
  std::vector<int> entry_of_id(map->getGlobalNumElements(), -1);
  for (std::size_t place = 0; place < rows.size(); ++place) {
    for (const int row : rows_of_place[place]) {
      typename CrsMatrix::local_inds_host_view_type columns;
      typename CrsMatrix::values_host_view_type values;
      matrix.getLocalRowView(row, columns, values);
      for (std::size_t k = 0; k < columns.extent(0); ++k) {
        const GlobalIndex id = id_of_column[columns(k)];
        if (id < 0)
          continue;
        if (entry_of_id[id] < 0) {
          entry_of_id[id] = static_cast<int>(rows[place].size());
          rows[place].push_back({id, 0});
        }
        rows[place][entry_of_id[id]].value += values(k);
      }
    }
    for (const Entry& entry : rows[place])
      entry_of_id[entry.column] = -1;
  }
  return matrix_from_rows(map, rows);
}

}  // namespace lockstep
