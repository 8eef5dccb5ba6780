#include "solve/block_residual.hpp"

#include <fmt/format.h>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "linear/matrix_rows.hpp"
#include "linear/residual_operator.hpp"
#include "linear/vector_sums.hpp"

namespace lockstep {

namespace {
/// Surfaces that move against each other within one cell carry fluxes that cancel to round-off.
/// The least scale of the pressure rows, as a part of what the fluxes would be without that: with
/// it the usual tolerances stay above round-off.
constexpr double least_flux = 1e-6;
/// Least scale of the solids' rows, likewise: elastic forces cancel where solids move rigidly, and
/// pressures where the flow is the same on both sides.
constexpr double least_force = 1e-6;

/// |diag(C) V|, which is what elastic forces would be if they did not cancel; 0 if C is no matrix.
double gross_force(const RCP<const LinearOperator>& solid_block, const Vector& velocity) {
  const auto c = assembled(solid_block);
  if (c.is_null())
    return 0;
  Vector force(c->getRowMap());
  force.elementWiseMultiply(1, *diagonal_of(*c), velocity, 0);
  return norm(force);
}

/// residual += sign term; `scale` becomes |term| if that is more.
void add_term(Vector& residual, const Vector& term, double sign, double& scale) {
  scale = std::max(scale, add_and_measure(sign, term, residual));
}

/// r_1 = rhs_1 - A p̂ with its norm and scale.
void subtract_product(const BlockSystem& system, const BlockVector& rhs,
                      const BlockVector& solution, BlockResidual& result) {
  Vector& r1 = *result.vector.pressure;
  if (const auto* op = residual_operator_of(system.pressure_block())) {
    const auto norms = op->residual(*rhs.pressure, *solution.pressure, r1);
    result.pressure_scale = std::max(norms.rhs, norms.product);
    result.pressure = norms.residual;
    return;
  }
  Tpetra::deep_copy(r1, *rhs.pressure);
  result.pressure_scale = norm(r1);
  Vector term(r1.getMap());
  apply(*system.pressure_block(), *solution.pressure, term);
  add_term(r1, term, -1, result.pressure_scale);
  result.pressure = norm(r1);
}
}  // namespace

SolidResidual solid_row_residual(const BlockSystem& system, const BlockVector& rhs,
                                 const BlockVector& solution) {
  SolidResidual result{make_vector(rhs.solid->getMap())};
  Vector term(rhs.solid->getMap());
  add_term(*result.vector, *rhs.solid, -1, result.scale);
  system.coupling_transposed()->apply(*solution.pressure, term);
  add_term(*result.vector, term, 1, result.scale);
  apply(*system.solid_block(), *solution.solid, term);
  add_term(*result.vector, term, 1, result.scale);
  return result;
}

BlockResidual block_residual(const BlockSystem& system, const BlockVector& rhs,
                             const BlockVector& solution) {
  BlockResidual result;
  find_block_residual(system, rhs, solution, result);
  return result;
}

void find_block_residual(const BlockSystem& system, const BlockVector& rhs,
                         const BlockVector& solution, BlockResidual& result) {
  auto& r1 = result.vector.pressure;
  if (r1.is_null())
    r1 = make_vector(rhs.pressure->getMap());
  subtract_product(system, rhs, solution, result);
  if (!system.has_solid())
    return;
  Vector term(r1->getMap());
  system.coupling_transposed()->apply(*solution.solid, term, Teuchos::TRANS);
  add_term(*r1, term, 1, result.pressure_scale);
  const double size_of_coupling = system.coupling_transposed()->getFrobeniusNorm();
  const double gross_flux = size_of_coupling * solution.solid->norm2();
  result.pressure_scale = std::max(result.pressure_scale, least_flux * gross_flux);
  result.pressure = norm(*r1);

  const SolidResidual row = solid_row_residual(system, rhs, solution);
  result.vector.solid = row.vector;
  result.solid_scale =
      std::max({row.scale, least_force * gross_force(system.solid_block(), *solution.solid),
                least_force * size_of_coupling * solution.pressure->norm2()});
  result.solid = norm(*row.vector);
}

std::string by_name(const BlockGroup& group, const Vector& vector, double scale) {
  if (group.blocks.size() < 2)
    return "";
  const auto values = vector.getData();
  std::vector<double> squares;
  for (const Block& block : group.blocks)
    squares.push_back(sum_of_products(values.getRawPtr() + block.begin,
                                      values.getRawPtr() + block.begin, block.end - block.begin));
  sum_over_ranks(vector.getMap()->getComm(), squares);
  std::vector<std::string> parts;
  for (std::size_t b = 0; b < squares.size(); ++b)
    parts.push_back(fmt::format("{} {:.2e}", group.blocks[b].name,
                                scale > 0 ? std::sqrt(squares[b]) / scale : 0));
  return fmt::format(" ({})", fmt::join(parts, ", "));
}

}  // namespace lockstep
