#include "strategies/common/refined_strategy.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/null_space.hpp"
#include "linear/symmetry_check.hpp"
#include "linear/vector_sums.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

namespace {

/// The corrections aim below the tolerance, so that back-substitution and round-off fit in between.
constexpr double safety = 0.5;
/// A correction that gains less than this factor is no progress; two of them in a row end the
/// solve.
constexpr double least_progress = 0.5;
/// A strategy that iterates on C within every iteration aims at this reduction of r_1 and starts
/// afresh: what C^-1 is asked for then is relative to what is left of an error, not to the
/// solution. V_S is taken along to these parts of r_2, and to round-off in the end.
constexpr double of_a_stage = 1e-2, of_stage_velocity = 1e-3, of_first_velocity = 1e-5;
/// Strongest reduction of the residual by a Krylov method with short recurrences before the
/// round-off of an inverse of A in single precision, 1e-7 of the first vectors, is felt [1].
constexpr double strongest_single_reduction = 1e-5;
/// Tolerance of C^-1 where only a size is asked for [1].
constexpr double rough = 1e-3;

struct Refinement {
  int n_corrections = 0, n_stalls = 0, n_iterations = 0;
  double initial_pressure = 0, initial_solid = 0;
};

std::string what_to_try(const Refinement& done, const BlockResidual& residual, double tolerance,
                        int maximum_iterations) {
  if (residual.relative_solid() > tolerance)
    return "The rows of the solids do not hold: their block is singular to round-off. A node "
           "without "
           "mass that no mixed face sees needs a stiffness or damping that is implicit: give its "
           "body a mass, bending stiffness or a coarser mesh";
  if (done.n_iterations >= maximum_iterations)
    return fmt::format(
        "\"Maximum Iterations\" is {}: raise it, or choose a stronger \"Pressure Inverse\"",
        maximum_iterations);
  return "The corrections make no progress: the tolerance is below what round-off allows, the null "
         "vectors are incomplete, or a preconditioner is not symmetric (set \"Check Preconditioner "
         "Symmetry\")";
}

[[noreturn]] void give_up(const std::string& name, const BlockSystem& system,
                          const BlockResidual& residual, const Refinement& done, double tolerance,
                          int maximum_iterations) {
  throw SolveError(fmt::format(
      "{} did not converge in {} iterations: pressure residual {:.2e} (initially {:.2e}), solid "
      "residual {:.2e} (initially {:.2e}), required {:.2e} of each block's scale{}. {}.",
      name, done.n_iterations, residual.relative_pressure(), done.initial_pressure,
      residual.relative_solid(), done.initial_solid, tolerance,
      system.has_solid() ? by_name(system.solids, *residual.vector.solid, residual.solid_scale)
                         : "",
      what_to_try(done, residual, tolerance, maximum_iterations)));
}

void check_finite(const std::string& name, const BlockResidual& residual) {
  check_solve(std::isfinite(residual.norm()),
              "{}: the residual is not finite. Some block, right-hand side or initial guess holds "
              "infinities or NaN.",
              name);
}

/// Null components of the residual cannot be solved away: small ones are round-off and ignored.
void check_compatible(const std::string& name, double removed, const BlockResidual& residual,
                      double tolerance) {
  check_solve(removed <= tolerance * residual.pressure_scale,
              "{}: the right-hand side is not compatible with the null space of the system (part "
              "{:.2e} of it, allowed {:.2e}). Project it first: fluid in a closed region cannot "
              "change its volume.",
              name, removed / residual.pressure_scale, tolerance);
}

/// V_S -= C^-1 r_2, which leaves `reduction` of r_2 or round-off, whichever is more; nothing
/// without a solid.
void back_substitute(const BlockSystem& system, const BlockVector& rhs, const SolidInverse& inverse,
                     double reduction, BlockVector& solution) {
  if (!system.has_solid())
    return;
  constexpr double round_off = 1e-14, loosest = 1e-2;
  const SolidResidual row = solid_row_residual(system, rhs, solution);
  const double size = norm(*row.vector);
  if (size == 0)
    return;
  Vector change(row.vector->getMap());
  apply(*inverse.to(std::min(loosest, std::max(reduction, round_off * row.scale / size))),
        *row.vector, change);
  solution.solid->update(-1, change, 1);
}

/// The norm of B C^-1, by a few steps of the power method.
double operator_norm(const CrsMatrix& coupling_transposed, const LinearOperator& solid_inverse) {
  constexpr int n_steps = 4;
  Vector force(coupling_transposed.getRangeMap()), velocity(force.getMap()), back(force.getMap());
  Vector pressure(coupling_transposed.getDomainMap());
  pseudo_random(force, 1);
  double result = 0;
  for (int step = 0; step < n_steps; ++step) {
    const double force_norm = force.norm2();
    if (force_norm == 0)
      break;
    force.scale(1 / force_norm);
    apply(solid_inverse, force, velocity);
    coupling_transposed.apply(velocity, pressure, Teuchos::TRANS);
    coupling_transposed.apply(pressure, back);
    result = std::sqrt(velocity.dot(back));  // |B C^-1 f|
    apply(solid_inverse, back, force);
  }
  return result;
}

}  // namespace

int RefinedStrategy::pressure_cg(const BlockSystem& system, const CorrectionRequest& request,
                                 Vector& correction) const {
  const ConjugateGradientsRequest cg{request.name, request.target, request.maximum_iterations,
                                     iteration_null_space(system), request.update_target};
  if (layout_)
    return conjugate_gradients(layout_->kernels(), *request.residual, correction, cg);
  return conjugate_gradients(
      [&](const Vector& x, Vector& y) { apply(*system.pressure_block(), x, y); },
      [&](const Vector& x, Vector& y) { apply(*pressure_inverse_, x, y); }, *request.residual,
      correction, cg);
}

namespace {
/// A solid may fill the whole domain; V_S is back-substituted, and there is no more to do.
bool has_pressures(const BlockSystem& system) {
  return domain_map(*system.pressure_block())->getGlobalNumElements() > 0;
}
}  // namespace

bool RefinedStrategy::geometry_matches(const BlockSystem& system) const {
  return is_prepared_ && prepared_.geometry_version == system.geometry_version &&
         prepared_.system_name == system.name &&
         prepared_.pressure_map->isSameAs(*domain_map(*system.pressure_block()));
}

bool RefinedStrategy::solid_matches(const BlockSystem& system) const {
  return !system.has_solid() ||
         (solid_.is_built() && prepared_.solid_version == system.solids.version &&
          prepared_.solid_map->isSameAs(*domain_map(*system.solid_block())));
}

RefinedStrategy::RefinedStrategy(const Teuchos::ParameterList& list,
                                 std::optional<Teuchos::ParameterList> pressure_list,
                                 PressureOrder order)
    : maximum_iterations_(list.get<int>("Maximum Iterations")),
      check_symmetry_(list.get<bool>("Check Preconditioner Symmetry")),
      order_(order),
      solid_(list),
      pressure_list_(std::move(pressure_list)) {}

const NullSpace& RefinedStrategy::iteration_null_space(const BlockSystem& system) const {
  static const NullSpace none;
  return layout_ ? none : system.null_space;
}

void RefinedStrategy::build_pressure_inverse(const BlockSystem& system) {
  is_single_precision_ = is_multigrid(*pressure_list_, system);
  if (!is_single_precision_) {
    layout_.reset();
    pressure_inverse_ = lockstep::pressure_inverse(system, *pressure_list_);
  } else if (order_ == PressureOrder::of_the_fluid) {
    pressure_inverse_ = multigrid_in_fluid_order(system, multigrid_options(*pressure_list_));
  } else {
    layout_ = PressureLayout::make(system, multigrid_options(*pressure_list_), layout_);
    pressure_inverse_ = layout_->inverse();
  }
  if (check_symmetry_)
    check_symmetric_positive(*pressure_inverse_, "pressure block of the " + system.name,
                             symmetry_tolerance());
}

/// C stands in for A in the rows that A leaves empty. Without this a solve would depend on which C
/// the geometry was first seen with, and a restarted run not equal the straight one.
bool RefinedStrategy::update_pressure_inverse(const BlockSystem& system) {
  if (layout_) {
    const bool is_another = layout_->update_empty_rows(system);
    pressure_inverse_ = layout_->inverse();
    return is_another;
  }
  if (!leaves_rows_empty(system.pressure_block()))
    return false;
  build_pressure_inverse(system);
  return true;
}

BlockKrylovRequest RefinedStrategy::block_krylov(const BlockSystem& system,
                                                 const CorrectionRequest& request,
                                                 Presumes presumes) {
  if (solid_norm_ < 0) {
    // Set-up, which a restarted run does in another solve than the straight one.
    const int counted = solid_.take_iterations();
    solid_norm_ = operator_norm(*system.coupling_transposed(), *solid_.to(rough));
    solid_.restart_count(counted);
  }
  // No residual can be asked below the round-off of row 2; the next correction takes the rest.
  const double solid_target = std::max(
      solid_norm_ > 0 ? request.target / solid_norm_ : request.target, request.solid_round_off);
  const double least = presumes == Presumes::symmetry && is_single_precision_
                           ? strongest_single_reduction * request.residual_norm
                           : 0;
  const double relief = std::max(1.0, least / request.target);
  return {request.name, relief * request.target, relief * solid_target, request.maximum_iterations};
}

void RefinedStrategy::relay(const BlockSystem& system) {
  BlockSystem& permuted = system.has_solid() ? permuted_ : permuted_pressure_;
  if (permuted.op().is_null()) {
    permuted = layout_->permuted(system);
    return;
  }
  // Another C on the same geometry.
  permuted.set_blocks(permuted.pressure_block(), permuted.coupling_transposed(),
                      system.solid_block());
  permuted.solids = system.solids;
  permuted.near_null_space = system.near_null_space;
}

bool RefinedStrategy::is_ready(const BlockSystem& system) const {
  const bool is_permuted = !layout_ || !working(system).op().is_null();
  return geometry_matches(system) && solid_matches(system) && is_permuted &&
         (!has_pressures(system) || is_built_for(working(system)));
}

void RefinedStrategy::prepare(const BlockSystem& system) {
  const double start = Teuchos::Time::wallTime();
  if (is_ready(system)) {
    ++n_reuses_;
    return;
  }
  const bool geometry_changed = !geometry_matches(system);
  const bool solid_changed = system.has_solid() && (geometry_changed || !solid_matches(system));
  is_prepared_ = false;
  if (geometry_changed) {
    solid_.reset();
    permuted_ = permuted_pressure_ = {};
    layout_ = has_pressures(system) ? layout_ : nullptr;
    if (pressure_list_ && has_pressures(system))
      build_pressure_inverse(system);
  }
  const bool inverse_changed =
      geometry_changed ||
      (solid_changed && pressure_list_ && has_pressures(system) && update_pressure_inverse(system));
  if (solid_changed) {
    solid_.build(system);
    solid_norm_ = -1;
  }
  if (layout_) {
    relay(system);
    if (inverts_schur() && system.has_solid() && (solid_changed || !layout_->has_schur_inverse()))
      layout_->build_schur_inverse(system, *solid_.to(rough));
  }
  if (has_pressures(system))
    build(working(system), inverse_changed, solid_changed);
  solid_.restart_count(0);
  prepared_.system_name = system.name;
  prepared_.geometry_version = system.geometry_version;
  prepared_.pressure_map = domain_map(*system.pressure_block());
  if (system.has_solid()) {
    prepared_.solid_version = system.solids.version;
    prepared_.solid_map = domain_map(*system.solid_block());
  }
  is_prepared_ = true;
  ++n_builds_;
  setup_seconds_ += Teuchos::Time::wallTime() - start;
}

std::string RefinedStrategy::inverses() const {
  std::string text;
  if (pressure_list_)
    text = "A: " + inverse_type(*pressure_list_, is_single_precision_);
  if (solid_.is_built())
    text += (text.empty() ? "C: " : "; C: ") + solid_.description();
  return text;
}

SolveReport RefinedStrategy::solve(const BlockSystem& system, const BlockVector& rhs,
                                   BlockVector& solution, const SolveRequest& request) {
  if (!is_ready(system))
    prepare(system);
  if (!layout_)
    return refine(system, rhs, solution, request);
  constexpr bool zero_out = false;  // to_layout sets all entries
  const BlockVector b{rcp(new Vector(layout_->map(), zero_out)), rhs.solid};
  BlockVector x{rcp(new Vector(layout_->map(), zero_out)), solution.solid};
  layout_->to_layout(*rhs.pressure, *b.pressure);
  layout_->to_layout(*solution.pressure, *x.pressure);
  const SolveReport report = refine(working(system), b, x, request);
  layout_->from_layout(*x.pressure, *solution.pressure);
  return report;
}

SolveReport RefinedStrategy::refine(const BlockSystem& system, const BlockVector& rhs,
                                    BlockVector& solution, const SolveRequest& request) {
  const double start = Teuchos::Time::wallTime();
  const std::string name =
      fmt::format("Solve {} of the {} by {}", request.name, system.name, this->name());
  Vector correction(rhs.pressure->getMap());
  Refinement done;
  BlockResidual residual;
  double previous = 0;
  project_out(system.null_space, *solution.pressure);
  if (system.has_solid())
    solution.solid->putScalar(0);
  const bool in_stages = system.has_solid() && works_in_stages();
  double reduction = in_stages ? of_first_velocity : 0;
  constexpr double of_a_scale = 1e-3;
  const std::function<double(const Vector&)> update_target = [&](const Vector& x) {
    BlockVector corrected{rcp(new Vector(*solution.pressure, Teuchos::Copy)), Teuchos::null};
    corrected.pressure->update(1, x, 1);
    if (system.has_solid())
      corrected.solid = rcp(new Vector(*solution.solid, Teuchos::Copy));
    back_substitute(system, rhs, solid_, of_a_scale, corrected);
    return safety *
           std::max(request.tolerance * block_residual(system, rhs, corrected).pressure_scale,
                    request.negligible_pressure_residual);
  };
  const std::function<double(const Vector&)> no_update;
  const double rhs_norm = norm(*rhs.pressure);
  while (true) {
    back_substitute(system, rhs, solid_, reduction, solution);
    find_block_residual(system, rhs, solution, residual);
    check_finite(name, residual);
    const double removed = project_out(system.null_space, *residual.vector.pressure);
    if (done.n_corrections == 0) {
      done.initial_pressure = residual.relative_pressure();
      done.initial_solid = residual.relative_solid();
    }
    const double solvable = removed > 0 ? norm(*residual.vector.pressure) : residual.pressure;
    const double target =
        std::max(request.tolerance * residual.pressure_scale, request.negligible_pressure_residual);
    if (reduction > 0 && std::min(solvable, residual.pressure) <= target) {
      reduction = 0;  // V_S to round-off, and another look
      continue;
    }
    if (residual.pressure <= target)
      break;
    // The scale of any solution is at least |rhs|: near that nothing need be asked again.
    const bool is_settled = residual.pressure_scale <= 1.5 * rhs_norm;
    if (solvable <= target || done.n_stalls > 1)
      check_compatible(name, removed, residual, request.tolerance);
    if (done.n_corrections > 0 && solvable > least_progress * previous)
      ++done.n_stalls;
    else
      done.n_stalls = 0;
    if (done.n_stalls > 1 || done.n_iterations >= maximum_iterations_)
      give_up(name, system, residual, done, request.tolerance, maximum_iterations_);
    previous = solvable;
    const double aim = is_settled ? safety * target / 1.5 : safety * target;
    const bool is_stage = in_stages && aim < of_a_stage * solvable;
    reduction = is_stage ? of_stage_velocity : 0;
    done.n_iterations += correct(
        system,
        {name, residual.vector.pressure.get(), solvable, is_stage ? of_a_stage * solvable : aim,
         1e-15 * residual.solid_scale, maximum_iterations_ - done.n_iterations,
         is_settled || is_stage ? no_update : update_target},
        correction);
    project_out(system.null_space, correction);
    solution.pressure->update(1, correction, 1);
    ++done.n_corrections;
  }
  if (residual.relative_solid() > request.tolerance)
    give_up(name, system, residual, done, request.tolerance, maximum_iterations_);

  SolveReport report;
  report.iterations = done.n_iterations;
  report.solid_iterations = solid_.take_iterations();
  report.pressure_residual = residual.relative_pressure();
  report.solid_residual = residual.relative_solid();
  report.solve_seconds = Teuchos::Time::wallTime() - start;
  report.setup_seconds = std::exchange(setup_seconds_, 0);
  report.preconditioner_builds = std::exchange(n_builds_, 0);
  report.preconditioner_reuses = std::exchange(n_reuses_, 0);
  report.stored_nonzeros = stored_nonzeros();
  return report;
}

}  // namespace lockstep
