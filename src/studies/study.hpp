#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "parameters/expression.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Names with a formula each, in the order of the file; later ones may use earlier ones.
using Formulas = std::vector<std::pair<std::string, std::string>>;

/// One line of a plot: the same assignments for every rung of the ladder.
struct Series {
  std::string name;
  std::string scene_file;
  Formulas constants;
  std::vector<std::string> assignments;  ///< "Path=value" with [formulas]
  std::vector<double> values;            ///< values of this series' own ladder; empty: the study's
};

/// One column of results, and what it is compared with.
struct Quantity {
  enum class From { tables, surface, field, line };
  enum class Over { last, first, max, min, mean, rms, amplitude, frequency };
  enum class Norm { l1, l2, max };
  std::string name;
  From from = From::tables;
  std::string expression;  ///< over the rows of a run, or exact value of the field
  Over over = Over::last;  ///< reduction of the rows of a run to one number
  double from_time = std::numeric_limits<double>::lowest();  ///< rows before do not count [s]
  std::string solid;                                         ///< whose surface
  std::array<double, 3> point{};  ///< point that picks a vertex of the surface, or of the line [m]
  int axis = 0;                   ///< along which the line runs
  std::string field;              ///< dataset of the last frame
  int component = 0;
  Norm norm = Norm::l2;
  std::string reference;        ///< a formula, "self" or empty
  bool relative = true;         ///< error over |reference|
  std::vector<double> targets;  ///< errors whose cost is reported
  std::string unit;             ///< unit of the values, for plots; "1" without dimension
};

/// A quantity over time, drawn for every case.
struct Curve {
  std::string name;
  std::string expression;  ///< over the columns of history and bodies
  std::string exact;       ///< exact value, likewise; may be empty
  std::string unit;        ///< unit of both, for plots
};

/// A study file: which scene is run with which changes, and what is measured.
struct Study {
  std::string title;
  Formulas constants;
  Formulas parameters;  ///< name -> path in the scene, read back from used-parameters.xml
  std::vector<std::string> assignments;
  std::string ladder_name;
  std::vector<double> ladder_values;
  int usual_rungs = 0;  ///< 0: all
  std::string abscissa;
  std::string abscissa_name, abscissa_unit;  ///< for plots; may be empty
  std::vector<Series> series;
  int n_samples = 1;
  std::vector<std::string> sample_assignments;
  std::vector<Quantity> quantities;
  std::vector<Curve> curves;
};

/// True if finer rungs resolve more, so that errors have orders: the abscissa is h, dt or a formula
/// such as 1/n. One that is the ladder's own constant (a density ratio, the ranks) is none.
bool is_resolution(const Study& study);

/// Schema of a study file.
ParameterList study_parameters();

/// Reads and validates a study file. Throws InputError. Not collective, and needs no MPI.
Study read_study(const std::string& file);

/// Drops the series whose names do not match this regular expression (ECMAScript) as a whole.
/// Throws InputError if it is none, or if no series is left.
void keep_series(const std::string& pattern, Study& study);

}  // namespace lockstep
