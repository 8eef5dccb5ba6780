#include "coupling/viscous_solve.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "coupling/viscous_couplings.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/vector_sums.hpp"
#include "solve/preconditioner.hpp"

namespace lockstep {
namespace {

/// The rows of the viscous system: free velocities, after them solid dofs.
struct ViscousRows {
  RCP<const Map> fluid, solid, all;  ///< `solid` null without unknowns

  ViscousRows(const RCP<const Map>& free_velocities, const RCP<const Map>& solid_dofs)
      : fluid(free_velocities), solid(solid_dofs) {
    const auto n_solid = solid.is_null() ? 0 : solid->getNodeNumElements();
    all = make_map(static_cast<int>(fluid->getNodeNumElements() + n_solid), fluid->getComm());
  }
  /// Parts of a vector on `all`, which share its values.
  RCP<const Vector> fluid_of(const Vector& x) const { return x.offsetView(fluid, 0)->getVector(0); }
  RCP<Vector> fluid_of(Vector& x) const {
    return x.offsetViewNonConst(fluid, 0)->getVectorNonConst(0);
  }
  RCP<const Vector> solid_of(const Vector& x) const {
    return x.offsetView(solid, fluid->getNodeNumElements())->getVector(0);
  }
  RCP<Vector> solid_of(Vector& x) const {
    return x.offsetViewNonConst(solid, fluid->getNodeNumElements())->getVectorNonConst(0);
  }
};

template <int dim>
struct ViscousOperator {
  const ViscousSystem<dim>& system;
  const ViscousCouplings<dim>& links;
  const RCP<const LinearOperator>& solid_block;
  const Reduction& constraints;
  double dt;
  ViscousRows rows;

  /// P y, without a copy where it is y.
  RCP<const Vector> expanded(const RCP<const Vector>& unknowns) const {
    if (!constraints.has_combinations())
      return unknowns;
    const auto velocity = rcp(new Vector(*unknowns, Teuchos::Copy));
    constraints.expand_change(*velocity);
    return velocity;
  }
  /// y = operator x; rows of dofs that are no unknowns see only their own C, and are zero. K_ff
  /// holds the links' diagonal already.
  void apply_to(const Vector& x, Vector& y) const {
    const RCP<const Vector> fluid = rows.fluid_of(x);
    const RCP<Vector> momentum = rows.fluid_of(y);
    momentum->elementWiseMultiply(1, *system.mass, *fluid, 0);
    system.stiffness->apply(*fluid, *momentum, Teuchos::NO_TRANS, dt, 1);
    if (rows.solid.is_null())
      return;
    const RCP<const Vector> unknowns = rows.solid_of(x);
    const RCP<const Vector> end_velocity = links.end_velocity(expanded(unknowns), false);
    links.take_from_fluid(dt, *end_velocity, true, *momentum);
    Vector drag(rows.solid);
    const RCP<Vector> pull = links.pull(*fluid, *end_velocity);
    links.add_couples(*end_velocity, *pull);
    links.pull_on_solids(-dt, *pull, 0, drag);
    const RCP<Vector> of_solid = rows.solid_of(y);
    lockstep::apply(*solid_block, *unknowns, *of_solid);
    constraints.restrict(drag);
    of_solid->update(1, drag, 1);
  }
};

/// M_f + dt K_ff.
template <int dim>
RCP<const CrsMatrix> fluid_matrix(const ViscousSystem<dim>& system, double dt) {
  const auto matrix = rcp(new CrsMatrix(*system.stiffness, Teuchos::Copy));
  matrix->resumeFill();
  matrix->scale(dt);
  const auto mass = system.mass->getData();
  for (int row = 0; row < mass.size(); ++row) {
    const GlobalIndex id = system.map->getGlobalElement(row);
    matrix->sumIntoGlobalValues(id, 1, &mass[row], &id);
  }
  matrix->fillComplete(system.map, system.map);
  return matrix;
}

/// 1 / diagonal of the operator (ones for a matrix-free C: few outliers, a Krylov method deals with
/// them).
template <int dim>
RCP<Vector> inverse_diagonal(const ViscousOperator<dim>& op) {
  const auto inverse = make_vector(op.rows.all);
  Vector diagonal(op.system.map);
  op.system.stiffness->getLocalDiagCopy(diagonal);
  diagonal.update(1, *op.system.mass, op.dt);
  op.rows.fluid_of(*inverse)->reciprocal(diagonal);
  if (op.rows.solid.is_null())
    return inverse;
  const RCP<Vector> solid_inverse = op.rows.solid_of(*inverse);
  solid_inverse->putScalar(1);
  const RCP<const CrsMatrix> matrix = assembled(op.solid_block);
  if (!matrix.is_null()) {
    const RCP<Vector> solid = diagonal_of(*matrix), drag = op.links.strength_on_solids();
    op.constraints.select(*drag);
    solid->update(op.dt, *drag, 1);
    const auto values = solid->getData();
    const bool is_positive =
        std::all_of(values.begin(), values.end(), [](double value) { return value > 0; });
    throw_on_all(op.rows.solid->getComm(),
                 is_positive ? "" : not_positive_definite("solid block of the viscous solve"),
                 static_cast<int>(ExitCode::solve_failed));
    solid_inverse->reciprocal(*solid);
  }
  return inverse;
}

/// The inverses that stand for blocks of the operator; null: the diagonal.
struct ViscousPreconditioner {
  const ViscousRows& rows;
  RCP<const Vector> inverse_diagonal;
  RCP<const LinearOperator> fluid, solid;

  void apply_to(const Vector& r, Vector& z) const {
    z.elementWiseMultiply(1, *inverse_diagonal, r, 0);
    if (!fluid.is_null())
      lockstep::apply(*fluid, *rows.fluid_of(r), *rows.fluid_of(z));
    if (!solid.is_null())
      lockstep::apply(*solid, *rows.solid_of(r), *rows.solid_of(z));
  }
};

template <int dim>
ViscousPreconditioner make_preconditioner(const ViscousOperator<dim>& op,
                                          const NearNullSpace& near_null_space,
                                          const ViscousOptions& options) {
  ViscousPreconditioner result{op.rows, inverse_diagonal<dim>(op), Teuchos::null, Teuchos::null};
  if (options.fluid_inverse.numParams() > 0)
    result.fluid =
        preconditioner_from_list(as_operator(fluid_matrix<dim>(op.system, op.dt)),
                                 options.fluid_inverse, "free velocities of the viscous solve");
  const std::string name = "solids, viscous solve";
  if (op.rows.solid.is_null())
    return result;
  result.solid =
      options.solid_inverse.numParams() > 0
          ? preconditioner_from_list(op.solid_block, options.solid_inverse, name, near_null_space)
          : inverse_if_stiff(op.solid_block, near_null_space, name);
  return result;
}

/// One pass of conjugate gradients from the guess x on: it ends where the residual that it carries
/// along, here that of x, has `target` in the norm of the preconditioner. Returns its iterations.
template <int dim>
int conjugate_gradient_pass(const ViscousOperator<dim>& op,
                            const ViscousPreconditioner& preconditioner, Vector& residual,
                            double target, int maximum_iterations, Vector& x) {
  Vector correction(op.rows.all);
  ConjugateGradientsRequest request{"The viscous solve", 0, maximum_iterations, {}};
  request.preconditioned_target = target;
  const int iterations =
      conjugate_gradients([&](const Vector& from, Vector& to) { op.apply_to(from, to); },
                          [&](const Vector& r, Vector& to) { preconditioner.apply_to(r, to); },
                          residual, correction, request);
  x.update(1, correction, 1);
  return iterations;
}

/// Conjugate gradients from the guess x on, until b - (M + dt K) x itself is as small as the
/// options ask, in the norm of the preconditioner; returns the iterations.
template <int dim>
int solve_from_guess(const ViscousOperator<dim>& op, const ViscousPreconditioner& preconditioner,
                     const Vector& rhs, Vector& x, const ViscousOptions& options) {
  Vector z(op.rows.all), residual(op.rows.all);
  const auto size_of = [&](const Vector& r) {
    preconditioner.apply_to(r, z);
    return std::sqrt(dot(r, z));
  };
  const double scale = size_of(rhs);
  if (scale == 0)
    return 0;
  const auto measure = [&] {
    op.apply_to(x, residual);
    residual.update(1, rhs, -1);
    return size_of(residual) / scale;
  };
  const double initial = measure();
  // A pass can do no better than round-off lets its residual agree with the true one; another one
  // starts from that.
  constexpr double worth_another = 0.5;
  double reached = initial, before = std::numeric_limits<double>::infinity();
  int iterations = 0;
  while (reached > options.tolerance && reached < worth_another * before &&
         iterations < options.maximum_iterations) {
    iterations +=
        conjugate_gradient_pass<dim>(op, preconditioner, residual, options.tolerance * scale,
                                     options.maximum_iterations - iterations, x);
    before = reached;
    reached = measure();
  }
  // As far as round-off allows: good enough if it is far below any other error of a step.
  constexpr double loosest_round_off = 1e-9;
  const double allowed = iterations < options.maximum_iterations
                             ? std::max(options.tolerance, loosest_round_off)
                             : options.tolerance;
  check_solve(
      reached <= allowed,
      "The viscous solve did not converge: {} iterations of conjugate gradients (at most {}) "
      "brought the relative residual from {:.2e} to {:.2e}, asked was {:.1e}. Raise "
      "\"Maximum Iterations\" of \"Viscous Solve\", name a stronger \"Fluid Inverse\" or "
      "\"Solid Inverse\" there, or reduce the time step or the viscosity.",
      iterations, options.maximum_iterations, initial, reached, options.tolerance);
  return iterations;
}

/// The quadratic form of K with all velocities, but for those of sides. `ends`: of links.
template <int dim>
double dissipation(const ViscousSystem<dim>& system, const ViscousCouplings<dim>& links,
                   const Vector& velocity, const Vector& ends, const Vector& couple_pull,
                   const Communicator& comm) {
  Vector pull(system.map);
  system.stiffness->apply(velocity, pull);
  pull.update(-1, *system.wall_force, 1);
  return dot(velocity, pull) + sum_all(comm, links.dissipation(velocity, ends, couple_pull));
}

/// Sets the right-hand side, in which prescribed solids and given dofs pull on resting fluid, and
/// the guess: the velocities before.
template <int dim>
void set_up_equation(const ViscousOperator<dim>& op, const SolidSystem<dim>& solids,
                     const RCP<const Vector>& lumped_momentum, Vector& rhs, Vector& guess) {
  const RCP<const Vector> given = op.links.end_velocity(op.constraints.offset(), true);
  const RCP<Vector> prescribed = op.links.pull(*make_vector(op.system.map), *given);
  const RCP<Vector> momentum = op.rows.fluid_of(rhs);
  momentum->elementWiseMultiply(1, *op.system.mass, *op.system.velocity, 0);
  momentum->update(op.dt, *op.system.wall_force, 1);
  op.links.take_from_fluid(op.dt, *prescribed, false, *momentum);
  op.rows.fluid_of(guess)->update(1, *op.system.velocity, 0);
  if (op.rows.solid.is_null())
    return;
  Vector pulled(*lumped_momentum, Teuchos::Copy);
  prescribed->update(1, *op.links.couple_pull(*given), 1);
  op.links.pull_on_solids(op.dt, *prescribed, 1, pulled);
  op.constraints.restrict(pulled);
  op.rows.solid_of(rhs)->update(1, pulled, 0);
  const RCP<Vector> before = solids.velocity();
  op.constraints.select(*before);
  op.rows.solid_of(guess)->update(1, *before, 0);
}

/// u = u* + M^-1 (impulses of the solution x): momentum is exact, the residual of CG shows in u
/// alone.
template <int dim>
Vector exact_velocity(const ViscousOperator<dim>& op, const Vector& rhs, const Vector& x) {
  Vector residual(op.rows.all);
  op.apply_to(x, residual);
  residual.update(1, rhs, -1);
  Vector velocity(*op.rows.fluid_of(x), Teuchos::Copy), mass_inverse(op.system.map);
  mass_inverse.reciprocal(*op.system.mass);
  velocity.elementWiseMultiply(1, mass_inverse, *op.rows.fluid_of(residual), 1);
  return velocity;
}

/// Velocities of all dofs in the solution x; null without unknowns.
template <int dim>
RCP<Vector> solid_velocity_of(const ViscousOperator<dim>& op, const SolidSystem<dim>& solids,
                              const Vector& x) {
  if (op.rows.solid.is_null())
    return solids.has_unknowns() ? solids.velocity() : RCP<Vector>();
  const auto velocity = rcp(new Vector(*op.rows.solid_of(x), Teuchos::Copy));
  op.constraints.expand(*velocity);
  return velocity;
}

/// Gives the fluid its velocity of the solution x, and returns what solids and sides get of it.
template <int dim>
ViscousResult<dim> accept_solution(const ViscousOperator<dim>& op, const ViscousParts<dim>& parts,
                                   bool with_dissipation, const Vector& rhs, const Vector& x) {
  const SolidSystem<dim>& solids = parts.solids;
  ViscousResult<dim> result;
  const RCP<const Vector> fluid_velocity = op.rows.fluid_of(x);
  result.solid_velocity = solid_velocity_of<dim>(op, solids, x);
  const RCP<const Vector> ends = op.links.end_velocity(result.solid_velocity, true);
  const RCP<const Vector> pull = op.links.pull(*fluid_velocity, *ends);
  const RCP<const Vector> couple_pull = op.links.couple_pull(*ends);
  if (solids.has_unknowns()) {
    result.solid_impulse = make_vector(solids.map());
    op.links.pull_on_solids(op.dt, *pull, 0, *result.solid_impulse);
    op.links.pull_on_solids(op.dt, *couple_pull, 1, *result.solid_impulse);
  }
  if (with_dissipation)
    result.dissipation =
        dissipation<dim>(op.system, op.links, *fluid_velocity, *ends, *couple_pull, solids.comm());
  result.boundary_impulse =
      parts.fluid.accept_viscous(*fluid_velocity, exact_velocity<dim>(op, rhs, x), op.dt);
  std::vector<Momentum<dim>> impulses(solids.solids().size());
  impulses.push_back(op.links.impulse(*pull, *couple_pull, op.dt, impulses));
  sum_over_ranks(solids.comm(), impulses);
  result.boundary_impulse += total_of(impulses);
  impulses.pop_back();
  result.prescribed_impulses = std::move(impulses);
  result.on_surface = op.links.impulses_on_solids(*pull, *couple_pull, op.dt);
  return result;
}

}  // namespace

template <int dim>
ViscousResult<dim> solve_viscous(const ViscousParts<dim>& parts, const ViscousRequest& request) {
  const auto& [system, fluid, solids, coupling, solid_block, near_null_space] = parts;
  // A solve for surface tension alone has no ties to solids, which then are no unknowns of it.
  const bool with_solids =
      solids.has_unknowns() &&
      sum_all(solids.comm(), static_cast<GlobalIndex>(system.links.size())) > 0;
  const ViscousCouplings<dim> links(system, solids, coupling, request.with_places);
  const ViscousOperator<dim> op{
      system,      links,
      solid_block, request.constraints,
      request.dt,  ViscousRows(system.map, with_solids ? solids.map() : RCP<const Map>())};
  Vector rhs(op.rows.all), x(op.rows.all);
  set_up_equation<dim>(op, solids, request.lumped_momentum, rhs, x);
  const int iterations = solve_from_guess<dim>(
      op, make_preconditioner<dim>(op, near_null_space, request.options), rhs, x, request.options);
  ViscousResult<dim> result = accept_solution<dim>(op, parts, request.with_dissipation, rhs, x);
  result.iterations = iterations;
  return result;
}

template ViscousResult<2> solve_viscous<2>(const ViscousParts<2>&, const ViscousRequest&);
template ViscousResult<3> solve_viscous<3>(const ViscousParts<3>&, const ViscousRequest&);

}  // namespace lockstep
