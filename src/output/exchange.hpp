#pragma once
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

/// First of the numbers 0 .. n-1 that belong to `rank` when they are cut into equal contiguous
/// ranges.
inline GlobalIndex first_of_rank(GlobalIndex n, int rank, int n_ranks) {
  return n * rank / n_ranks;
}

/// The rank whose range holds number i.
inline int rank_of(GlobalIndex i, GlobalIndex n, int n_ranks) {
  int rank = static_cast<int>(i * n_ranks / n);
  while (first_of_rank(n, rank + 1, n_ranks) <= i) {
    ++rank;
  }
  return rank;
}

/// Collective: sends outgoing[r] to rank r and returns what arrived, in the order of the senders;
/// the number of values from each sender goes to `counts` if given. MPI counts by int: what is
/// longer than `longest_message` goes in pieces. T: double, long long.
template <typename T>
std::vector<T> send_to_ranks(const Communicator& comm, const std::vector<std::vector<T>>& outgoing,
                             std::vector<GlobalIndex>* counts = nullptr,
                             GlobalIndex longest_message = GlobalIndex{1} << 30);

}  // namespace lockstep
