#include "linear/triplet_matrix.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/errors.hpp"
#include "linear/row_builder.hpp"

namespace lockstep {
namespace {

/// Where the triplets of each row begin, rows counted from `first`, and the end.
std::vector<std::size_t> begins_of_rows(const std::vector<Triplet>& triplets, GlobalIndex first,
                                        GlobalIndex n_rows) {
  std::vector<std::size_t> begins(n_rows + 1, 0);
  for (const Triplet& t : triplets)
    ++begins[t.row - first + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  return begins;
}

/// Sorts triplets by row and column; those of one place keep their order, so that sums do not
/// depend on chance. Rows are counted into place, as long as there are not many more ids than
/// triplets.
void sort(std::vector<Triplet>& triplets) {
  const auto by_row = [](const Triplet& a, const Triplet& b) { return a.row < b.row; };
  const auto by_column = [](const Triplet& a, const Triplet& b) { return a.column < b.column; };
  if (triplets.empty())
    return;
  const auto [lowest, highest] = std::minmax_element(triplets.begin(), triplets.end(), by_row);
  const GlobalIndex first = lowest->row, n_rows = highest->row - first + 1;
  if (n_rows > 10 * static_cast<GlobalIndex>(triplets.size())) {
    std::stable_sort(triplets.begin(), triplets.end(), [](const Triplet& a, const Triplet& b) {
      return std::tie(a.row, a.column) < std::tie(b.row, b.column);
    });
    return;
  }
  const std::vector<std::size_t> begins = begins_of_rows(triplets, first, n_rows);
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  std::vector<Triplet> sorted(triplets.size());
  for (const Triplet& t : triplets)
    sorted[next[t.row - first]++] = t;
  for (GlobalIndex row = 0; row < n_rows; ++row) {
    const auto begin = sorted.begin() + begins[row], end = sorted.begin() + begins[row + 1];
    if (!std::is_sorted(begin, end, by_column))
      std::stable_sort(begin, end, by_column);
  }
  triplets = std::move(sorted);
}

void sort_and_merge(std::vector<Triplet>& triplets) {
  sort(triplets);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triplets.size(); ++i) {
    if (kept > 0 && triplets[kept - 1].row == triplets[i].row &&
        triplets[kept - 1].column == triplets[i].column) {
      triplets[kept - 1].value += triplets[i].value;
    } else {
      triplets[kept++] = triplets[i];
    }
  }
  triplets.resize(kept);
}

std::vector<int> owners_of_rows(const std::vector<Triplet>& triplets, const Map& row_map) {
  std::vector<GlobalIndex> rows;
  for (const Triplet& t : triplets) {
    if (rows.empty() || rows.back() != t.row)
      rows.push_back(t.row);
  }
  std::vector<int> ranks(rows.size());
  row_map.getRemoteIndexList(Teuchos::arrayViewFromVector(rows),
                             Teuchos::arrayViewFromVector(ranks));
  std::vector<int> owners(triplets.size());
  std::size_t row = 0;
  for (std::size_t i = 0; i < triplets.size(); ++i) {
    while (rows[row] != triplets[i].row)
      ++row;
    owners[i] = ranks[row];
    LOCKSTEP_ASSERT(owners[i] >= 0);
  }
  return owners;
}

/// Sends every triplet to the owner of its row.
std::vector<Triplet> send_to_owners(const std::vector<Triplet>& triplets, const Map& row_map) {
  const Communicator comm = row_map.getComm();
  const int n_ranks = comm->getSize();
  const std::vector<int> owners = owners_of_rows(triplets, row_map);
  std::vector<int> send_counts(n_ranks, 0), receive_counts(n_ranks), send_starts(n_ranks, 0),
      receive_starts(n_ranks, 0);
  for (int owner : owners)
    ++send_counts[owner];
  const MPI_Comm mpi = raw_communicator(comm);
  MPI_Alltoall(send_counts.data(), 1, MPI_INT, receive_counts.data(), 1, MPI_INT, mpi);
  std::partial_sum(send_counts.begin(), send_counts.end() - 1, send_starts.begin() + 1);
  std::partial_sum(receive_counts.begin(), receive_counts.end() - 1, receive_starts.begin() + 1);

  std::vector<Triplet> outgoing(triplets.size());
  std::vector<int> next = send_starts;
  for (std::size_t i = 0; i < triplets.size(); ++i)
    outgoing[next[owners[i]]++] = triplets[i];
  std::vector<Triplet> incoming(receive_starts.back() + receive_counts.back());
  MPI_Datatype type;
  MPI_Type_contiguous(sizeof(Triplet), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Alltoallv(outgoing.data(), send_counts.data(), send_starts.data(), type, incoming.data(),
                receive_counts.data(), receive_starts.data(), type, mpi);
  MPI_Type_free(&type);
  return incoming;
}

}  // namespace

RCP<CrsMatrix> assemble_triplets(std::vector<Triplet> triplets, const RCP<const Map>& row_map,
                                 const RCP<const Map>& domain_map) {
  sort_and_merge(triplets);
  if (row_map->getComm()->getSize() > 1) {
    triplets = send_to_owners(triplets, *row_map);
    sort_and_merge(triplets);
  }
  // first triplet of each local row
  const int n_rows = static_cast<int>(row_map->getNodeNumElements());
  std::vector<std::size_t> first(n_rows, triplets.size());
  for (std::size_t i = triplets.size(); i-- > 0;)
    first[row_map->getLocalElement(triplets[i].row)] = i;
  RowBuilder rows(row_map, domain_map);
  rows.reserve(triplets.size());
  for (int row = 0; row < n_rows; ++row) {
    for (std::size_t i = first[row];
         i < triplets.size() && triplets[i].row == triplets[first[row]].row; ++i)
      rows.add(triplets[i].column, triplets[i].value);
    rows.end_row();
  }
  return rows.finish();
}

}  // namespace lockstep
