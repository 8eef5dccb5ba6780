#include "studies/orders.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {
namespace {

constexpr double round_off = 1e-10;
constexpr double safety_factor = 1.25;  ///< Roache's for three grids or more
/// The schemes have this order; a higher one, observed by chance, would make the index too small.
constexpr double formal_order = 2;
constexpr double largest_order = 20;
constexpr double largest_difference_of_orders = 0.25;

/// Convergence of the last three values of a series.
struct Convergence {
  double order = 0;
  double last = 0;   ///< difference of the last two values
  double ratio = 0;  ///< coarser over finer abscissa of the last two
};

/// (v_2 - v_1)/(v_3 - v_2) of values v + c h^order on grids with h_1/h_2 = `coarse_ratio` and
/// h_2/h_3 = `fine_ratio`; rises with the order.
double ratio_of_differences(double order, double coarse_ratio, double fine_ratio) {
  return std::pow(fine_ratio, order) * std::expm1(order * std::log(coarse_ratio)) /
         std::expm1(order * std::log(fine_ratio));
}

/// The positive order that belongs to a ratio of differences, by bisection; nothing without one.
std::optional<double> observed_order(double differences, double coarse_ratio, double fine_ratio) {
  double low = 0, high = largest_order;
  // At order 0 the ratio of differences is that of the logarithms.
  if (!(differences > std::log(coarse_ratio) / std::log(fine_ratio)) ||
      differences > ratio_of_differences(high, coarse_ratio, fine_ratio))
    return std::nullopt;
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    (ratio_of_differences(middle, coarse_ratio, fine_ratio) < differences ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// From three rungs, coarsest first.
std::optional<Convergence> convergence_of(const StudyRow* rungs) {
  const double coarse_ratio = rungs[0].abscissa / rungs[1].abscissa;
  const double fine_ratio = rungs[1].abscissa / rungs[2].abscissa;
  const double last = rungs[2].value - rungs[1].value;
  if (!(coarse_ratio > 1) || !(fine_ratio > 1) || last == 0)
    return std::nullopt;
  const auto order =
      observed_order((rungs[1].value - rungs[0].value) / last, coarse_ratio, fine_ratio);
  return order ? std::optional(Convergence{*order, last, fine_ratio}) : std::nullopt;
}

bool agree(double order, double other) {
  return std::abs(order - other) <= largest_difference_of_orders;
}

/// True if there is something but 0 to be relative to.
bool has_size(const std::vector<StudyRow>& rungs) {
  return std::any_of(rungs.begin(), rungs.end(),
                     [](const StudyRow& row) { return !row.reference || *row.reference != 0; });
}

std::string limit_text(const std::vector<StudyRow>& rungs) {
  const auto limit = extrapolate(rungs);
  if (!limit)
    return " | ";
  const auto& reference = rungs.back().reference;
  return fmt::format(
      "{:.7g} | {}", *limit,
      reference && *reference != 0 ? fmt::format("{:.2g}", std::abs(*limit / *reference - 1)) : "");
}

std::string line_of(const std::vector<StudyRow>& rungs) {
  const auto fitted = fitted_order(rungs);
  const auto converged = has_size(rungs) ? grid_convergence(rungs) : std::nullopt;
  if (!fitted && !converged)
    return "";
  const std::string fit = fitted ? fmt::format("{} | {:.2f} | {:.2f}", fitted->n_rungs,
                                               fitted->order, fitted->standard_error)
                                 : " |  | ";
  const std::string index = converged ? fmt::format("{:.2f} | {:.2g} | {}", converged->order,
                                                    100 * converged->index, limit_text(rungs))
                                      : " |  |  | ";
  return fmt::format("| {} | {} | {} | {} |\n", rungs.back().quantity, rungs.back().series, fit,
                     index);
}

}  // namespace

std::optional<FittedOrder> fitted_order(const std::vector<StudyRow>& rung_rows) {
  std::vector<std::pair<double, double>> points;
  double largest = 0;
  for (const StudyRow& row : rung_rows) {
    if (row.abscissa > 0 && row.error && *row.error > 0 && std::isfinite(*row.error)) {
      points.emplace_back(std::log(row.abscissa), std::log(*row.error));
      largest = std::max(largest, *row.error);
    }
  }
  const auto n = static_cast<double>(points.size());
  if (n < 3 || largest < round_off)
    return std::nullopt;
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / n;
    mean_y += y / n;
  }
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
    yy += (y - mean_y) * (y - mean_y);
  }
  if (xx == 0)
    return std::nullopt;
  const double residual = std::max(0.0, yy - xy * xy / xx);
  return FittedOrder{static_cast<int>(points.size()), xy / xx, std::sqrt(residual / (n - 2) / xx)};
}

std::optional<GridConvergence> grid_convergence(const std::vector<StudyRow>& rung_rows) {
  if (rung_rows.size() < 3)
    return std::nullopt;
  const auto found = convergence_of(&*(rung_rows.end() - 3));
  const double finest = rung_rows.back().value;
  if (!found || finest == 0)
    return std::nullopt;
  const double shrinks = std::pow(found->ratio, std::min(found->order, formal_order));
  return GridConvergence{found->order,
                         safety_factor * std::abs(found->last / finest) / (shrinks - 1)};
}

std::optional<double> extrapolate(const std::vector<StudyRow>& rung_rows) {
  const std::size_t n = rung_rows.size();
  const auto found = n < 3 ? std::nullopt : convergence_of(&rung_rows[n - 3]);
  if (!found)
    return std::nullopt;
  const auto before = n == 3 ? std::nullopt : convergence_of(&rung_rows[n - 4]);
  const bool is_clean = n == 3 ? agree(found->order, 1) || agree(found->order, 2)
                               : before && agree(found->order, before->order);
  if (!is_clean)
    return std::nullopt;
  return rung_rows.back().value + found->last / (std::pow(found->ratio, found->order) - 1);
}

std::string note_on_abscissa(const Study& study, const std::vector<StudyRow>& rows) {
  if (!is_resolution(study))
    return "";
  for (const Quantity& quantity : study.quantities) {
    for (const auto& rungs : rows_by_series(rows, quantity.name)) {
      const auto is_as_first = [&](const StudyRow& row) {
        return std::abs(row.abscissa - rungs.front().abscissa) <=
               round_off * std::abs(row.abscissa);
      };
      if (rungs.size() > 1 && rungs.front().error &&
          std::all_of(rungs.begin(), rungs.end(), is_as_first))
        return fmt::format(
            "The abscissa \"{}\" is {:.4g} at all rungs of \"{}\", so there are no orders: give "
            "\"Ladder\" an \"Abscissa\" that changes along it, such as dt, h or a formula of "
            "\"{}\".",
            study.abscissa, rungs.front().abscissa, rungs.front().series, study.ladder_name);
    }
  }
  return "";
}

std::string orders_markdown(const Study& study, const std::vector<StudyRow>& rows) {
  std::string lines;
  for (const Quantity& quantity : study.quantities) {
    for (const auto& rungs : rows_by_series(rows, quantity.name))
      lines += line_of(rungs);
  }
  if (lines.empty() || !is_resolution(study))
    return "";
  return "**Orders over all rungs, grid convergence index, limit**\n\n"
         "| quantity | series | errors | order | standard error | order of the last three values | "
         "GCI [%] | limit | its error |\n"
         "|---|---|---|---|---|---|---|---|---|\n" +
         lines +
         "\nOrder: slope of log(error) against log(abscissa) by least squares. Against `self` it "
         "comes out too high. GCI: Roache's, of the finest pair, with safety factor 1.25; an order "
         "above 2 counts as 2. It needs no reference, and is empty where the last three values do "
         "not converge from one side. Limit: Richardson's extrapolation of these, where orders "
         "agree within 0.25.\n\n";
}

}  // namespace lockstep
