#include "mac/viscosity/viscosity.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "mac/viscosity/viscous_stencil.hpp"

namespace lockstep {

template <int dim>
Viscosity<dim>::Viscosity(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                          const ViscosityParameters& parameters, const ImplicitTension& tension)
    : domain_(domain) {
  ViscousStencil<dim> found = find_viscous_stencil(domain, geometry, parameters, tension);
  map_ = found.map;
  faces_ = std::move(found.faces);
  stiffness_ = found.stiffness;
  mass_ = found.mass;
  links_ = std::move(found.links);
  sides_ = std::move(found.sides);
  couples_ = std::move(found.couples);
  cross_pulls_ = std::move(found.cross_pulls);
  inflow_pulls_ = std::move(found.inflow_pulls);
  tension_pulls_ = std::move(found.tension_pulls);
  viscosity_ = found.viscosity;
}

template <int dim>
std::unique_ptr<ViscousSystem<dim>> Viscosity<dim>::system(const FaceField<dim>& velocity,
                                                           double time) const {
  auto result = std::make_unique<ViscousSystem<dim>>();
  result->map = map_;
  result->stiffness = stiffness_;
  result->mass = mass_;
  result->velocity = make_vector(map_);
  result->wall_force = make_vector(map_);
  result->links = links_;
  result->viscosity = viscosity_;
  const auto values = result->velocity->getDataNonConst();
  for (std::size_t row = 0; row < faces_.size(); ++row)
    values[row] = velocity[faces_[row].axis][faces_[row].cell];
  const auto forces = result->wall_force->getDataNonConst();
  for (const SideCoupling& side : sides_)
    forces[side.row] += side.coefficient * side_velocity(side, time);
  for (const InflowPull& pull : inflow_pulls_)
    forces[pull.row] -= pull.coefficient * inflow_velocity(pull.from, time);
  return result;
}

/// The mean over what a face's control volume has of the side: what comes in there. At other sides,
/// and at seams, half of the volume is outside.
template <int dim>
double Viscosity<dim>::side_velocity(const SideCoupling& side, double time) const {
  const auto [axis, cell] = faces_[side.row];
  const Point<dim> x = domain_.grid.face_center(axis, cell);
  const Point<dim> half = Point<dim>::Constant(domain_.grid.spacing() / 2);
  const Box<dim> volume = Box<dim>(x - half, x + half).intersection(domain_.bounds());
  return domain_.boundary.side(side.axis, side.end).mean_velocity(side.axis, volume, time)[axis];
}

/// Velocity of the inflow through a prescribed face [m/s].
template <int dim>
double Viscosity<dim>::inflow_velocity(const FaceId& face, double time) const {
  const int below = domain_.grid.neighbor(face.cell, face.axis, 0);
  const int end = below < 0 ? 0 : 1;
  return domain_.boundary.side(face.axis, end)
      .mean_velocity(face.axis, domain_.face_box(face.axis, face.cell), time)[face.axis];
}

template <int dim>
void Viscosity<dim>::store(const Vector& solution, FaceField<dim>& velocity) const {
  const auto values = solution.getData();
  for (std::size_t row = 0; row < faces_.size(); ++row)
    velocity[faces_[row].axis][faces_[row].cell] = values[row];
}

template <int dim>
Momentum<dim> Viscosity<dim>::impulse(const FaceField<dim>& velocity, double time,
                                      double dt) const {
  const TiledGrid<dim>& grid = domain_.grid;
  Momentum<dim> result;
  for (const SideCoupling& side : sides_) {
    const auto [axis, cell] = faces_[side.row];
    const double pull = side.coefficient * (side_velocity(side, time) - velocity[axis][cell]);
    result.add(grid.face_center(axis, cell), axis, dt * pull);
  }
  result += sum_of(cross_pulls_, velocity, dt);
  for (const InflowPull& pull : inflow_pulls_) {
    const auto [axis, cell] = faces_[pull.row];
    const double force = -pull.from_outside * inflow_velocity(pull.from, time);
    result.add(grid.face_center(axis, cell), axis, dt * force);
  }
  const double h = grid.spacing();
  for (const CoupleEnd& couple : couples_) {
    const auto [axis, cell] = faces_[couple.row];
    // +J here and -J at the upper neighbour: the arm between them is -h.
    const double sum = dt * couple.coefficient * velocity[axis][cell];
    result.angular +=
        cross<dim>(Point<dim>::Unit(couple.across) * -h, Point<dim>::Unit(axis) * sum);
  }
  return sum_over_ranks(result, grid.comm());
}

template <int dim>
Momentum<dim> Viscosity<dim>::tension_impulse(const FaceField<dim>& velocity, double dt) const {
  return sum_over_ranks(sum_of(tension_pulls_, velocity, dt), domain_.grid.comm());
}

/// Sums the impulses of pulls over dt, on this rank.
template <int dim>
Momentum<dim> Viscosity<dim>::sum_of(const std::vector<CrossPull>& pulls,
                                     const FaceField<dim>& velocity, double dt) const {
  Momentum<dim> result;
  for (const CrossPull& pull : pulls) {
    const auto [axis, cell] = faces_[pull.row];
    const double force = -pull.coefficient * velocity[pull.from.axis][pull.from.cell];
    result.add(domain_.grid.face_center(axis, cell), axis, dt * force);
  }
  return result;
}

template class Viscosity<2>;
template class Viscosity<3>;

}  // namespace lockstep
