#include "strategies/common/flat_system.hpp"

#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/thyra_vectors.hpp"

namespace lockstep {

FlatSystem::FlatSystem(const BlockSystem& system)
    : pressure_map_(domain_map(*system.pressure_block())),
      solid_map_(domain_map(*system.solid_block())),
      solid_(make_vector(solid_map_)) {
  const std::size_t n_local =
      pressure_map_->getNodeNumElements() + solid_map_->getNodeNumElements();
  map_ = make_map(static_cast<int>(n_local), pressure_map_->getComm());
  check_solve(min_all(map_->getComm(), static_cast<double>(n_local)) > 0,
              "Belos cannot solve the {}: some rank owns no unknown. Use fewer ranks, or the "
              "strategy schur-cg.",
              system.name);
}

RCP<const Vector> FlatSystem::pressure_part(const Vector& flat) const {
  return flat.offsetView(pressure_map_, 0);
}

RCP<Vector> FlatSystem::pressure_part(Vector& flat) const {
  return flat.offsetViewNonConst(pressure_map_, 0);
}

RCP<const LinearOperator> FlatSystem::scaled(const RCP<const LinearOperator>& op, double t,
                                             double factor) const {
  const std::size_t n_pressures = pressure_map_->getNodeNumElements();
  return action_operator(map_, [=, self = *this](const Vector& x, Vector& y) {
    self.solid_->update(t, *x.offsetView(self.solid_map_, n_pressures), 0);
    // Thyra's views of input vectors are not const; nothing is written to them.
    const BlockVector in{Teuchos::rcp_const_cast<Vector>(self.pressure_part(x)), self.solid_};
    const BlockVector out{self.pressure_part(y),
                          y.offsetViewNonConst(self.solid_map_, n_pressures)};
    Thyra::apply<double>(*op, Thyra::NOTRANS, *as_thyra(in, *op), as_thyra(out, *op).ptr(), factor);
    out.solid->scale(t);
  });
}

}  // namespace lockstep
