#pragma once
#include <string>
#include <vector>

#include "interfaces/fluid.hpp"
#include "output/frames.hpp"
#include "stepping/scene.hpp"

/// Costs of a run, for --explain: bytes of its frames, minutes of its steps.
namespace lockstep {

/// Size of a frame in the file, uncompressed [MB]. Precision as in the scene. Local.
double stored_megabytes(const std::vector<BoxFrame>& boxes, const std::vector<SurfaceFrame>& meshes,
                        const std::string& precision);
/// The row on frames: when they come, how many, how large.
std::string frames_row(const SceneOptions& options, double megabytes);

/// Speed of what falls freely through the domain, from rest [m/s]; 0 without gravity. Local.
template <int dim>
double speed_of_fall(const FluidDiscretization<dim>& fluid);
/// The row on the run's duration: if all steps are like the first, which took so many seconds, and
/// if they are as short as `shortest` [s].
std::string duration_row(const TimeOptions& time, const StepBound& first, double shortest,
                         double seconds);

}  // namespace lockstep
