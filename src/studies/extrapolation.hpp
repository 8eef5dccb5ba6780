#pragma once
#include <optional>
#include <string>
#include <vector>

#include "studies/study_table.hpp"

namespace lockstep {

/// Limit of the values of a series as its abscissa vanishes.
struct Extrapolation {
  double order = 0;
  double limit = 0;
};

/// Richardson's extrapolation from the last three rungs, v + c h^p, where the order is clean:
/// the abscissas fall by one ratio (within 1 %), the differences of the values shrink with one
/// sign, and the orders agree within 0.25: with four rungs or more, that of the last three and that
/// of the three before; with three, that one and 1 or 2. Nothing otherwise. `rung_rows`: of one
/// series and quantity.
std::optional<Extrapolation> extrapolate(const std::vector<StudyRow>& rung_rows);

/// A table of the quantities that ask for it; empty without any.
std::string extrapolations_markdown(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace lockstep
