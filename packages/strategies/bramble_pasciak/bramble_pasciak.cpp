#include "strategies/bramble_pasciak/bramble_pasciak.hpp"

#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "linear/extreme_ritz_values.hpp"
#include "linear/null_space.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_schur.hpp"

namespace lockstep {

namespace {

/// Lanczos steps for the smallest eigenvalue of M A, and the part of it that is taken, since the
/// estimate lies above it; where that is not enough, so much less, so many times.
constexpr int n_lanczos_steps = 15;
constexpr double margin = 0.8, retreat = 0.5;
constexpr int most_retreats = 6;
/// What the residual must have been reduced by for a restart to be worth it.
constexpr double restart_gain = 0.1;
/// Iterations without a residual smaller by this factor end a descent.
constexpr int patience = 8;
constexpr double least_gain = 0.8;

/// (p̂, V_S).
struct Pair {
  Vector pressure, solid;

  explicit Pair(const CrsMatrix& coupling)
      : pressure(coupling.getDomainMap()), solid(coupling.getRangeMap()) {}
  void update(double alpha, const Pair& other, double beta) {
    pressure.update(alpha, other.pressure, beta);
    solid.update(alpha, other.solid, beta);
  }
};

}  // namespace

ParameterList BramblePasciak::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  declare_positive(list, "Largest Solid", 60,
                   "With more solid unknowns C takes the place of their Schur complement");
  return list;
}

BramblePasciak::BramblePasciak(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")),
      largest_solid_(with_defaults(given, valid_parameters()).get<int>("Largest Solid")) {}

void BramblePasciak::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  refuse_region_closed_by_solid(system);
  const RitzValues ritz = extreme_ritz_values(
      [&](const Vector& x, Vector& y) { apply(*system.pressure.op, x, y); },
      [&](const Vector& r, Vector& z) { apply(*pressure_inverse(), r, z); },
      system.coupling_transposed->getDomainMap(), system.null_space, n_lanczos_steps);
  scale_below(system, margin * ritz.smallest);
}

void BramblePasciak::scale_below(const BlockSystem& system, double smallest) {
  smallest_ = smallest;
  scaled_inverse_ = Thyra::scale<double>(1 / smallest, pressure_inverse());
  solid_schur_inverse_ =
      system.solids.op->domain()->dim() <= largest_solid_
          ? SolidSchur::make(system, scaled_inverse_, largest_solid_, name())->inverse()
          : solid_inverse();
}

int BramblePasciak::correct(const BlockSystem& system, const CorrectionRequest& request,
                            Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  for (int retreats = 0; retreats <= most_retreats; ++retreats) {
    if (const std::optional<int> n_iterations = descend(system, request, correction))
      return *n_iterations;
    scale_below(system, retreat * smallest_);
  }
  throw SolveError(fmt::format(
      "{}: A - A_0 is not positive definite: the estimate of the smallest eigenvalue of the "
      "preconditioned A is too high, even {:.0f} times lower. Choose another \"Pressure Inverse\".",
      request.name, std::pow(retreat, -most_retreats)));
}

std::optional<int> BramblePasciak::descend(const BlockSystem& system,
                                           const CorrectionRequest& request, Vector& correction) {
  const CrsMatrix& coupling = *system.coupling_transposed;
  Pair x(coupling), r(coupling), z(coupling), d(coupling), q(coupling);
  Vector below(coupling.getRangeMap());
  // Kept by recurrence: z_1 = A_0^-1 r_1, and A d_1. An iteration applies A and A_0^-1 once.
  Vector a_z(correction.getMap()), a_d(correction.getMap()), q_1(correction.getMap());
  const auto precondition_pressure = [&](const Vector& from, Vector& to) {
    apply(*scaled_inverse_, from, to);
    project_out(system.null_space, to);
  };
  r.pressure.update(1, *request.residual, 0);
  precondition_pressure(r.pressure, z.pressure);

  const BlockKrylovRequest goal = block_krylov(system, request, Presumes::symmetry);
  double z_dot_z = 0, smallest = request.residual_norm;
  int n_iterations = 0, last_gain = 0;
  for (; n_iterations < request.maximum_iterations; ++n_iterations) {
    const double norm = r.pressure.norm2();
    if (norm <= goal.target && r.solid.norm2() <= goal.solid_target)
      break;
    // Rounding of A_0^-1 can end the descent before its goal: start anew from the true residual.
    if (norm < least_gain * smallest) {
      smallest = norm;
      last_gain = n_iterations;
    }
    if (n_iterations - last_gain >= patience && norm < restart_gain * request.residual_norm)
      break;
    const double previous = z_dot_z;
    // z = [A_0, 0; -B^T, -S_0]^-1 r, and <z, z>_H.
    below.update(-1, r.solid, 0);
    coupling.apply(z.pressure, below, Teuchos::NO_TRANS, -1, 1);
    apply(*solid_schur_inverse_, below, z.solid);
    apply(*system.pressure.op, z.pressure, a_z);
    z_dot_z = z.pressure.dot(a_z) - z.pressure.dot(r.pressure) + z.solid.dot(below);
    // Near the round-off of A_0^-1, which may be that of single precision, the difference of two
    // nearly equal energies loses its sign: start anew from the true residual.
    if (n_iterations > 0 && !(z_dot_z > 0) && norm < restart_gain * request.residual_norm)
      break;
    if (!(z_dot_z > 0))
      return std::nullopt;
    const double beta = n_iterations == 0 ? 0 : z_dot_z / previous;
    d.update(1, z, beta);
    a_d.update(1, a_z, beta);
    // q = [A, -B; -B^T, -C] d, and <[A_0, 0; -B^T, -S_0]^-1 q, d>_H.
    q.pressure.update(1, a_d, 0);
    coupling.apply(d.solid, q.pressure, Teuchos::TRANS, -1, 1);
    apply(*system.solids.op, d.solid, q.solid);
    coupling.apply(d.pressure, q.solid, Teuchos::NO_TRANS, -1, -1);
    precondition_pressure(q.pressure, q_1);
    below.update(-1, q.solid, 0);
    coupling.apply(q_1, below, Teuchos::NO_TRANS, -1, 1);
    const double curvature = q_1.dot(a_d) - q.pressure.dot(d.pressure) + below.dot(d.solid);
    const double step = z_dot_z / curvature;
    x.update(step, d, 1);
    r.update(-step, q, 1);
    z.pressure.update(-step, q_1, 1);
  }
  correction.update(1, x.pressure, 0);
  return n_iterations;
}

}  // namespace lockstep
