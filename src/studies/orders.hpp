#pragma once
#include <optional>
#include <string>
#include <vector>

#include "studies/study_table.hpp"

namespace lockstep {

/// One order of convergence of a whole series.
struct FittedOrder {
  int n_rungs = 0;  ///< rungs with an error, all of which count
  double order = 0;
  double standard_error = 0;
};

/// The slope of log(error) against log(abscissa) by least squares, with the standard error of the
/// residuals. Nothing with fewer than three errors above 0, or if all of them are round-off, below
/// 1e-10. `rung_rows`: of one series and quantity, here and below.
std::optional<FittedOrder> fitted_order(const std::vector<StudyRow>& rung_rows);

/// Roache's grid convergence index of the finest pair of grids.
struct GridConvergence {
  double order = 0;  ///< observed in the last three values, at any ratio of the grids
  double index = 0;  ///< relative to the finest value; safety factor 1.25, order 2 at most
};

/// The index, from the values of the last three rungs alone. Nothing unless their differences have
/// one sign and shrink as those of a positive order do, or if the finest value is 0.
std::optional<GridConvergence> grid_convergence(const std::vector<StudyRow>& rung_rows);

/// Richardson's extrapolation of the last three values, v + c h^p, where the order is clean: with
/// four rungs or more, that of the last three and that of the three before agree within 0.25; with
/// three, that one and 1 or 2. Nothing otherwise.
std::optional<double> extrapolate(const std::vector<StudyRow>& rung_rows);

/// A sentence if errors stand along a ladder of resolution whose abscissa is the same at all rungs
/// of a series, so that it has no orders; else empty.
std::string note_on_abscissa(const Study& study, const std::vector<StudyRow>& rows);

/// A table of all these, one line a series; empty without any, as along ladders of no resolution.
/// Quantities that ought to be 0 have orders alone, since the rest is relative.
std::string orders_markdown(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace lockstep
