#pragma once
#include <string>
#include <vector>

#include "output/history.hpp"

namespace lockstep {

/// Columns of history.csv and bodies.csv; what is written, and what the formulas of a study may
/// name. Those of a liquid with a free surface stand at the end, and of its watched places.
template <int dim>
std::vector<HistoryColumn> history_columns(bool with_liquid,
                                           const std::vector<std::string>& watches = {});
template <int dim>
std::vector<HistoryColumn> body_columns();

}  // namespace lockstep
