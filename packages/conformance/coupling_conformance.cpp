#include "conformance/coupling_conformance.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "conformance/bounds.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

namespace {

/// Some value for each id, the same on any number of ranks.
double some(GlobalIndex id) {
  return std::sin(1. + 0.7 * static_cast<double>(id % 1000));
}

template <int dim>
double some_pressure(const PressureSide<dim>& side) {
  return side.unknown == no_index ? 0 : some(side.unknown);
}

template <int dim>
bool none_is_prescribed(const SolidSystem<dim>& solids) {
  for (const SolidDescription& solid : solids.solids())
    if (solid.prescribed)
      return false;
  return true;
}

/// B V_S by the stored B^T and by effective velocities: those of a motion that takes no time.
template <int dim>
void check_divergence(const Coupling<dim>& coupling, const FluidDiscretization<dim>& fluid,
                      SolidSystem<dim>& solids, Violations& found) {
  const auto map = fluid.pressure_map();
  const auto velocity = make_vector(solids.map()), nothing = make_vector(solids.map());
  pseudo_random(*velocity, 1);
  const auto effective = make_vector(map), by_matrix = make_vector(map),
             prescribed = make_vector(map), of_prescribed = make_vector(map);
  solids.move(*velocity, 0, 0);
  coupling.add_effective_divergence(solids, *effective);
  solids.move(*nothing, 0, 0);
  coupling.add_effective_divergence(solids, *of_prescribed);
  coupling.coupling_transposed()->apply(*velocity, *by_matrix, Teuchos::TRANS);
  effective->update(-1, *of_prescribed, -1, *by_matrix, 1);
  expect_small(found, effective->norm2() / std::max(by_matrix->norm2(), 1e-300), round_off,
               "add_effective_divergence: not B V_S of coupling_transposed");
  coupling.add_prescribed_divergence(*prescribed);
  const double size = std::max(prescribed->norm2(), by_matrix->norm2());
  of_prescribed->update(-1, *prescribed, 1);
  expect_small(found, of_prescribed->norm2() / size, round_off,
               "add_prescribed_divergence: not that of the velocities of prescribed solids");
}

/// Checks that the impulse of pressures and lumped fluid on the solids is what the faces and the
/// fluid lose.
template <int dim>
void check_exchange(const Coupling<dim>& coupling, const FluidDiscretization<dim>& fluid,
                    const SolidSystem<dim>& solids, Violations& found) {
  if (!none_is_prescribed(solids))
    return;
  const auto map = fluid.pressure_map();
  const auto pressure = make_vector(map), taken = make_vector(solids.map()),
             lumped = make_vector(solids.map());
  for (std::size_t k = 0; k < map->getNodeNumElements(); ++k)
    pressure->replaceLocalValue(static_cast<int>(k),
                                some(map->getGlobalElement(static_cast<int>(k))));
  coupling.coupling_transposed()->apply(*pressure, *taken);

  const auto& volumes = fluid.coupled_volumes();
  const std::vector<double>& masses = coupling.fluid_mass();
  Momentum<dim> by_faces, by_masses;
  std::vector<double> velocity(volumes.size());
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    const ControlVolume<dim>& volume = volumes[k];
    velocity[k] = some(volume.id);
    by_faces.add(volume.center, volume.direction,
                 volume.area * (1 - volume.open_fraction) *
                     (some_pressure(volume.sides[1]) - some_pressure(volume.sides[0])));
    by_masses.add(volume.center, volume.direction, masses[k] * velocity[k]);
  }
  by_faces = sum_over_ranks(by_faces, map->getComm());
  by_masses = sum_over_ranks(by_masses, map->getComm());
  coupling.add_lumped_momentum(velocity, *lumped);
  const double force = (solids.momentum(*taken).linear - by_faces.linear).norm();
  const double momentum = (solids.momentum(*lumped).linear - by_masses.linear).norm();
  expect_small(found, force / std::max(by_faces.linear.norm(), taken->norm1()), round_off,
               "coupling_transposed: solids get another force than the faces carry");
  expect_small(found, momentum / std::max(by_masses.linear.norm(), 1e-300), round_off,
               "add_lumped_momentum: solids get another momentum than the fluid gives");
}

template <int dim>
void check_masses(const Coupling<dim>& coupling, const FluidDiscretization<dim>& fluid,
                  const SolidSystem<dim>& solids, Violations& found) {
  const std::size_t n = fluid.coupled_volumes().size();
  const auto& comm = fluid.pressure_map()->getComm();
  double bad =
      coupling.fluid_mass().size() == n && coupling.effective_velocity(solids).size() == n ? 0 : 1;
  for (const double mass : coupling.fluid_mass())
    bad += !(mass >= 0);
  expect_true(
      found, sum_all(comm, bad) == 0,
      "fluid_mass, effective_velocity: not one for each coupled volume, or a negative mass");
  if (coupling.added_mass().is_null())
    return;
  const auto x = make_vector(solids.map()), y = make_vector(solids.map()),
             z = make_vector(solids.map());
  pseudo_random(*x, 2);
  pseudo_random(*z, 3);
  coupling.added_mass()->apply(*x, *y);
  const double scale = std::max(y->norm2() * z->norm2(), 1e-300), zmx = z->dot(*y),
               xmx = x->dot(*y);
  coupling.added_mass()->apply(*z, *y);
  expect_small(found, (zmx - x->dot(*y)) / scale, round_off, "added_mass: not symmetric");
  expect_true(found, xmx >= -round_off * scale, "added_mass: not positive semidefinite");
}

}  // namespace

template <int dim>
Violations check_coupling(Coupling<dim>& coupling, FluidDiscretization<dim>& fluid,
                          SolidSystem<dim>& solids) {
  Violations found;
  const auto surface = solids.snapshot();
  fluid.set_geometry(surface, coupling);
  fluid.begin_prediction();
  coupling.assemble(fluid, solids, *surface);
  if (coupling.coupling_transposed().is_null()) {
    expect_true(found, !solids.has_unknowns(),
                "coupling_transposed: null, though a solid is free to move");
    return found;
  }
  check_divergence(coupling, fluid, solids, found);
  check_exchange(coupling, fluid, solids, found);
  check_masses(coupling, fluid, solids, found);
  return found;
}

template Violations check_coupling(Coupling<2>&, FluidDiscretization<2>&, SolidSystem<2>&);
template Violations check_coupling(Coupling<3>&, FluidDiscretization<3>&, SolidSystem<3>&);

}  // namespace lockstep
