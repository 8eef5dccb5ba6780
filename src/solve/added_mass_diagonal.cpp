#include "solve/added_mass_diagonal.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "linear/matrix_rows.hpp"

namespace lockstep {

RCP<Vector> added_mass_diagonal(const BlockSystem& system, const RCP<const Map>& map) {
  const auto result = make_vector(map);
  const auto solid = assembled(system.solid_block());
  if (solid.is_null())
    return result;
  const CrsMatrix& coupling = *system.coupling_transposed();
  const auto mass = diagonal_of(*solid);
  const auto masses = mass->getData();
  // A pressure that the weights of a solid cancel for is not moved by it.
  const double round_off = round_off_of_sums(coupling);
  Vector on_columns(coupling.getColMap());
  {
    const auto sums = on_columns.getDataNonConst();
    for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
      if (masses[row] > 0 && std::abs(value) > round_off)
        sums[coupling.getColMap()->getLocalElement(column)] += value * value / masses[row];
    });
  }
  const auto importer = coupling.getGraph()->getImporter();
  if (importer.is_null())
    result->update(1, on_columns, 0);
  else
    result->doExport(on_columns, *importer, Tpetra::ADD);
  return result;
}

}  // namespace lockstep
