#include "mac/state/velocity_history.hpp"

namespace lockstep {

template <int dim>
VelocityHistory<dim>::VelocityHistory(const TiledGrid<dim>& grid) {
  for (int axis = 0; axis < dim; ++axis) {
    acceleration_[axis].assign(grid.n_stored_cells(), 0.0);
  }
  rate_ = free_ = acceleration_;
}

template <int dim>
void VelocityHistory<dim>::add(double scale, const FaceField<dim>& change, FaceField<dim>& u) {
  for (int axis = 0; axis < dim; ++axis) {
    for (std::size_t i = 0; i < u[axis].size(); ++i) {
      u[axis][i] += scale * change[axis][i];
    }
  }
}

template <int dim>
void VelocityHistory<dim>::accept(const FaceField<dim>& before, const FaceField<dim>& after,
                                  const GridState<dim>& state, double dt, bool jumped) {
  const double scale = jumped ? 0 : 1 / dt;
  for (int axis = 0; axis < dim; ++axis) {
    for (std::size_t i = 0; i < after[axis].size(); ++i) {
      const double free = state.faces[axis][i] == FaceState::free ? 1 : 0;
      const double given = state.faces[axis][i] == FaceState::prescribed ? 1 : 0;
      const double per_step = scale * free_[axis][i];
      acceleration_[axis][i] = free * per_step * (after[axis][i] - advected_[axis][i]);
      rate_[axis][i] = (free + given) * per_step * (after[axis][i] - before[axis][i]);
      free_[axis][i] = free + given;
    }
  }
}

template class VelocityHistory<2>;
template class VelocityHistory<3>;

}  // namespace lockstep
