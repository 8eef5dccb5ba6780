#include "solve/thyra_vectors.hpp"

#include <Thyra_DefaultProductMultiVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Vector.hpp>

namespace lockstep {

RCP<ThyraVector> as_thyra(const RCP<Vector>& vector,
                          const RCP<const Thyra::VectorSpaceBase<double>>& space) {
  return Thyra::createVector<double, int, GlobalIndex>(vector, space);
}

RCP<Thyra::MultiVectorBase<double>> as_thyra(const BlockVector& vector, const LinearOperator& op) {
  const auto space =
      Teuchos::rcp_dynamic_cast<const Thyra::DefaultProductVectorSpace<double>>(op.domain(), true);
  const auto part = [&](const RCP<MultiVector>& values, int block) {
    return Thyra::createMultiVector<double, int, GlobalIndex>(values, space->getBlock(block));
  };
  const Teuchos::Array<RCP<Thyra::MultiVectorBase<double>>> parts =
      Teuchos::tuple(part(vector.pressure, 0), part(vector.solid, 1));
  return Thyra::defaultProductMultiVector<double>(space, parts());
}

}  // namespace lockstep
