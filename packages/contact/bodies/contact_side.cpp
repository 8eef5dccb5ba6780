#include "contact/bodies/contact_side.hpp"

#include "contact/bodies/carried_point.hpp"

namespace lockstep {

template <int dim>
std::vector<Carrier<dim>> carriers_of(const ContactShapes<dim>& shapes,
                                      const ContactSide<dim>& side) {
  if (shapes.solids()[side.solid].rigid)
    return {{side.point, Eigen::Matrix<double, dim, dim>::Identity()}};
  std::vector<Carrier<dim>> carriers;
  const auto factors = carried_point<dim>(shapes.corners(side.point.simplex), side.point, side.x);
  for (int k = 0; k < dim; ++k) {
    if (factors[k].isZero(0))
      continue;
    SurfacePoint<dim> corner;
    corner.simplex = side.point.simplex;
    corner.barycentric[k] = 1;
    carriers.push_back({corner, factors[k]});
  }
  return carriers;
}

template <int dim>
std::vector<std::pair<GlobalIndex, double>> impulse_on(const SolidSystem<dim>& system,
                                                       const ContactShapes<dim>& shapes,
                                                       const ContactSide<dim>& side,
                                                       const Point<dim>& impulse) {
  std::vector<std::pair<GlobalIndex, double>> on_dofs;
  if (shapes.solids()[side.solid].prescribed)
    return on_dofs;
  VelocityRow<dim> row;
  for (const Carrier<dim>& carrier : carriers_of(shapes, side)) {
    const Point<dim> pushed = carrier.factor.transpose() * impulse;
    system.velocity_row(shapes.known_to_system(carrier.point), side.x, row);
    for (std::size_t k = 0; k < row.dofs.size(); ++k)
      on_dofs.emplace_back(row.dofs[k], row.coefficients[k].dot(pushed));
  }
  return on_dofs;
}

template std::vector<Carrier<2>> carriers_of(const ContactShapes<2>&, const ContactSide<2>&);
template std::vector<Carrier<3>> carriers_of(const ContactShapes<3>&, const ContactSide<3>&);
template std::vector<std::pair<GlobalIndex, double>> impulse_on(const SolidSystem<2>&,
                                                                const ContactShapes<2>&,
                                                                const ContactSide<2>&,
                                                                const Point<2>&);
template std::vector<std::pair<GlobalIndex, double>> impulse_on(const SolidSystem<3>&,
                                                                const ContactShapes<3>&,
                                                                const ContactSide<3>&,
                                                                const Point<3>&);

}  // namespace lockstep
