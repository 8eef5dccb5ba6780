#include "linear/triplet_matrix.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/errors.hpp"

namespace lockstep {
namespace {

void sort_and_merge(std::vector<Triplet>& triplets) {
  std::stable_sort(triplets.begin(), triplets.end(), [](const Triplet& a, const Triplet& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });
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
  std::vector<std::size_t> counts(row_map->getNodeNumElements(), 0);
  for (const Triplet& t : triplets)
    ++counts[row_map->getLocalElement(t.row)];
  const auto matrix = rcp(new CrsMatrix(row_map, Teuchos::arrayViewFromVector(counts)));
  std::vector<GlobalIndex> columns;
  std::vector<double> values;
  for (std::size_t begin = 0, end; begin < triplets.size(); begin = end) {
    columns.clear();
    values.clear();
    for (end = begin; end < triplets.size() && triplets[end].row == triplets[begin].row; ++end) {
      columns.push_back(triplets[end].column);
      values.push_back(triplets[end].value);
    }
    matrix->insertGlobalValues(triplets[begin].row, Teuchos::arrayViewFromVector(columns),
                               Teuchos::arrayViewFromVector(values));
  }
  matrix->fillComplete(domain_map, row_map);
  return matrix;
}

}  // namespace lockstep
