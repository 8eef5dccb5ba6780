#include "contact/impulses/mobility.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {

template <int dim>
Mobility<dim>::Mobility(const InverseMass& inverse_mass, const SolidSystem<dim>& system,
                        RCP<const LinearOperator> response)
    : inverse_mass_(inverse_mass),
      system_(&system),
      response_(std::move(response)),
      number_(inverse_mass.rows.size(), -1) {}

template <int dim>
std::vector<double> Mobility<dim>::velocities(std::vector<double> impulses) const {
  for (std::size_t dof = 0; dof < impulses.size(); ++dof) {
    if (is_held(static_cast<int>(dof)))
      impulses[dof] = 0;
  }
  const RCP<Vector> velocity = make_vector(system_->map());
  apply(*response_, *distributed(*system_, impulses), *velocity);
  std::vector<double> values = replicated(*system_, *velocity);
  for (std::size_t dof = 0; dof < values.size(); ++dof) {
    if (is_held(static_cast<int>(dof)))
      values[dof] = 0;
  }
  return values;
}

/// The response is symmetric: its column is the new row of the others.
template <int dim>
int Mobility<dim>::activate(int dof) {
  if (number_[dof] >= 0)
    return number_[dof];
  std::vector<double> unit(number_.size(), 0);
  unit[dof] = 1;
  const std::vector<double> values = velocities(std::move(unit));
  number_[dof] = n_active();
  active_.push_back(dof);
  GrowingColumn column;
  for (const int other : active_)
    column.push_back(values[other]);
  for (std::size_t k = 0; k < columns_.size(); ++k)
    columns_[k].push_back(values[active_[k]]);
  columns_.push_back(std::move(column));
  return number_[dof];
}

template class Mobility<2>;
template class Mobility<3>;

}  // namespace lockstep
