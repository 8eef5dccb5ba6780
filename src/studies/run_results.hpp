#pragma once
#include <map>
#include <string>
#include <vector>

#include "parameters/expression.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The numbers a finished run left behind.
struct RunResults {
  std::string directory;
  /// Rows of the run, one a step: history.csv; as BODY.column, bodies.csv; as OBSERVER.column or,
  /// where a look has several rows, OBSERVER.row.column, the last looks of observers.
  std::vector<Variables> rows;
  Variables summary;     ///< "summary.name", "summary.iterations.s1.median", ...
  ParameterList scene;   ///< used-parameters.xml
  double spacing = 0;    ///< h, the smallest length that the fluid resolves [m]
  double n_cells = 0;    ///< cells of the boxes in frames
  double mean_step = 0;  ///< [s]
  double wall_seconds = 0,
         cpu_seconds = 0;  ///< seconds of the run; CPU seconds of all ranks together
};

/// Reads the folder of a run. Throws OutputError for files that are missing or torn.
RunResults read_run(const std::string& directory);

/// Value of a number in the scene: "Fluid/Density", "Fluid/Gravity[1]". Throws InputError if there
/// is none.
double scene_number(const ParameterList& scene, const std::string& path);

}  // namespace lockstep
