#pragma once
#include <array>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

/// Count of what a rank has sent since its start.
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
    transfer<Value>({{&by_colour_[colour], values, values}}, false);
  }
  /// Sets the ghosts of both colours, in one message to each neighbour.
  template <typename Value>
  void fill(Value* even, Value* odd) const {
    transfer<Value>({{by_colour_.data(), even, even}, {by_colour_.data() + 1, odd, odd}}, false);
  }
  /// Adds the ghosts' values of both colours to their owners' and zeroes them.
  void sum_to_owner(float* even, float* odd) const {
    sum_to_owner(Colours{even, odd}, Colours{even, odd});
  }
  /// Values of both colours.
  using Colours = std::array<float*, 2>;
  /// Sets or sums ghosts that stand in arrays of another grid than the cells they copy.
  void fill(const Colours& owned, const Colours& ghosts) const {
    transfer<float>(of_colours(owned, ghosts), false);
  }
  void sum_to_owner(const Colours& ghosts, const Colours& owned) const {
    transfer<float>(of_colours(owned, ghosts), true);
  }
  /// Sets or sums ghosts in natural arrays, several in one message.
  template <typename Value>
  void fill_natural(const std::vector<Value*>& arrays) const {
    transfer(of_natural(arrays, arrays), false);
  }
  void sum_natural_to_owner(const std::vector<float*>& arrays) const {
    sum_natural_to_owner(arrays, arrays);
  }
  void sum_natural_to_owner(const std::vector<float*>& ghosts,
                            const std::vector<float*>& owned) const {
    transfer(of_natural(owned, ghosts), true);
  }
  /// Calls f(slot) for the ghosts of a colour.
  template <typename Function>
  void for_each_ghost(int colour, const Function& f) const {
    for (const Part& part : by_colour_[colour])
      for (const std::ptrdiff_t slot : part.ghosts)
        f(slot);
  }

  const MessageCount& sent() const { return sent_; }

 private:
  struct Part {
    int rank = 0;
    std::vector<std::ptrdiff_t> owned, ghosts;

    const std::vector<std::ptrdiff_t>& source(bool to_owner) const {
      return to_owner ? ghosts : owned;
    }
    const std::vector<std::ptrdiff_t>& target(bool to_owner) const { return source(!to_owner); }
  };
  using Parts = std::vector<Part>;

  /// Values and which of them go to and come from each peer.
  template <typename Value>
  struct Field {
    const Parts* parts;
    Value *owned, *ghosts;  ///< one array, or arrays of two grids

    Value* source(bool to_owner) const { return to_owner ? ghosts : owned; }
    Value* target(bool to_owner) const { return source(!to_owner); }
  };
  template <typename Value>
  using Fields = std::vector<Field<Value>>;

  template <typename Value>
  Fields<Value> of_natural(const std::vector<Value*>& owned,
                           const std::vector<Value*>& ghosts) const {
    Fields<Value> fields;
    for (std::size_t i = 0; i < owned.size(); ++i)
      fields.push_back({&natural_, owned[i], ghosts[i]});
    return fields;
  }
  Fields<float> of_colours(const Colours& owned, const Colours& ghosts) const {
    return {{by_colour_.data(), owned[0], ghosts[0]}, {by_colour_.data() + 1, owned[1], ghosts[1]}};
  }
  /// Moves the values of one list of each part to the other list's place on the peer: owned to
  /// ghosts, or back (then they are added). All fields go in one message to each peer.
  template <typename Value>
  void transfer(const Fields<Value>& fields, bool to_owner) const;
  template <typename Value>
  void receive(const Fields<Value>& fields, bool to_owner) const;
  template <typename Value>
  void send(const Fields<Value>& fields, bool to_owner) const;
  template <typename Value>
  void take_in(const Fields<Value>& fields, bool to_owner) const;

  Communicator comm_;
  bool empty_ = true;
  std::array<Parts, 2> by_colour_;
  Parts natural_;
  mutable std::vector<char> outgoing_, incoming_;
  mutable std::vector<MPI_Request> requests_;
  mutable MessageCount sent_;
};

}  // namespace lockstep
