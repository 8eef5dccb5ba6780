#include "linear/conjugate_gradients.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "linear/vector_sums.hpp"

namespace lockstep {

namespace {

/// x += step d, r -= step q; returns r.r of this rank: one pass over the four vectors.
double advance(double step, const Vector& d, const Vector& q, Vector& x, Vector& r) {
  const auto d_values = d.getData(), q_values = q.getData();
  const auto x_values = x.getDataNonConst(), r_values = r.getDataNonConst();
  const double* d_data = d_values.getRawPtr();
  const double* q_data = q_values.getRawPtr();
  double* x_data = x_values.getRawPtr();
  double* r_data = r_values.getRawPtr();
  // Partial sums, so that the loop need not wait for one addition after the other.
  constexpr std::ptrdiff_t n_lanes = 16;
  std::array<double, n_lanes> sums{};
  const std::ptrdiff_t n = d_values.size();
  std::ptrdiff_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
#pragma GCC ivdep
    for (std::ptrdiff_t lane = 0; lane < n_lanes; ++lane) {
      x_data[i + lane] += step * d_data[i + lane];
      const double value = r_data[i + lane] - step * q_data[i + lane];
      r_data[i + lane] = value;
      sums[lane] += value * value;
    }
  }
  for (; i < n; ++i) {
    x_data[i] += step * d_data[i];
    r_data[i] -= step * q_data[i];
    sums[0] += r_data[i] * r_data[i];
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// d = z + beta d; with beta 0 the old d may be anything.
void turn(double beta, const Vector& z, Vector& d) {
  const auto z_values = z.getData();
  const auto d_values = d.getDataNonConst();
  const double* z_data = z_values.getRawPtr();
  double* d_data = d_values.getRawPtr();
  const std::ptrdiff_t n = z_values.size();
  if (beta == 0) {
    std::copy(z_data, z_data + n, d_data);
    return;
  }
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i)
    d_data[i] = z_data[i] + beta * d_data[i];
}

/// Tells a residual that round-off keeps from falling from one that has still to fall. Once it has
/// fallen as far as double precision may allow, directions can be what round-off has left in the
/// null space: then r.z and d.q may have any sign, and steps along them only make r grow again.
class RoundOff {
 public:
  explicit RoundOff(double initial) : initial_(initial), least_(initial) {}
  /// `square` is r.z or d.q, positive but for round-off.
  bool has_lost(double r_norm, double square) {
    constexpr double deep_fall = 1e-10, growth = 1e3;
    least_ = std::min(least_, r_norm);
    return least_ <= deep_fall * initial_ && (!(square > 0) || r_norm > growth * least_);
  }

 private:
  double initial_, least_;
};

/// Kernels made of two operators.
class Actions final : public ConjugateGradientKernels {
 public:
  Actions(const Action& op, const Action& preconditioner, const NullSpace& null_space,
          const RCP<const Map>& map)
      : op_(op),
        preconditioner_(preconditioner),
        null_space_(null_space),
        z_(map),
        direction_(map),
        product_(map) {}

  double precondition(const Vector& r, double) override {
    preconditioner_(r, z_);
    project_out(null_space_, z_);
    return dot(r, z_);
  }
  double advance_direction(double beta) override {
    turn(beta, z_, direction_);
    op_(direction_, product_);
    return dot(direction_, product_);
  }
  double advance(double step, Vector& x, Vector& r) override {
    return sum_all(r.getMap()->getComm(), lockstep::advance(step, direction_, product_, x, r));
  }
  const Vector& direction() const override { return direction_; }

 private:
  const Action& op_;
  const Action& preconditioner_;
  const NullSpace& null_space_;
  Vector z_, direction_, product_;
};

}  // namespace

int conjugate_gradients(ConjugateGradientKernels& kernels, Vector& r, Vector& x,
                        const ConjugateGradientsRequest& request) {
  x.putScalar(0);
  constexpr double trusted_fall = 1e-3;
  double r_norm = norm(r), true_norm = r_norm;
  check_solve(std::isfinite(r_norm), "{}: the right-hand side is not finite (|r| = {}).",
              request.name, r_norm);
  RoundOff round_off(r_norm);
  double r_dot_z = 0;
  int iteration = 0;
  double target = request.target;
  while (r_norm > target && iteration < request.maximum_iterations) {
    const double previous = r_dot_z;
    r_dot_z = kernels.precondition(r, r_norm);
    if (round_off.has_lost(r_norm, r_dot_z))
      break;
    check_solve(
        std::isfinite(r_dot_z) && r_dot_z > 0,
        "{}: the preconditioner is not positive definite (r . M r = {:.3e} in iteration {}, "
        "|r| = {:.3e}). Choose another sub-block inverse.",
        request.name, r_dot_z, iteration, r_norm);
    if (std::sqrt(r_dot_z) <= request.preconditioned_target)
      break;
    const double curvature = kernels.advance_direction(previous == 0 ? 0 : r_dot_z / previous);
    if (round_off.has_lost(r_norm, curvature))
      break;
    check_solve(
        std::isfinite(curvature) && curvature > 0,
        "{}: the operator is not positive definite (d . S d = {:.3e} in iteration {}, |r| = "
        "{:.3e}). A singular system needs its null vectors.",
        request.name, curvature, iteration, r_norm);
    r_norm = std::sqrt(kernels.advance(r_dot_z / curvature, x, r));
    ++iteration;
    check_solve(std::isfinite(r_norm), "{}: the residual is not finite after {} iterations.",
                request.name, iteration);
    if (request.true_residual && r_norm <= trusted_fall * true_norm) {
      if (!request.true_residual(x, r))
        break;
      // Where the recurrence has lost the residual, its directions are of no use any more.
      true_norm = norm(r);
      if (true_norm > 2 * r_norm)
        r_dot_z = 0;
      r_norm = true_norm;
    }
    if (r_norm <= target && request.update_target)
      target = std::min(target, request.update_target(x));
  }
  return iteration;
}

int conjugate_gradients(const Action& op, const Action& preconditioner, const Vector& rhs,
                        Vector& x, const ConjugateGradientsRequest& request) {
  Actions actions(op, preconditioner, request.null_space, rhs.getMap());
  Vector r(rhs, Teuchos::Copy);
  return conjugate_gradients(actions, r, x, request);
}

}  // namespace lockstep
