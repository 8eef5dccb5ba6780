#include "mac/state/initial_state.hpp"

namespace lockstep {

template <int dim>
FaceField<dim> initial_velocity(const TiledGrid<dim>& grid, const FieldFormula<dim>& formula) {
  FaceField<dim> velocity;
  for (int axis = 0; axis < dim; ++axis) {
    velocity[axis].assign(grid.n_stored_cells(), 0.0);
    if (formula.is_number(axis) && formula(axis, grid.lower(), 0) == 0)
      continue;
    grid.for_each_owned_face(axis, [&](int cell) {
      velocity[axis][cell] = formula(axis, grid.face_center(axis, cell), 0);
    });
  }
  return velocity;
}

template FaceField<2> initial_velocity<2>(const TiledGrid<2>&, const FieldFormula<2>&);
template FaceField<3> initial_velocity<3>(const TiledGrid<3>&, const FieldFormula<3>&);

}  // namespace lockstep
