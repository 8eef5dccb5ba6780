#include "output/exchange.hpp"

#include <algorithm>
#include <type_traits>

namespace lockstep {

namespace {

template <typename T>
MPI_Datatype type_of() {
  return std::is_same_v<T, double> ? MPI_DOUBLE : MPI_LONG_LONG;
}

/// Calls f(first, number) for the pieces of n elements.
template <typename Function>
void for_each_piece(GlobalIndex n, GlobalIndex longest, const Function& f) {
  for (GlobalIndex first = 0; first < n; first += longest)
    f(first, static_cast<int>(std::min(longest, n - first)));
}

}  // namespace

template <typename T>
std::vector<T> send_to_ranks(const Communicator& comm, const std::vector<std::vector<T>>& outgoing,
                             std::vector<GlobalIndex>* counts, GlobalIndex longest_message) {
  const MPI_Comm mpi = raw_communicator(comm);
  constexpr int tag = 0;
  std::vector<GlobalIndex> n_sent, n_received(outgoing.size());
  for (const std::vector<T>& values : outgoing)
    n_sent.push_back(static_cast<GlobalIndex>(values.size()));
  MPI_Alltoall(n_sent.data(), 1, MPI_LONG_LONG, n_received.data(), 1, MPI_LONG_LONG, mpi);
  GlobalIndex n_all = 0;
  for (const GlobalIndex n : n_received)
    n_all += n;
  std::vector<T> received(static_cast<std::size_t>(n_all));
  std::vector<MPI_Request> requests;
  T* next = received.data();
  for (std::size_t rank = 0; rank < n_received.size(); ++rank) {
    for_each_piece(n_received[rank], longest_message, [&](GlobalIndex first, int n) {
      MPI_Irecv(next + first, n, type_of<T>(), static_cast<int>(rank), tag, mpi,
                &requests.emplace_back());
    });
    next += n_received[rank];
  }
  for (std::size_t rank = 0; rank < outgoing.size(); ++rank) {
    for_each_piece(n_sent[rank], longest_message, [&](GlobalIndex first, int n) {
      MPI_Isend(outgoing[rank].data() + first, n, type_of<T>(), static_cast<int>(rank), tag, mpi,
                &requests.emplace_back());
    });
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  if (counts != nullptr)
    *counts = n_received;
  return received;
}

template std::vector<double> send_to_ranks(const Communicator&,
                                           const std::vector<std::vector<double>>&,
                                           std::vector<GlobalIndex>*, GlobalIndex);
template std::vector<long long> send_to_ranks(const Communicator&,
                                              const std::vector<std::vector<long long>>&,
                                              std::vector<GlobalIndex>*, GlobalIndex);

}  // namespace lockstep
