#include "output/exchange.hpp"

#include <numeric>
#include <type_traits>

namespace lockstep {

namespace {
std::vector<int> starts_of(const std::vector<int>& counts) {
  std::vector<int> starts(counts.size(), 0);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  return starts;
}
}  // namespace

template <typename T>
std::vector<T> send_to_ranks(const Communicator& comm, const std::vector<std::vector<T>>& outgoing,
                             std::vector<int>* counts) {
  const MPI_Datatype type = std::is_same_v<T, double> ? MPI_DOUBLE : MPI_LONG_LONG;
  const MPI_Comm mpi = raw_communicator(comm);
  std::vector<T> sent;
  std::vector<int> n_sent, n_received(outgoing.size());
  for (const std::vector<T>& values : outgoing) {
    n_sent.push_back(static_cast<int>(values.size()));
    sent.insert(sent.end(), values.begin(), values.end());
  }
  MPI_Alltoall(n_sent.data(), 1, MPI_INT, n_received.data(), 1, MPI_INT, mpi);
  const std::vector<int> from = starts_of(n_sent);
  const std::vector<int> to = starts_of(n_received);
  std::vector<T> received(static_cast<std::size_t>(to.back()) + n_received.back());
  MPI_Alltoallv(sent.data(), n_sent.data(), from.data(), type, received.data(), n_received.data(),
                to.data(), type, mpi);
  if (counts != nullptr)
    *counts = n_received;
  return received;
}

template std::vector<double> send_to_ranks(const Communicator&,
                                           const std::vector<std::vector<double>>&,
                                           std::vector<int>*);
template std::vector<long long> send_to_ranks(const Communicator&,
                                              const std::vector<std::vector<long long>>&,
                                              std::vector<int>*);

}  // namespace lockstep
