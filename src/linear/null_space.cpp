#include "linear/null_space.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

double project_out(const std::vector<RCP<const Vector>>& basis, Vector& x) {
  double removed = 0;
  for (const auto& direction : basis) {
    const double component = direction->dot(x);
    x.update(-component, *direction, 1);
    removed += component * component;
  }
  return std::sqrt(removed);
}

double relative_part_removed(const std::vector<RCP<const Vector>>& basis, Vector& x) {
  if (basis.empty())
    return 0;
  const double before = x.norm2();
  const double removed = project_out(basis, x);
  // Where nearly all is removed, what is left still holds round-off of the first projection.
  project_out(basis, x);
  return before > 0 ? removed / before : 0;
}

}  // namespace lockstep
