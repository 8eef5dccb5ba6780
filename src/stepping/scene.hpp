#pragma once
#include <optional>
#include <string>

#include "interfaces/registries.hpp"
#include "parameters/source.hpp"
#include "stepping/step/time_scheme.hpp"
#include "stepping/step_size.hpp"

namespace lockstep {

/// Schema of a whole scene file, put together from the registered plug-ins. The list "Domain" is
/// that of the fluid of this name, or else of the first registered.
template <int dim>
ParameterList scene_parameters(const Registries<dim>& registries, const std::string& fluid = "");

struct OutputOptions {
  bool frames = true;
  std::optional<double> frame_interval;  ///< [s]; 0: every step; none: a hundredth of the run
  /// [s of simulated time]; 0: only when stopped and at the end; none: by the clock.
  std::optional<double> checkpoint_interval;
  int keep_checkpoints = 2;
  std::string precision = "single";
};

/// The parts of a scene that was read and validated.
struct SceneOptions {
  TimeOptions time;
  OutputOptions output;
  StepOptions step;
};

/// The "Type" of a scene's fluid, as the document, not validated yet, or a `--set` has it; empty if
/// neither says.
std::string scene_fluid(const Document& document, const std::vector<std::string>& settings);

/// Throws InputError if times near the start cannot be told apart a step away.
void check_time_resolution(const TimeOptions& time);

SceneOptions scene_options(const ParameterList& scene);

}  // namespace lockstep
