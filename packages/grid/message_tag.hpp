#pragma once

namespace lockstep {

/// Tags that set the messages of the grid apart from one another, and from those of libraries.
struct MessageTag {
  static constexpr int halo = 7301, migration = 7302, neighbors = 7303;
};

}  // namespace lockstep
