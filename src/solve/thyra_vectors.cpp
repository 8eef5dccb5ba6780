#include "solve/thyra_vectors.hpp"

#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_ProductMultiVectorBase.hpp>
#include <Thyra_ProductVectorSpaceBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

RCP<ThyraVector> as_thyra(const RCP<Vector>& vector,
                          const RCP<const Thyra::VectorSpaceBase<double>>& space) {
  return Thyra::createVector<double, int, GlobalIndex>(vector, space);
}

RCP<ThyraVector> as_thyra(const BlockVector& vector, const LinearOperator& op) {
  const auto space =
      Teuchos::rcp_dynamic_cast<const Thyra::DefaultProductVectorSpace<double>>(op.domain(), true);
  const Teuchos::Array<RCP<ThyraVector>> parts = Teuchos::tuple(
      as_thyra(vector.pressure, space->getBlock(0)), as_thyra(vector.solid, space->getBlock(1)));
  return Thyra::defaultProductVector<double>(space, parts());
}

std::vector<RCP<Vector>> blocks_of(const RCP<Thyra::MultiVectorBase<double>>& vectors) {
  using Extraction = Thyra::TpetraOperatorVectorExtraction<double, int, GlobalIndex>;
  const auto product = Teuchos::rcp_dynamic_cast<Thyra::ProductMultiVectorBase<double>>(vectors);
  if (product.is_null())
    return {Extraction::getTpetraMultiVector(vectors)->getVectorNonConst(0)};
  std::vector<RCP<Vector>> blocks;
  for (int block = 0; block < product->productSpace()->numBlocks(); ++block)
    blocks.push_back(Extraction::getTpetraMultiVector(product->getNonconstMultiVectorBlock(block))
                         ->getVectorNonConst(0));
  return blocks;
}

RCP<const LinearOperator> block_operator(const BlockSystem& system, double s, double t) {
  LOCKSTEP_ASSERT(system.has_solid());
  const auto scaled = [](double factor, const RCP<const LinearOperator>& op) {
    return factor == 1 ? op : Thyra::scale<double>(factor, op);
  };
  const auto coupling = as_operator(system.coupling_transposed);
  return Thyra::block2x2<double>(scaled(s * s, system.pressure.op),
                                 Thyra::scale<double>(-s * t, Thyra::adjoint<double>(coupling)),
                                 Thyra::scale<double>(-s * t, coupling),
                                 Thyra::scale<double>(-t * t, system.solids.op), system.name);
}

BlockVector signed_rhs(const BlockVector& rhs) {
  BlockVector result;
  result.pressure = rcp(new Vector(*rhs.pressure, Teuchos::Copy));
  if (!rhs.solid.is_null()) {
    result.solid = make_vector(rhs.solid->getMap());
    result.solid->update(-1, *rhs.solid, 0);
  }
  return result;
}

void check_no_empty_rank(const BlockSystem& system, const std::string& who) {
  const auto pressure_map = domain_map(*system.pressure.op);
  const Communicator comm = pressure_map->getComm();
  const auto fewest = [&](const Map& map) {
    return min_all(comm, static_cast<double>(map.getNodeNumElements()));
  };
  check_solve(fewest(*pressure_map) > 0,
              "{} cannot solve the {}: some rank owns no pressure unknown, with which the inner "
              "products of Belos go wrong. Use fewer ranks, or the strategy schur-cg.",
              who, system.name);
  check_solve(!system.has_solid() || fewest(*domain_map(*system.solids.op)) > 0,
              "{} cannot solve the {}: some rank owns no solid unknown, with which the inner "
              "products of Belos go wrong. Spread the solid unknowns or pad them with inert ones, "
              "or use the strategy schur-cg.",
              who, system.name);
}

}  // namespace lockstep
