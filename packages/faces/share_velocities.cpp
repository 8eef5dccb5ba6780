#include "faces/share_velocities.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>

namespace lockstep {

template <int dim>
ShareVelocities<dim>::ShareVelocities(const SolidSystem<dim>& solids, const Import& import,
                                      const Vector& velocity)
    : solids_(solids), velocity_(import.getTargetMap()) {
  velocity_.doImport(velocity, import, Tpetra::INSERT);
}

template <int dim>
double ShareVelocities<dim>::along(int direction, const SurfacePoint<dim>& point,
                                   const Point<dim>& x) {
  directed_row<dim>(solids_, point, x, direction, row_);
  const auto values = velocity_.getData();
  double sum = 0;
  for (std::size_t k = 0; k < row_.dofs.size(); ++k)
    sum += row_.values[k] * values[velocity_.getMap()->getLocalElement(row_.dofs[k])];
  return sum;
}

template class ShareVelocities<2>;
template class ShareVelocities<3>;

}  // namespace lockstep
