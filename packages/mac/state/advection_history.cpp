#include "mac/state/advection_history.hpp"

namespace lockstep {

template <int dim>
AdvectionHistory<dim>::AdvectionHistory(const TiledGrid<dim>& grid) {
  for (CellField& component : rate_)
    component.assign(grid.n_stored_cells(), 0.0);
}

template <int dim>
void AdvectionHistory<dim>::add(double scale, FaceField<dim>& u) const {
  for (int axis = 0; axis < dim; ++axis)
    for (std::size_t i = 0; i < u[axis].size(); ++i)
      u[axis][i] += scale * rate_[axis][i];
}

template <int dim>
void AdvectionHistory<dim>::begin(FaceField<dim> before, const GridState<dim>& state, double dt) {
  before_ = std::move(before);
  faces_ = state.faces;
  dt_ = dt;
}

template <int dim>
void AdvectionHistory<dim>::end(const FaceField<dim>& after, const GridState<dim>& state) {
  for (int axis = 0; axis < dim; ++axis)
    for (std::size_t i = 0; i < after[axis].size(); ++i) {
      const bool stays_free =
          faces_[axis][i] == FaceState::free && state.faces[axis][i] == FaceState::free;
      rate_[axis][i] = stays_free ? (after[axis][i] - before_[axis][i]) / dt_ : 0;
    }
}

template class AdvectionHistory<2>;
template class AdvectionHistory<3>;

}  // namespace lockstep
