#include <Tpetra_MultiVector.hpp>

#include "deformable/deformable_solids.hpp"

namespace lockstep {

template <int dim>
RigidMotions DeformableSolids<dim>::near_null_space() const {
  RigidMotions space;
  space.n_bodies = static_cast<int>(bodies_.size());
  const auto motions = rcp(new MultiVector(space_.dof_map(), dim + n_rotations<dim>));
  for (int j = 0; j < dim + n_rotations<dim>; ++j) {
    const auto values = motions->getDataNonConst(j);
    for (int i = 0; i < space_.n_owned(); ++i) {
      Point<dim> velocity = Point<dim>::Unit(j % dim);
      if (j >= dim) {
        const Point<dim> arm = x_[i] - states_[body_of_node_[i]].center_of_mass;
        velocity = rotate<dim>(AngularVector<dim>::Unit(j - dim), arm);
      }
      Eigen::Map<Point<dim>>(values.getRawPtr() + dim * i) = velocity;
    }
  }
  space.motions = motions;
  for (int i = 0; i < space_.n_owned(); ++i)
    space.body_of_row.insert(space.body_of_row.end(), dim, body_of_node_[i]);
  return space;
}

template RigidMotions DeformableSolids<2>::near_null_space() const;
template RigidMotions DeformableSolids<3>::near_null_space() const;

}  // namespace lockstep
