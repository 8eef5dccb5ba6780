#include "coupling/nonlinear_bodies.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {

template <int dim>
NonlinearBodies<dim>::NonlinearBodies(const SolidSystem<dim>& solids) : solids_(solids) {
  int first = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    const SolidModel<dim>& model = solids.model(m);
    const auto n_rows = static_cast<int>(model.dof_map()->getNodeNumElements());
    const std::vector<int> own =
        solids.nonlinear(m) ? model.solid_of_row() : std::vector<int>(n_rows, -1);
    for (int row = 0; row < n_rows; ++row) {
      solid_of_row_.push_back(own[row] < 0 ? -1 : first + own[row]);
      axis_of_row_.push_back(row % dim);
    }
    first += static_cast<int>(model.solids().size());
  }
  const auto n_rows = static_cast<int>(solids.map()->getNodeNumElements());
  solid_of_row_.resize(n_rows, -1);  // padding
  axis_of_row_.resize(n_rows, 0);

  const RCP<Vector> along = make_vector(solids.map()), momentum = make_vector(solids.map());
  {
    const auto values = along->getDataNonConst();
    for (int row = 0; row < n_rows; ++row)
      values[row] = solid_of_row_[row] >= 0 && axis_of_row_[row] == 0 ? 1 : 0;
  }
  apply(*solids.mass(), *along, *momentum);
  mass_ = dot(*along, *momentum);
  std::vector<double> n_held(mass_.size(), 0);
  if (const RCP<const Vector> unknowns = solids.reduction().unknowns(); !unknowns.is_null()) {
    const auto values = unknowns->getData();
    for (int row = 0; row < n_rows; ++row) {
      if (solid_of_row_[row] >= 0 && values[row] == 0)
        ++n_held[solid_of_row_[row]];
    }
  }
  sum_over_ranks(solids.comm(), n_held);
  for (std::size_t s = 0; s < mass_.size(); ++s)
    mass_[s] = n_held[s] > 0 ? 0 : mass_[s];
}

template <int dim>
std::vector<double> NonlinearBodies<dim>::dot(const Vector& one, const Vector& other) const {
  std::vector<double> sums(solids_.solids().size(), 0);
  const auto a = one.getData(), b = other.getData();
  for (std::size_t row = 0; row < solid_of_row_.size(); ++row) {
    if (solid_of_row_[row] >= 0)
      sums[solid_of_row_[row]] += a[row] * b[row];
  }
  sum_over_ranks(solids_.comm(), sums);
  return sums;
}

template <int dim>
RCP<Vector> NonlinearBodies<dim>::without_translations(const Vector& velocity) const {
  const auto result = rcp(new Vector(velocity, Teuchos::Copy));
  const RCP<Vector> momentum = make_vector(solids_.map());
  apply(*solids_.mass(), velocity, *momentum);
  std::vector<double> mean(dim * mass_.size(), 0);
  {
    const auto values = momentum->getData();
    for (std::size_t row = 0; row < solid_of_row_.size(); ++row) {
      if (solid_of_row_[row] >= 0)
        mean[dim * solid_of_row_[row] + axis_of_row_[row]] += values[row];
    }
  }
  sum_over_ranks(solids_.comm(), mean);
  const auto values = result->getDataNonConst();
  for (std::size_t row = 0; row < solid_of_row_.size(); ++row) {
    const int solid = solid_of_row_[row];
    if (solid < 0)
      values[row] = 0;
    else if (mass_[solid] > 0)
      values[row] -= mean[dim * solid + axis_of_row_[row]] / mass_[solid];
  }
  return result;
}

template <int dim>
void NonlinearBodies<dim>::scale(const std::vector<double>& by_solid, Vector& stacked) const {
  const auto values = stacked.getDataNonConst();
  for (std::size_t row = 0; row < solid_of_row_.size(); ++row) {
    if (solid_of_row_[row] >= 0)
      values[row] *= by_solid[solid_of_row_[row]];
  }
}

template class NonlinearBodies<2>;
template class NonlinearBodies<3>;

}  // namespace lockstep
