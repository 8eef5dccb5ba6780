#pragma once
#include <array>
#include <string>
#include <vector>

#include "parameters/expression.hpp"

namespace lockstep {

/// One row a frame of a run, from the surface of a solid: "time"; "x", "y", "z" of the vertex that
/// is nearest to `point` in the first frame [m] (of "water", whose vertices are others from frame
/// to frame, in each); "volume" [m^3] (2D: [m^2]) of the cone from `point` to the surface, which
/// for a closed surface is what it encloses; "area" [m^2] (2D: [m]); "x_extent" .. "z_extent" [m];
/// "x0" .. "z_extent0" those of the first frame. Throws OutputError if the frames do not hold the
/// solid.
std::vector<Variables> read_surface_rows(const std::string& run_directory, const std::string& solid,
                                         const std::array<double, 3>& point);

}  // namespace lockstep
