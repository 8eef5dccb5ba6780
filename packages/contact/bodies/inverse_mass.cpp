#include "contact/bodies/inverse_mass.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/block_diagonal.hpp"

namespace lockstep {

namespace {

/// Row, column, value of this rank's nonzeros.
std::vector<double> triplets_of(const CrsMatrix& matrix) {
  std::vector<double> triplets;
  Teuchos::ArrayView<const int> columns;
  Teuchos::ArrayView<const double> values;
  for (int row = 0; row < static_cast<int>(matrix.getNodeNumRows()); ++row) {
    matrix.getLocalRowView(row, columns, values);
    for (int k = 0; k < columns.size(); ++k) {
      triplets.push_back(static_cast<double>(matrix.getRowMap()->getGlobalElement(row)));
      triplets.push_back(static_cast<double>(matrix.getColMap()->getGlobalElement(columns[k])));
      triplets.push_back(values[k]);
    }
  }
  return triplets;
}

/// Row, column, value of this rank's part of the inverse. Collective.
template <int dim>
std::vector<double> own_triplets(const SolidSystem<dim>& system, bool& exact) {
  exact = true;
  // All blocks are small: solves have it already.
  if (const auto inverse = assembled(system.mass_inverse()); !inverse.is_null())
    return triplets_of(*inverse);
  const int of_joints = system.joints() ? system.joints()->largest_block() : 0;
  const int largest = std::max(of_joints, largest_dense_block);
  if (const auto mass = assembled(system.solid_block(Teuchos::null, 0)); !mass.is_null()) {
    const auto blocks = block_diagonal_inverse(mass, largest, "mass of the solids");
    if (blocks.exact)
      return triplets_of(*blocks.inverse);
  }
  exact = false;
  const auto blocks = block_diagonal_inverse(system.lumped_block(), largest, "mass of the solids");
  return triplets_of(*blocks.inverse);
}

}  // namespace

template <int dim>
std::vector<double> replicated(const SolidSystem<dim>& system, const Vector& stacked) {
  std::vector<double> result(system.n_unknowns(), 0);  // zero where others have them
  const auto values = stacked.getData();
  for (int row = 0; row < values.size(); ++row) {
    const GlobalIndex id = system.map()->getGlobalElement(row);
    if (id < system.n_unknowns())
      result[id] = values[row];
  }
  sum_over_ranks(system.comm(), result);
  return result;
}

template <int dim>
RCP<Vector> distributed(const SolidSystem<dim>& system, const std::vector<double>& values) {
  const RCP<Vector> vector = make_vector(system.map());
  const auto data = vector->getDataNonConst();
  for (int row = 0; row < data.size(); ++row) {
    const GlobalIndex id = system.map()->getGlobalElement(row);
    if (id < static_cast<GlobalIndex>(values.size()))
      data[row] = values[id];
  }
  return vector;
}

/// Rows by id of the triplets of all ranks, of unknowns alone. Collective.
template <int dim>
std::vector<std::vector<std::pair<int, double>>> replicated_rows(const SolidSystem<dim>& system,
                                                                 const std::vector<double>& mine) {
  const std::vector<double> all = gather_all(system.comm(), mine);
  std::vector<double> free(system.n_unknowns(), 1);
  if (!system.reduction().is_identity())
    free = replicated(system, *system.reduction().unknowns());
  const auto n = static_cast<double>(free.size());
  std::vector<std::vector<std::pair<int, double>>> rows(free.size());
  for (std::size_t k = 0; k + 2 < all.size(); k += 3) {
    if (all[k] >= n || all[k + 1] >= n)
      continue;
    const auto row = static_cast<std::size_t>(all[k]);
    const auto column = static_cast<std::size_t>(all[k + 1]);
    if (free[row] != 0 && free[column] != 0)
      rows[row].push_back({static_cast<int>(column), all[k + 2]});
  }
  return rows;
}

template <int dim>
InverseMass replicated_inverse_mass(const SolidSystem<dim>& system) {
  InverseMass result;
  const std::vector<double> mine = own_triplets(system, result.exact);
  result.rows = replicated_rows(system, mine);
  return result;
}

template <int dim>
InverseMass replicated_inverse(const SolidSystem<dim>& system, const CrsMatrix& inverse) {
  return {true, replicated_rows(system, triplets_of(inverse))};
}

template InverseMass replicated_inverse<2>(const SolidSystem<2>&, const CrsMatrix&);
template InverseMass replicated_inverse<3>(const SolidSystem<3>&, const CrsMatrix&);
template InverseMass replicated_inverse_mass<2>(const SolidSystem<2>&);
template InverseMass replicated_inverse_mass<3>(const SolidSystem<3>&);
template std::vector<double> replicated<2>(const SolidSystem<2>&, const Vector&);
template std::vector<double> replicated<3>(const SolidSystem<3>&, const Vector&);
template RCP<Vector> distributed<2>(const SolidSystem<2>&, const std::vector<double>&);
template RCP<Vector> distributed<3>(const SolidSystem<3>&, const std::vector<double>&);

}  // namespace lockstep
