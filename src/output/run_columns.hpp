#pragma once
#include <string>
#include <vector>

#include "output/history.hpp"

namespace lockstep {

/// Columns of history.csv, bodies.csv and joints.csv; what is written, and what the formulas of a
/// study may name. Those of a liquid with a free surface stand at the end, of its watched places,
/// of trapped gas and of
/// drops.
template <int dim>
std::vector<HistoryColumn> history_columns(bool with_liquid,
                                           const std::vector<std::string>& watches = {},
                                           bool with_gas = false, bool with_drops = false);
template <int dim>
std::vector<HistoryColumn> body_columns();
std::vector<HistoryColumn> joint_columns();

}  // namespace lockstep
