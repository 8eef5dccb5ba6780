#pragma once
#include <array>
#include <string>
#include <vector>

namespace lockstep {

/// A line after a step, for lines.csv.
struct LineState {
  std::string name;
  double span = 0;                  ///< distance of its ends [m]
  std::array<double, 2> tension{};  ///< at its ends [N]; negative: it pushes
};

/// A side of solid models of lines: without it a run tells no tensions.
class LineTensions {
 public:
  virtual ~LineTensions() = default;
  /// One for each line, at the present places. Local, the same on all ranks.
  virtual std::vector<LineState> line_states() const = 0;
};

}  // namespace lockstep
