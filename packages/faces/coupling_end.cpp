#include "faces/coupling_end.hpp"

namespace lockstep {

template <int dim>
bool CouplingEnd<dim>::add(double weight, const SurfacePoint<dim>& point, int solid,
                           const Point<dim>& x, const Point<dim>& pulled) {
  const bool prescribed = solids_.solids()[solid].prescribed;
  row_.shares.push_back({weight, point, prescribed, pulled});
  if (weight > largest_share_) {
    largest_share_ = weight;
    row_.solid = solid;
  }
  if (prescribed) {
    row_.prescribed += weight * solids_.prescribed_velocity(point, x)[direction_];
    row_.prescribed_share += weight;
    row_.prescribed_solid = solid;
    return false;
  }
  dynamic_share_ += weight;
  pulled_ += weight * pulled;
  return true;
}

template <int dim>
void CouplingEnd<dim>::finish() {
  if (dynamic_share_ > 0)
    row_.position = pulled_ / dynamic_share_;
}

template class CouplingEnd<2>;
template class CouplingEnd<3>;

}  // namespace lockstep
