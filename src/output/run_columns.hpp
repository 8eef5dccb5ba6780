#pragma once
#include <vector>

#include "output/history.hpp"

namespace lockstep {

/// Columns of history.csv and bodies.csv; what is written, and what the formulas of a study may
/// name.
template <int dim>
std::vector<HistoryColumn> history_columns();
template <int dim>
std::vector<HistoryColumn> body_columns();

}  // namespace lockstep
