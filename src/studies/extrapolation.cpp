#include "studies/extrapolation.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {
namespace {

constexpr double largest_difference_of_orders = 0.25;

/// From three rungs, coarsest first.
std::optional<Extrapolation> from_three(const StudyRow* rungs) {
  const double ratio = rungs[0].abscissa / rungs[1].abscissa;
  const double next_ratio = rungs[1].abscissa / rungs[2].abscissa;
  if (!(ratio > 1) || !(std::abs(next_ratio / ratio - 1) < 0.01))
    return std::nullopt;
  const double before = rungs[1].value - rungs[0].value, last = rungs[2].value - rungs[1].value;
  const double shrinks = before / last;
  if (last == 0 || !(shrinks > 1))
    return std::nullopt;
  return Extrapolation{std::log(shrinks) / std::log(ratio), rungs[2].value + last / (shrinks - 1)};
}

bool agree(double order, double other) {
  return std::abs(order - other) <= largest_difference_of_orders;
}

void add_line(std::string& page, const std::string& quantity, const std::vector<StudyRow>& rungs) {
  const auto found = extrapolate(rungs);
  const StudyRow& finest = rungs.back();
  if (!found) {
    page += fmt::format("| {} | {} | {:.7g} | not clean | | |\n", quantity, finest.series,
                        finest.value);
    return;
  }
  std::string error;
  if (finest.reference && *finest.reference != 0)
    error = fmt::format("{:.2g}", std::abs(found->limit / *finest.reference - 1));
  page += fmt::format("| {} | {} | {:.7g} | {:.2f} | {:.7g} | {} |\n", quantity, finest.series,
                      finest.value, found->order, found->limit, error);
}

}  // namespace

std::optional<Extrapolation> extrapolate(const std::vector<StudyRow>& rung_rows) {
  const std::size_t n = rung_rows.size();
  if (n < 3)
    return std::nullopt;
  const auto last = from_three(&rung_rows[n - 3]);
  if (!last)
    return std::nullopt;
  if (n == 3)
    return agree(last->order, 1) || agree(last->order, 2) ? last : std::nullopt;
  const auto before = from_three(&rung_rows[n - 4]);
  return before && agree(last->order, before->order) ? last : std::nullopt;
}

std::string extrapolations_markdown(const Study& study, const std::vector<StudyRow>& rows) {
  std::string lines;
  for (const Quantity& quantity : study.quantities) {
    if (!quantity.extrapolate)
      continue;
    std::vector<StudyRow> rungs;
    for (auto row = rows.begin(); row != rows.end(); ++row) {
      if (row->quantity != quantity.name)
        continue;
      rungs.push_back(*row);
      if (std::next(row) == rows.end() || std::next(row)->series != row->series ||
          std::next(row)->quantity != row->quantity) {
        if (rungs.size() >= 3)
          add_line(lines, quantity.name, rungs);
        rungs.clear();
      }
    }
  }
  if (lines.empty())
    return "";
  return "**Richardson's extrapolation from the last three rungs**\n\n"
         "| quantity | series | finest | order | extrapolated | its error |\n"
         "|---|---|---|---|---|---|\n" +
         lines + "\n";
}

}  // namespace lockstep
