#include "mac/forces/forces.hpp"

namespace lockstep {

template <int dim>
ForceField<dim>::ForceField(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                            const ForceParameters<dim>& parameters, const Scalars<dim>& scalars)
    : domain_(domain),
      geometry_(geometry),
      parameters_(parameters),
      temperature_(parameters.expansion == 0 ? nullptr : scalars.find("temperature")),
      smoke_(parameters.smoke_weight == 0 ? nullptr : scalars.find("smoke")) {}

template <int dim>
double ForceField<dim>::mean(const CellField& field, int axis, int cell) const {
  const auto& cells = geometry_.state.cells;
  const FaceCells face = cells_of_face(domain_.grid, cells, axis, cell);
  double sum = 0;
  int n = 0;
  for (const int side : {face.lower, face.upper})
    if (side >= 0 && cells[side] == CellState::fluid) {
      sum += field[side];
      ++n;
    }
  return n == 0 ? 0 : sum / n;
}

template <int dim>
double ForceField<dim>::operator()(int axis, int cell) const {
  const double gravity = parameters_.gravity[axis];
  double weight = 1;
  if (gravity != 0 && temperature_)
    weight -= parameters_.expansion *
              (mean(temperature_->values, axis, cell) - parameters_.reference_temperature);
  if (gravity != 0 && smoke_)
    weight += parameters_.smoke_weight * mean(smoke_->values, axis, cell);
  return weight * gravity + parameters_.body[axis];
}

template <int dim>
Point<dim> ForceField<dim>::of_surroundings() const {
  double weight = 1;
  if (temperature_)
    weight -= parameters_.expansion * (temperature_->ambient - parameters_.reference_temperature);
  if (smoke_)
    weight += parameters_.smoke_weight * smoke_->ambient;
  return weight * parameters_.gravity + parameters_.body;
}

template class ForceField<2>;
template class ForceField<3>;

}  // namespace lockstep
