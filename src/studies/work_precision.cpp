#include "studies/work_precision.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {
namespace {

void set_cost(TargetCost& cost, const StudyRow& row) {
  cost.core_seconds = row.core_seconds;
  cost.cells = row.cells;
  cost.peak_memory_mb = row.peak_memory_mb;
}

double between(double coarse, double fine, double share) {
  return coarse > 0 && fine > 0 ? coarse * std::pow(fine / coarse, share)
                                : coarse + share * (fine - coarse);
}

/// "at most 3", "3" or nothing.
std::string amount(const TargetCost& cost, double number, int digits) {
  if (cost.found == TargetCost::Found::not_reached)
    return "";
  return fmt::format("{}{:.{}g}", cost.found == TargetCost::Found::at_coarsest ? "at most " : "",
                     number, digits);
}

}  // namespace

TargetCost cost_of_target(const std::vector<StudyRow>& rung_rows, double target) {
  TargetCost cost;
  cost.target = target;
  if (!rung_rows.empty())
    cost.series = rung_rows.front().series;
  // The finest rung has no error where it is what the others are compared with.
  const auto finest = std::find_if(rung_rows.rbegin(), rung_rows.rend(),
                                   [](const StudyRow& row) { return row.error.has_value(); });
  // An error that is not a number reaches nothing.
  const auto misses = [target](const StudyRow& row) {
    return !row.error || !(*row.error <= target);
  };
  const auto last_miss = std::find_if(finest, rung_rows.rend(), misses);
  if (last_miss == finest)
    return cost;
  const auto first_hit = last_miss.base();
  set_cost(cost, *first_hit);
  if (last_miss == rung_rows.rend() || !last_miss->error) {
    cost.found = TargetCost::Found::at_coarsest;
    return cost;
  }
  cost.found = TargetCost::Found::between_rungs;
  const StudyRow &coarse = *last_miss, &fine = *first_hit;
  if (*fine.error > 0) {
    const double share = std::log(*coarse.error / target) / std::log(*coarse.error / *fine.error);
    cost.core_seconds = between(coarse.core_seconds, fine.core_seconds, share);
    cost.cells = between(coarse.cells, fine.cells, share);
    cost.peak_memory_mb = between(coarse.peak_memory_mb, fine.peak_memory_mb, share);
  }
  return cost;
}

std::vector<TargetCost> ranking(const std::vector<StudyRow>& rows, double target) {
  std::vector<TargetCost> costs;
  if (!rows.empty()) {
    for (const auto& rungs : rows_by_series(rows, rows.front().quantity))
      costs.push_back(cost_of_target(rungs, target));
  }
  const auto misses = [](const TargetCost& cost) {
    return cost.found == TargetCost::Found::not_reached;
  };
  std::stable_sort(costs.begin(), costs.end(), [&](const TargetCost& a, const TargetCost& b) {
    return misses(a) != misses(b) ? misses(b) : a.core_seconds < b.core_seconds;
  });
  return costs;
}

std::string targets_markdown(const Study& study, const std::vector<StudyRow>& rows) {
  std::string page;
  for (const Quantity& quantity : study.quantities) {
    if (quantity.targets.empty())
      continue;
    std::vector<StudyRow> of_quantity;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_quantity),
                 [&](const StudyRow& row) { return row.quantity == quantity.name; });
    page += fmt::format(
        "**{}: what an error costs, cheapest series first**\n\n"
        "| error | place | series | core seconds | cells | memory [MB] "
        "|\n|---|---|---|---|---|---|\n",
        quantity.name);
    for (const double target : quantity.targets) {
      int place = 0;
      for (const TargetCost& cost : ranking(of_quantity, target)) {
        const bool reached = cost.found != TargetCost::Found::not_reached;
        page += fmt::format("| {:.3g} | {} | {} | {} | {} | {} |\n", target,
                            reached ? std::to_string(++place) : "not reached", cost.series,
                            amount(cost, cost.core_seconds, 2), amount(cost, cost.cells, 3),
                            amount(cost, cost.peak_memory_mb, 3));
      }
    }
    page +=
        "\nInterpolated between rungs, cost against error in logarithms; \"at most\": the coarsest "
        "rung is better already.\n\n";
  }
  return page;
}

}  // namespace lockstep
