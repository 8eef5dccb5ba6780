#include "linear/block_residual.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/vector_sums.hpp"

namespace lockstep {

namespace {
/// Surfaces that move against each other within one cell carry fluxes that cancel to round-off.
/// The least scale of the pressure rows, as a part of what the fluxes would be without that: with
/// it the usual tolerances stay above round-off.
constexpr double least_flux = 1e-6;
}  // namespace

BlockResidual block_residual(const BlockSystem& system, const BlockVector& rhs,
                             const BlockVector& solution) {
  BlockResidual result;
  const auto add_row = [](Vector& residual, const Vector& term, double sign, double& scale) {
    residual.update(sign, term, 1);
    scale = std::max(scale, norm(term));
  };
  auto& r1 = result.vector.pressure;
  r1 = rcp(new Vector(*rhs.pressure, Teuchos::Copy));
  result.pressure_scale = norm(*r1);
  Vector term(r1->getMap());
  apply(*system.pressure_block, *solution.pressure, term);
  add_row(*r1, term, -1, result.pressure_scale);
  if (system.has_solid()) {
    system.coupling_transposed->apply(*solution.solid, term, Teuchos::TRANS);
    add_row(*r1, term, 1, result.pressure_scale);
    const double gross_flux =
        system.coupling_transposed->getFrobeniusNorm() * solution.solid->norm2();
    result.pressure_scale = std::max(result.pressure_scale, least_flux * gross_flux);

    auto& r2 = result.vector.solid;
    r2 = make_vector(rhs.solid->getMap());
    Vector solid_term(r2->getMap());
    add_row(*r2, *rhs.solid, -1, result.solid_scale);
    system.coupling_transposed->apply(*solution.pressure, solid_term);
    add_row(*r2, solid_term, 1, result.solid_scale);
    apply(*system.solid_block, *solution.solid, solid_term);
    add_row(*r2, solid_term, 1, result.solid_scale);
    result.solid = norm(*r2);
  }
  result.pressure = norm(*r1);
  return result;
}

}  // namespace lockstep
