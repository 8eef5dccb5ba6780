#include "conformance/solid_conformance.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <set>

#include "conformance/bounds.hpp"
#include "conformance/through_checkpoint.hpp"
#include "interfaces/solid_sides.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

namespace {

constexpr double brief = 1e-7;  // [s], of motions that are taken to be straight

/// A vector by global id on every rank.
std::vector<double> everywhere(const Vector& vector) {
  const auto map = vector.getMap();
  const auto n = static_cast<GlobalIndex>(map->getGlobalNumElements());
  std::vector<double> values(n, 0);
  const auto mine = vector.getData();
  for (std::size_t k = 0; k < map->getNodeNumElements(); ++k)
    values[map->getGlobalElement(static_cast<int>(k)) - map->getMinAllGlobalIndex()] = mine[k];
  sum_over_ranks(map->getComm(), values);
  return values;
}

template <int dim>
Point<dim> center_of(const SurfaceMesh<dim>& mesh, int simplex) {
  Point<dim> sum = Point<dim>::Zero();
  for (const int vertex : mesh.simplices[simplex])
    sum += mesh.vertices[vertex];
  return sum / dim;
}

template <int dim>
void check_descriptions(const SolidModel<dim>& model, Violations& found) {
  const SurfaceMesh<dim>& mesh = model.surface();
  const int n_vertices = static_cast<int>(mesh.vertices.size());
  bool vertices_are_there = true;
  for (const auto& simplex : mesh.simplices)
    for (const int vertex : simplex)
      vertices_are_there = vertices_are_there && vertex >= 0 && vertex < n_vertices;
  expect_true(found, vertices_are_there, "surface: a simplex names a vertex that is not there");
  int next = 0;
  std::set<std::string> names;
  for (const SolidDescription& solid : model.solids()) {
    expect_true(found, !solid.name.empty() && names.insert(solid.name).second,
                "solids: a name is empty or is there twice: \"" + solid.name + "\"");
    expect_true(
        found, solid.simplex_begin == next && solid.simplex_end >= next,
        "solids: the simplices of \"" + solid.name + "\" do not follow those of the one before");
    next = solid.simplex_end;
  }
  expect_true(found, next == static_cast<int>(mesh.simplices.size()),
              "solids: some simplices belong to no solid");
  expect_true(found, model.states().size() == model.solids().size(),
              "states: not one for each solid");
}

template <int dim>
void check_operators(const SolidModel<dim>& model, Violations& found) {
  const auto map = model.dof_map();
  if (map->getGlobalNumElements() == 0)
    return;
  const auto x = make_vector(map), y = make_vector(map);
  pseudo_random(*x, 1);
  expect_small(found, symmetry_defect(*model.mass()), round_off, "mass: M_S is not symmetric");
  apply(*model.mass(), *x, *y);
  expect_true(found, x->dot(*y) > 0, "mass: M_S is not positive definite");
  const auto force = model.implicit_force(dt);
  if (force.is_null())
    return;
  apply(*force, *x, *y);
  if (y->norm2() == 0)
    return;  // nothing to be unsymmetric
  expect_small(found, symmetry_defect(*force), round_off, "implicit_force: D is not symmetric");
  expect_true(found, x->dot(*y) <= round_off * x->norm2() * y->norm2(),
              "implicit_force: D is not negative semidefinite");
}

/// Sets all dofs in motion but those that are held. What this gives, `velocity` must return.
template <int dim>
void set_in_motion(SolidModel<dim>& model, int seed, Violations& found) {
  const auto given = make_vector(model.dof_map());
  pseudo_random(*given, seed);
  for (const GlobalIndex dof : model.locked_dofs())
    if (given->getMap()->isNodeGlobalElement(dof))
      given->replaceGlobalValue(dof, 0);
  model.set_velocity(*given);
  const double size = given->normInf();
  given->update(-1, *model.velocity(), 1);
  expect_small(found, given->normInf(), round_off * size,
               "set_velocity: `velocity` returns another one [m/s, rad/s]");
}

/// Momentum and energy by M_S V_S and as the states report them.
template <int dim>
void check_momentum(const SolidModel<dim>& model, Violations& found) {
  const auto momentum = make_vector(model.dof_map());
  apply(*model.mass(), *model.velocity(), *momentum);
  const auto states = model.states();
  double kinetic = 0;
  for (std::size_t s = 0; s < states.size(); ++s)
    if (!model.solids()[s].prescribed)
      kinetic += states[s].kinetic_energy;
  const double by_mass = momentum->dot(*model.velocity()) / 2;
  expect_small(found, (kinetic - by_mass) / std::max(by_mass, 1e-300), 1e-9,
               "states: kinetic energies are not V_S M_S V_S / 2");
  const auto* audited = model.audit();
  if (!audited)
    return;
  const auto each = audited->momentum_of_each(*momentum);
  expect_true(found, each.size() == states.size(), "momentum_of_each: not one for each solid");
  double difference = 0, scale = 0;
  for (std::size_t s = 0; s < std::min(each.size(), states.size()); ++s) {
    if (model.solids()[s].prescribed)
      continue;
    difference += (each[s].linear - states[s].mass * states[s].velocity).norm();
    scale += each[s].linear.norm() + states[s].mass * states[s].velocity.norm();
  }
  expect_small(found, difference / std::max(scale, 1e-300), 1e-9,
               "momentum_of_each: not mass times velocity of the states");
}

/// Inner forces add up to nothing, so what explicit_momentum changes is the external impulse.
template <int dim>
void check_impulses(const SolidModel<dim>& model, Violations& found) {
  const auto* audited = model.audit();
  if (!audited)
    return;
  const auto before = make_vector(model.dof_map()), after = make_vector(model.dof_map());
  apply(*model.mass(), *model.velocity(), *before);
  model.explicit_momentum(0, dt, *after);
  const auto start = total_of(audited->momentum_of_each(*before)),
             end = total_of(audited->momentum_of_each(*after));
  const Momentum<dim> external = audited->external_impulse(0, dt);
  const double scale = start.linear.norm() + end.linear.norm() + external.linear.norm();
  expect_small(found,
               (end.linear - start.linear - external.linear).norm() / std::max(scale, 1e-300), 1e-9,
               "external_impulse: not what explicit_momentum gives all solids together");
}

template <int dim>
void check_locks(SolidModel<dim>& model, Violations& found) {
  model.begin_step(0, dt);
  const auto locked = model.locked_dofs();
  double bad = model.locked_velocities(0, dt).size() == locked.size() ? 0 : 1;
  for (const GlobalIndex dof : locked)
    bad += !model.dof_map()->isNodeGlobalElement(dof);
  expect_true(found, sum_all(model.dof_map()->getComm(), bad) == 0,
              "locked_dofs: one that this rank does not own, or not one velocity for each");
}

/// The velocity that the rows give a point of the surface, the way that `move` takes it, and what
/// `effective_velocity` says afterwards are one and the same.
template <int dim>
void check_motion(SolidModel<dim>& model, Violations& found) {
  const SurfaceMesh<dim> start = model.surface();
  const std::vector<double> dofs = everywhere(*model.velocity());
  const GlobalIndex first = dofs.empty() ? 0 : model.dof_map()->getMinAllGlobalIndex();
  const RCP<Vector> velocity = make_vector(model.dof_map());
  velocity->update(1, *model.velocity(), 0);
  std::vector<Point<dim>> promised;
  double fastest = 0;
  bool rows_fit = true;
  VelocityRow<dim> row;
  for (const SolidDescription& solid : model.solids()) {
    for (int simplex = solid.simplex_begin; simplex < solid.simplex_end; ++simplex) {
      const Point<dim> x = center_of(start, simplex);
      const SurfacePoint<dim> point{simplex, Barycentric<dim>::Constant(1. / dim), x};
      model.velocity_row(point, x, row);
      rows_fit = rows_fit && row.dofs.size() == row.coefficients.size() &&
                 row.dofs.empty() == solid.prescribed;
      Point<dim> v = model.prescribed_velocity(point, x);
      rows_fit = rows_fit && (solid.prescribed || v.isZero());
      for (std::size_t k = 0; k < row.dofs.size(); ++k)
        v += dofs.at(row.dofs[k] - first) * row.coefficients[k];
      promised.push_back(v);
      fastest = std::max(fastest, v.norm());
    }
  }
  expect_true(found, rows_fit,
              "velocity_row, prescribed_velocity: of prescribed solids the one, of others the "
              "other must be empty");
  model.move(*velocity, 0, brief);
  double by_rows = 0, by_effective = 0;
  for (std::size_t s = 0; s < promised.size(); ++s) {
    const int simplex = static_cast<int>(s);
    const Point<dim> x = center_of(start, simplex);
    const Point<dim> moved = (center_of(model.surface(), simplex) - x) / brief;
    const SurfacePoint<dim> point{simplex, Barycentric<dim>::Constant(1. / dim), x};
    by_rows = std::max(by_rows, (moved - promised[s]).norm());
    by_effective = std::max(by_effective, (moved - model.effective_velocity(point, x)).norm());
  }
  const auto n_dofs = static_cast<double>(model.dof_map()->getGlobalNumElements());
  const double n_locked =
      sum_all(model.dof_map()->getComm(), static_cast<double>(model.locked_dofs().size()));
  expect_true(found, promised.empty() || n_locked == n_dofs || fastest > 0,
              "velocity_row: no point of the surface moves, whatever the velocities");
  const double bound = 1e-4 * fastest + 1e-6;
  expect_small(found, by_rows, bound, "velocity_row: a point of the surface moves otherwise [m/s]");
  expect_small(found, by_effective, bound, "effective_velocity: not displacement over dt [m/s]");
}

/// All that a solid carries from step to step: places, velocities, what its states tell of them.
template <int dim>
std::vector<double> state_of(const SolidModel<dim>& model) {
  std::vector<double> values = everywhere(*model.velocity());
  const auto add = [&values](const auto& vector) {
    values.insert(values.end(), vector.data(), vector.data() + vector.size());
  };
  for (const Point<dim>& vertex : model.surface().vertices)
    add(vertex);
  for (const SolidState<dim>& state : model.states()) {
    add(state.center_of_mass);
    add(state.velocity);
    add(state.angular_velocity);
  }
  return values;
}

/// A run that is continued finds the solids as they were saved.
template <int dim>
void check_memory(SolidModel<dim>& model, Violations& found) {
  const auto step = [&] {
    const RCP<Vector> velocity = make_vector(model.dof_map());
    velocity->update(1, *model.velocity(), 0);
    model.move(*velocity, 0, dt);
    set_in_motion(model, 8, found);
  };
  const std::vector<double> before = state_of(model);
  load_what_was_saved(model, model.dof_map()->getComm(), step, found);
  expect_true(found, state_of(model) == before,
              "save, load: places and velocities are not those that were saved");
}

}  // namespace

template <int dim>
Violations check_solid(SolidModel<dim>& model) {
  Violations found;
  check_descriptions(model, found);
  check_operators(model, found);
  model.begin_step(0, dt);
  set_in_motion(model, 7, found);
  check_momentum(model, found);
  check_impulses(model, found);
  check_locks(model, found);
  check_motion(model, found);
  check_memory(model, found);
  return found;
}

template Violations check_solid(SolidModel<2>&);
template Violations check_solid(SolidModel<3>&);

}  // namespace lockstep
