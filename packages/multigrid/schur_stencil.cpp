#include "multigrid/schur_stencil.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

#include "multigrid/through_sheets.hpp"

namespace lockstep {

namespace {

/// B C^-1 B^T 1, C^-1 on the nodes of soft solids; null if no force on them is left of an even
/// pressure. A rigid body, which yields as a whole, is best left to the Krylov method.
RCP<const Vector> flow_from_even_pressure(const BlockSystem& system,
                                          const LinearOperator& solid_inverse) {
  constexpr double round_off = 1e-10;
  const CrsMatrix& coupling = *system.coupling_transposed();
  const auto pressure = make_vector(coupling.getDomainMap());
  pressure->putScalar(1);
  Vector force(coupling.getRangeMap()), velocity(coupling.getRangeMap());
  coupling.apply(*pressure, force);
  {
    const auto values = force.getDataNonConst();
    for (std::size_t row = 0; row < system.near_null_space.body_of_row.size(); ++row) {
      if (system.near_null_space.body_of_row[row] < 0)
        values[row] = 0;
    }
  }
  if (force.norm2() <= round_off * coupling.getFrobeniusNorm())
    return Teuchos::null;
  apply(solid_inverse, force, velocity);
  coupling.apply(velocity, *pressure, Teuchos::TRANS);
  return pressure;
}

/// By cell, in the unit of A; null if it is next to nothing on all ranks.
std::optional<std::vector<float>> reaction_of_solids(const BlockSystem& system,
                                                     const LinearOperator& solid_inverse,
                                                     const std::vector<int>& empty_rows) {
  const RCP<const Vector> flow = flow_from_even_pressure(system, solid_inverse);
  if (flow.is_null())
    return {};
  const FaceCoefficients& a = *stencil_of(system.pressure_block());
  std::vector<bool> is_empty(flow->getLocalLength(), false);
  for (const int row : empty_rows)
    is_empty[row] = true;
  // Rounded: sums come in another order on other numbers of ranks.
  constexpr double steps = 1 << 12;
  std::vector<float> reaction(a.row.size(), 0);
  float largest = 0;
  const auto values = flow->getData();
  for (std::size_t cell = 0; cell < reaction.size(); ++cell) {
    const int row = a.row[cell];
    if (row < 0 || is_empty[row] || !(values[row] > 0))
      continue;
    reaction[cell] = static_cast<float>(std::round(steps * values[row] / a.unit) / steps);
    largest = std::max(largest, reaction[cell]);
  }
  if (max_all(a.map->getComm(), largest) == 0)
    return {};
  return reaction;
}

}  // namespace

std::optional<FaceCoefficients> schur_stencil(const BlockSystem& system,
                                              const LinearOperator& solid_inverse,
                                              const std::vector<int>& empty_rows) {
  if (!system.has_solid() || system.near_null_space.empty())
    return {};
  std::optional<FaceCoefficients> result = conducting_through_sheets(system, empty_rows);
  auto reaction = reaction_of_solids(system, solid_inverse, empty_rows);
  if (!result && !reaction)
    return {};
  if (!result)
    result = *stencil_of(system.pressure_block());
  result->reaction = std::move(reaction);
  return result;
}

}  // namespace lockstep
