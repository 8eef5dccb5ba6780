#include "linear/overlap.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

namespace lockstep {

RCP<Import> import_of(std::vector<GlobalIndex> wanted, const RCP<const Map>& owner) {
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const auto map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                               Teuchos::arrayViewFromVector(wanted), 0, owner->getComm()));
  return rcp(new Import(owner, map));
}

RCP<Vector> on_columns(const CrsMatrix& matrix, const Vector& values) {
  const auto result = make_vector(matrix.getColMap());
  const auto importer = matrix.getGraph()->getImporter();
  if (importer.is_null())
    result->update(1, values, 0);
  else
    result->doImport(values, *importer, Tpetra::INSERT);
  return result;
}

void add_overlap(const Vector& overlap, const Import& import, Vector& values) {
  Vector sum(values.getMap());
  sum.doExport(overlap, import, Tpetra::ADD);
  values.update(1, sum, 1);
}

}  // namespace lockstep
