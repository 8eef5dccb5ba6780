#include "coupling/stacked_matrix.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/matrix_sum.hpp"

namespace lockstep {

bool all_assembled(const std::vector<StackedPart>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](const StackedPart& part) {
    return !assembled(part.mass).is_null() &&
           (part.implicit_force.is_null() || !assembled(part.implicit_force).is_null());
  });
}

RCP<CrsMatrix> stacked_matrix(const std::vector<StackedPart>& parts, double dt,
                              const RCP<const CrsMatrix>& added, const RCP<const Map>& map,
                              const std::vector<int>& unit_rows) {
  std::vector<Summand> summands;
  for (const StackedPart& part : parts) {
    summands.push_back({assembled(part.mass), part.id_begin, 1});
    if (!part.implicit_force.is_null())
      summands.push_back({assembled(part.implicit_force), part.id_begin, -dt});
  }
  if (!added.is_null())
    summands.push_back({added, 0, 1});
  return sum_of(summands, map, unit_rows);
}

}  // namespace lockstep
