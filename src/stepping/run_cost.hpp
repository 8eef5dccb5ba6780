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
/// Largest speed at which sides let fluid in or out between two times [m/s], of 33 times evenly
/// spaced; 0 without such sides. Collective.
template <int dim>
double speed_of_sides(const FluidDiscretization<dim>& fluid, double begin, double end);
/// The row on the run's duration: if all steps are like the first, which took so many seconds, and
/// if they are like `shortest`, whose reason names what is that fast.
std::string duration_row(const TimeOptions& time, const StepBound& first, const StepBound& shortest,
                         double seconds);

}  // namespace lockstep
