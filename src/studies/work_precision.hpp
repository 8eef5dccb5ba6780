#pragma once
#include <string>
#include <vector>

#include "studies/study_table.hpp"

namespace lockstep {

/// Cost of a series at a given error.
struct TargetCost {
  enum class Found {
    between_rungs,  ///< interpolated
    at_coarsest,    ///< the coarsest rung is better already: costs are upper bounds
    not_reached
  };
  std::string series;
  double target = 0;
  Found found = Found::not_reached;
  double core_seconds = 0, cells = 0, peak_memory_mb = 0;
};

/// The cost of an error, from the rows of one series and quantity along its ladder. A rung reaches
/// the target if it and all finer ones have errors of at most that size; between it and the one
/// before, log(cost) is linear in log(error).
TargetCost cost_of_target(const std::vector<StudyRow>& rung_rows, double target);

/// The series by the seconds in which they reach a target, cheapest first; those that do not reach
/// it last. `rows`: of one quantity.
std::vector<TargetCost> ranking(const std::vector<StudyRow>& rows, double target);

/// One table for every quantity with targets; empty without any.
std::string targets_markdown(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace lockstep
