#pragma once
#include <array>
#include <string>
#include <vector>

namespace lockstep {

/// A cell-centred field of the last frame of a run.
struct FrameField {
  double time = 0;                       ///< [s]
  std::array<double, 3> origin{};        ///< lower corner [m]
  std::array<double, 3> spacing{};       ///< [m]
  std::array<std::size_t, 3> n_cells{};  ///< along x, y, z
  std::size_t n_components = 1;          ///< as stored: vectors have three
  std::vector<double> values;            ///< [z][y][x][component]
};

/// Reads RUN/frames/ without MPI. Throws OutputError if the run wrote no such field.
FrameField read_last_frame(const std::string& run_directory, const std::string& field);

}  // namespace lockstep
