#include "conformance/fluid_conformance.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "conformance/bounds.hpp"
#include "conformance/through_checkpoint.hpp"
#include "interfaces/fluid_sides.hpp"
#include "interfaces/viscosity.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

namespace {

template <int dim>
double size(const Momentum<dim>& momentum) {
  return momentum.linear.norm() + momentum.angular.norm();
}

/// Size of the operator, by its action on a fixed vector.
double size(const LinearOperator& op, const RCP<const Map>& map) {
  const auto x = make_vector(map), y = make_vector(map);
  pseudo_random(*x, 1);
  apply(op, *x, *y);
  return y->norm2() / std::max(x->norm2(), 1e-300);
}

template <int dim>
void check_pressure_block(FluidDiscretization<dim>& fluid, Violations& found) {
  const auto map = fluid.pressure_map();
  const LinearOperator& block = *fluid.pressure_block();
  expect_small(found, symmetry_defect(block), round_off, "pressure_block: A is not symmetric");
  const auto x = make_vector(map), y = make_vector(map);
  pseudo_random(*x, 2);
  apply(block, *x, *y);
  const double scale = size(block, map);
  expect_true(found, x->dot(*y) >= -round_off * scale * x->dot(*x),
              "pressure_block: A is not positive semidefinite");

  const PressureRegions& regions = fluid.regions();
  const bool has_all = regions.of_unknown.size() == map->getNodeNumElements() &&
                       regions.has_dirichlet.size() == static_cast<std::size_t>(regions.n_regions);
  expect_true(found, sum_all(map->getComm(), has_all ? 0. : 1.) == 0,
              "regions: not one region for each pressure unknown, one flag for each region");
  for (int region = 0; has_all && region < regions.n_regions; ++region) {
    for (std::size_t k = 0; k < regions.of_unknown.size(); ++k)
      x->replaceLocalValue(static_cast<int>(k), regions.of_unknown[k] == region ? 1 : 0);
    apply(block, *x, *y);
    const double leak = y->norm2() / (scale * x->norm2());
    if (regions.has_dirichlet[region])
      expect_true(found, leak > round_off,
                  "regions: a level is fixed, says has_dirichlet, but A has it in its null space");
    else
      expect_small(found, leak, round_off,
                   "regions: A sees the level of a region without a fixed pressure");
  }
}

/// V G^T (u* - rho^-1 G p̂) = V G^T u* - A p̂, and what the free faces gain comes from the sides.
template <int dim>
void check_projection(FluidDiscretization<dim>& fluid, Violations& found) {
  const auto map = fluid.pressure_map();
  const auto before = make_vector(map), after = make_vector(map), pressure = make_vector(map);
  const auto* audited = fluid.audit();
  fluid.begin_prediction();
  const Momentum<dim> start = audited ? audited->momentum() : Momentum<dim>();
  fluid.divergence(*before);
  pseudo_random(*pressure, 3);
  fluid.project(*pressure);
  fluid.divergence(*after);
  apply(*fluid.pressure_block(), *pressure, *after, 1, 1);
  after->update(-1, *before, 1);
  const double scale = size(*fluid.pressure_block(), map) * pressure->norm2() + before->norm2();
  expect_small(found, after->norm2() / scale, round_off,
               "project: divergence and pressure_block disagree on what a pressure does");
  const double n_coupled =
      sum_all(map->getComm(), static_cast<double>(fluid.coupled_volumes().size()));
  if (n_coupled > 0 || !audited)
    return;
  Momentum<dim> gained = audited->momentum() - start;
  const Momentum<dim> given = audited->boundary_pressure_impulse(*pressure);
  const double impulse = size(gained) + size(given) + size(start);
  gained -= given;
  expect_small(found, size(gained) / std::max(impulse, 1e-300), round_off,
               "boundary_pressure_impulse: momentum changed by something else than the sides");
}

template <int dim>
void check_coupled_volumes(FluidDiscretization<dim>& fluid, Violations& found) {
  const auto map = fluid.pressure_map();
  double bad = 0, without_unknown = 0;
  for (const ControlVolume<dim>& volume : fluid.coupled_volumes()) {
    bad += !(volume.area > 0) || !(volume.open_fraction >= 0) || !(volume.open_fraction < 1) ||
           volume.box.isEmpty() || volume.direction < 0 || volume.direction >= dim ||
           volume.id == no_index;
    without_unknown += volume.sides[0].unknown == no_index && volume.sides[1].unknown == no_index;
  }
  const auto& comm = map->getComm();
  expect_true(found, sum_all(comm, bad) == 0,
              "coupled_volumes: an area, open fraction, box, direction or id that cannot be");
  expect_true(found, sum_all(comm, without_unknown) == 0,
              "coupled_volumes: one without a pressure on either side");

  fluid.begin_prediction();
  const std::vector<double> kept = fluid.coupled_velocity();
  std::vector<double> given(kept.size());
  for (std::size_t k = 0; k < given.size(); ++k)
    given[k] = std::sin(1. + static_cast<double>(k));
  fluid.set_coupled_velocity(given);
  const std::vector<double> now = fluid.coupled_velocity();
  bool same = now.size() == given.size();
  for (std::size_t k = 0; same && k < now.size(); ++k)
    same = now[k] == (fluid.coupled_volumes()[k].open_fraction == 0 ? given[k] : kept[k]);
  fluid.set_coupled_velocity(kept);
  expect_true(found, sum_all(comm, same ? 0. : 1.) == 0,
              "set_coupled_velocity: closed volumes must take it, partly open ones keep theirs");
}

template <int dim>
void check_forces(FluidDiscretization<dim>& fluid, Violations& found) {
  const auto* audited = fluid.audit();
  fluid.begin_prediction();
  const Momentum<dim> start = audited ? audited->momentum() : Momentum<dim>();
  const std::vector<double> before = fluid.coupled_velocity();
  const ForceImpulse<dim> forces = fluid.add_forces(0, dt);
  if (audited) {
    Momentum<dim> gained = audited->momentum() - start;
    gained -= forces.impulse;
    expect_small(found, size(gained) / std::max(size(forces.impulse) + size(start), 1e-300),
                 round_off,
                 "add_forces: momentum changed by something else than the impulse it returned");
  }
  const std::vector<double> after = fluid.coupled_velocity();
  double wrong = forces.coupled_change.size() == after.size() ? 0 : 1;
  for (std::size_t k = 0; wrong == 0 && k < after.size(); ++k) {
    const double change = forces.coupled_change[k];
    wrong = std::abs(after[k] - before[k] - change) >
                    round_off * (std::abs(after[k]) + std::abs(change))
                ? 1
                : 0;
  }
  expect_true(found, sum_all(fluid.pressure_map()->getComm(), wrong) == 0,
              "add_forces: coupled volumes changed by something else than it returned");
}

template <int dim>
void check_viscosity(FluidDiscretization<dim>& fluid, Violations& found) {
  const ViscousFluid<dim>* viscous = fluid.viscosity();
  if (!viscous)
    return;
  fluid.begin_prediction();
  const auto system = viscous->viscous_system();
  const auto& comm = fluid.pressure_map()->getComm();
  const auto x = make_vector(system->map), y = make_vector(system->map),
             z = make_vector(system->map);
  pseudo_random(*x, 4);
  pseudo_random(*z, 5);
  system->stiffness->apply(*x, *y);
  const double scale = y->norm2() * z->norm2(), xkz = y->dot(*z), xkx = y->dot(*x);
  system->stiffness->apply(*z, *y);
  expect_small(found, (xkz - y->dot(*x)) / std::max(scale, 1e-300), round_off,
               "viscous_system: K is not symmetric");
  expect_true(found, xkx >= -round_off * scale, "viscous_system: K is not positive semidefinite");
  double bad = 0;
  for (const double mass : system->mass->getData())
    bad += !(mass > 0);
  for (const ViscousCouplingTerm<dim>& link : system->links)
    bad += !(link.coefficient >= 0) || link.row < 0 ||
           link.row >= static_cast<int>(system->map->getNodeNumElements());
  expect_true(found, sum_all(comm, bad) == 0, "viscous_system: a mass or a link that cannot be");
}

/// Returns the part of u^n that the interface shows on this rank.
template <int dim>
std::vector<double> velocity_of(FluidDiscretization<dim>& fluid) {
  fluid.begin_prediction();
  const auto outflow = make_vector(fluid.pressure_map());
  fluid.divergence(*outflow);
  const auto mine = outflow->getData();
  std::vector<double> values(mine.begin(), mine.end());
  const std::vector<double> coupled = fluid.coupled_velocity();
  values.insert(values.end(), coupled.begin(), coupled.end());
  return values;
}

/// Before `accept` the velocity u^n stays what it was, and a run that is continued finds the fluid
/// as it was saved.
template <int dim>
void check_memory(FluidDiscretization<dim>& fluid,
                  const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                  const OpenFractionRule<dim>& rule, Violations& found) {
  const auto& comm = fluid.pressure_map()->getComm();
  const auto predict = [&] {
    fluid.begin_prediction();
    fluid.add_forces(0, dt);
    const auto pressure = make_vector(fluid.pressure_map());
    pseudo_random(*pressure, 6);
    fluid.project(*pressure);
  };
  const std::vector<double> before = velocity_of(fluid);
  const auto is_as_before = [&] {
    return sum_all(comm, velocity_of(fluid) == before ? 0. : 1.) == 0;
  };
  predict();
  expect_true(found, is_as_before(), "accept: the velocity changes before it is called");
  const auto step = [&] {
    predict();
    fluid.accept();
    expect_true(found, !is_as_before(), "accept: the velocity is as before");
  };
  load_what_was_saved(fluid, comm, step, found);
  fluid.set_geometry(surface, rule);
  expect_true(found, is_as_before(), "save, load: the velocity is not that which was saved");
}

/// Lengths and speeds that the size of a step comes from.
template <int dim>
void check_scales(const FluidDiscretization<dim>& fluid, Violations& found) {
  const double length = fluid.smallest_length(), speed = fluid.largest_speed(),
               volume = fluid.fluid_volume();
  expect_true(found, length > 0 && std::isfinite(length), "smallest_length: not a positive number");
  expect_true(found, speed >= 0 && std::isfinite(speed), "largest_speed: negative or not finite");
  expect_true(found, volume >= 0 && std::isfinite(volume),
              "the geometry's volume: negative or not finite");
  expect_true(found, fluid.suggested_step(1, 0) > 0, "suggested_step: not positive");
  expect_true(found, fluid.suggested_step(1, 2 * speed + 1) <= fluid.suggested_step(1, 0),
              "suggested_step: longer with a fast solid than without");
  if (const auto* audited = fluid.audit()) {
    const double energy = audited->kinetic_energy();
    expect_true(found, energy >= 0 && std::isfinite(energy),
                "kinetic_energy: negative or not finite");
  }
}

}  // namespace

template <int dim>
Violations check_fluid(FluidDiscretization<dim>& fluid,
                       const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                       const OpenFractionRule<dim>& rule) {
  Violations found;
  fluid.set_geometry(surface, rule);
  check_pressure_block(fluid, found);
  check_projection(fluid, found);
  check_coupled_volumes(fluid, found);
  check_forces(fluid, found);
  check_viscosity(fluid, found);
  check_scales(fluid, found);
  check_memory(fluid, surface, rule, found);
  return found;
}

template Violations check_fluid(FluidDiscretization<2>&,
                                const std::shared_ptr<const SurfaceSnapshot<2>>&,
                                const OpenFractionRule<2>&);
template Violations check_fluid(FluidDiscretization<3>&,
                                const std::shared_ptr<const SurfaceSnapshot<3>>&,
                                const OpenFractionRule<3>&);

}  // namespace lockstep
