#include "mac/state/initial_state.hpp"

#include <cmath>
#include <functional>

#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {
template <int dim>
using VelocityProfile = std::function<Point<dim>(const Point<dim>&)>;

template <int dim>
VelocityProfile<dim> uniform(const ParameterList& list) {
  const Point<dim> velocity = point_value<dim>(list, "Velocity");
  return [velocity](const Point<dim>&) { return velocity; };
}

/// In the xy plane: u = U (sin kx cos ky, -cos kx sin ky), which a viscous fluid damps by
/// exp(-2 nu k^2 t) without any other change.
template <int dim>
VelocityProfile<dim> taylor_green(const ParameterList& list) {
  const double amplitude = list.get<double>("Amplitude");
  const double k = 2 * M_PI / list.get<double>("Wavelength");
  const Point<dim> mean = point_value<dim>(list, "Velocity");
  return [=](const Point<dim>& x) {
    Point<dim> u = mean;
    u[0] += amplitude * std::sin(k * x[0]) * std::cos(k * x[1]);
    u[1] -= amplitude * std::cos(k * x[0]) * std::sin(k * x[1]);
    return u;
  };
}

template <int dim>
VelocityProfile<dim> rotation(const ParameterList& list) {
  const auto& rates = list.get<ParameterArray<double>>("Angular Velocity");
  const Point<dim> center = point_value<dim>(list, "Center");
  AngularVector<dim> w;
  for (int a = 0; a < n_rotations<dim>; ++a)
    w[a] = rates[a];
  return [=](const Point<dim>& x) { return rotate<dim>(w, x - center); };
}
}  // namespace

template <int dim>
void declare_initial_state(ParameterList& fluid) {
  ParameterList at_rest, uniform_list, vortex, rotation_list;
  declare_vector(uniform_list, "Velocity", filled_array(dim, 0.0), dim,
                 "Velocity everywhere [m/s].");
  declare(vortex, "Amplitude", 1.0, "Largest velocity U [m/s].");
  declare_positive(vortex, "Wavelength", 1.0, "Length of one period, 2 pi / k [m].");
  declare_vector(vortex, "Velocity", filled_array(dim, 0.0), dim, "Uniform velocity on top [m/s].");
  declare_vector(rotation_list, "Angular Velocity", filled_array(n_rotations<dim>, 0.0),
                 n_rotations<dim>, "Rate of the rotation, about z in 2D [rad/s].");
  declare_vector(rotation_list, "Center", filled_array(dim, 0.0), dim, "A point at rest [m].");
  declare_typed_sublist(
      fluid, "Initial State", "The fluid's velocity at the start.",
      {{"at rest", "No motion.", at_rest},
       {"uniform", "One velocity everywhere.", uniform_list},
       {"taylor green",
        "Periodic vortices u = U (sin kx cos ky, -cos kx sin ky), an exact solution that viscosity "
        "damps by exp(-2 nu k^2 t).",
        vortex},
       {"rotation", "Rotation of the whole fluid as a solid.", rotation_list}},
      "at rest");
}

template <int dim>
FaceField<dim> initial_velocity(const TiledGrid<dim>& grid, const ParameterList& initial_state) {
  FaceField<dim> velocity;
  for (int axis = 0; axis < dim; ++axis)
    velocity[axis].assign(grid.n_stored_cells(), 0.0);
  const auto type = initial_state.get<std::string>("Type");
  if (type == "at rest")
    return velocity;
  const VelocityProfile<dim> profile = type == "uniform"        ? uniform<dim>(initial_state)
                                       : type == "taylor green" ? taylor_green<dim>(initial_state)
                                                                : rotation<dim>(initial_state);
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      velocity[axis][cell] = profile(grid.face_center(axis, cell))[axis];
    });
  return velocity;
}

template void declare_initial_state<2>(ParameterList&);
template void declare_initial_state<3>(ParameterList&);
template FaceField<2> initial_velocity<2>(const TiledGrid<2>&, const ParameterList&);
template FaceField<3> initial_velocity<3>(const TiledGrid<3>&, const ParameterList&);

}  // namespace lockstep
