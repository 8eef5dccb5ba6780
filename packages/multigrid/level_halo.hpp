#pragma once
#include <array>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

/// What a rank has sent, since it began.
struct MessageCount {
  long long messages = 0, bytes = 0;
};

/// Copies values of cells into their ghost copies: on other ranks, and on this one through periodic
/// sides. All calls are collective among neighbours.
class LevelHalo {
 public:
  struct Cell {
    std::ptrdiff_t natural = 0, slot = 0;
    int colour = 0;
  };
  /// Cells exchanged with one rank (maybe this one), in the order both sides agree on.
  struct Peer {
    int rank = 0;
    std::vector<Cell> owned, ghosts;
  };

  LevelHalo() = default;
  LevelHalo(const Communicator& comm, const std::vector<Peer>& peers);

  /// True on all ranks if nothing is ever exchanged.
  bool empty() const { return empty_; }

  /// Sets the ghosts of one colour, of values in slots.
  template <typename Value>
  void fill(int colour, Value* values) const {
    exchange(by_colour_[colour], values);
  }
  /// Adds the ghosts' values to their owners' and zeroes them.
  void sum_to_owner(int colour, float* values) const { exchange_back(by_colour_[colour], values); }
  /// The same two for natural arrays.
  template <typename Value>
  void fill_natural(Value* values) const {
    exchange(natural_, values);
  }
  void sum_natural_to_owner(float* values) const { exchange_back(natural_, values); }

  const MessageCount& sent() const { return sent_; }

 private:
  struct Part {
    int rank = 0;
    std::vector<std::ptrdiff_t> owned, ghosts;
  };
  using Parts = std::vector<Part>;

  template <typename Value>
  void exchange(const Parts& parts, Value* values) const;
  void exchange_back(const Parts& parts, float* values) const;
  template <typename Value>
  void transfer(const Parts& parts, bool to_owner, Value* values) const;

  Communicator comm_;
  bool empty_ = true;
  std::array<Parts, 2> by_colour_;
  Parts natural_;
  mutable std::vector<char> outgoing_, incoming_;
  mutable std::vector<MPI_Request> requests_;
  mutable MessageCount sent_;
};

}  // namespace lockstep
