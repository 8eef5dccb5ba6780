#include "solve/minres.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// [c s; s -c] (a, b)^T = (r, 0)^T with r >= 0.
struct Reflection {
  double c = -1, s = 0, r = 0;

  static Reflection of(double a, double b) {
    const double r = std::hypot(a, b);
    if (r == 0)
      return {1, 0, 0};
    return {a / r, b / r, r};
  }
};

Blocks zero_like(const Blocks& blocks) {
  Blocks result;
  for (const auto& block : blocks)
    result.push_back(make_vector(block->getMap()));
  return result;
}

/// Calls f(lane, pointers...) for every local entry of all blocks, in lanes of independent sums.
constexpr int n_lanes = 8;
using Lanes = std::array<double, n_lanes>;

template <typename Function, typename... Pointers>
void for_each_entry_of(std::ptrdiff_t n, const Function& f, Pointers... pointers) {
  std::ptrdiff_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
#pragma GCC ivdep
    for (int lane = 0; lane < n_lanes; ++lane)
      f(lane, pointers[i + lane]...);
  }
  for (; i < n; ++i)
    f(0, pointers[i]...);
}

double* values_of(const RCP<Vector>& vector) {
  return vector->getDataNonConst().getRawPtr();
}

/// One pass over all blocks of the given vectors.
template <typename Function, typename... AllBlocks>
void pass(const Function& f, const Blocks& first, const AllBlocks&... others) {
  for (std::size_t block = 0; block < first.size(); ++block)
    for_each_entry_of(static_cast<std::ptrdiff_t>(first[block]->getLocalLength()), f,
                      values_of(first[block]), values_of(others[block])...);
}

double total(const Communicator& comm, const Lanes& lanes) {
  return sum_all(comm, std::accumulate(lanes.begin(), lanes.end(), 0.0));
}

/// The scalars of the QLP factorisation of the Lanczos matrix: T_k is made lower triangular by a
/// reflection from the left a step (as in MINRES) and two from the right.
struct LanczosFactors {
  Reflection left{-1, 0, 0}, right_1{-1, 0, 0}, right_2{-1, 0, 0};
  double delta_next = 0, epsilon_next = 0;  // of the next column of R
  double gamma = 0, gamma_1 = 0, gamma_2 = 0,
         gamma_3 = 0;                          // diagonal of L, and of the columns before
  double theta = 0, theta_1 = 0, theta_2 = 0;  // first subdiagonal ("vartheta")
  double eta = 0, eta_1 = 0, eta_2 = 0;        // second
  double tau = 0, tau_1 = 0, tau_2 = 0;        // right-hand side of L u = t
  double u = 0, u_1 = 0, u_2 = 0, u_3 = 0, u_4 = 0;
  double phi = 0;  // |r| in the norm of M
  // The column of R as MINRES uses it.
  double epsilon = 0, delta = 0, gamma_minres = 0;
  double slope = 0;  // |A r| / |r| of the residual before this step

  void advance(int k, double alpha, double beta_next);
};

void LanczosFactors::advance(int k, double alpha, double beta_next) {
  const double delta_bar = delta_next;
  delta = left.c * delta_bar + left.s * alpha;
  epsilon = epsilon_next;
  const double gamma_bar = left.s * delta_bar - left.c * alpha;
  epsilon_next = left.s * beta_next;
  delta_next = -left.c * beta_next;
  slope = std::hypot(gamma_bar, delta_next);

  gamma_3 = gamma_2;
  gamma_2 = gamma_1;
  gamma_1 = gamma;
  left = Reflection::of(gamma_bar, beta_next);
  gamma = gamma_minres = left.r;
  tau_2 = tau_1;
  tau_1 = tau;
  tau = left.c * phi;
  phi *= left.s;

  double delta_l = delta;
  if (k > 2) {
    theta_2 = theta_1;
    eta_2 = eta_1;
    eta_1 = eta;
    const double below = right_2.s * theta - right_2.c * delta_l;
    theta_1 = right_2.c * theta + right_2.s * delta_l;
    delta_l = below;
    eta = right_2.s * gamma;
    gamma = -right_2.c * gamma;
  }
  if (k > 1) {
    right_1 = Reflection::of(gamma_1, delta_l);
    gamma_1 = right_1.r;
    theta = right_1.s * gamma;
    gamma = -right_1.c * gamma;
  }
  u_4 = u_3;
  u_3 = u_2;
  if (k > 2)
    u_2 = (tau_2 - eta_2 * u_4 - theta_2 * u_3) / gamma_2;
  if (k > 1)
    u_1 = (tau_1 - eta_1 * u_3 - theta_1 * u_2) / gamma_1;
}

/// One solve: its vectors and recurrences.
class Minres {
 public:
  Minres(const BlockAction& op, const BlockAction& preconditioner, const Blocks& rhs, Blocks& x,
         const MinresRequest& request)
      : op_(op),
        preconditioner_(preconditioner),
        rhs_(rhs),
        x_(x),
        request_(request),
        comm_(rhs.front()->getMap()->getComm()) {}

  MinresReport run();

 private:
  void start();
  bool iterate();
  void take_minres_step();
  void take_qlp_step();
  void begin_qlp();
  bool reached();
  void compute_residual();
  void check_finite(double value, const char* what) const {
    check_solve(
        std::isfinite(value),
        "{}: {} is not finite in iteration {} of MINRES. The operator, its preconditioner or "
        "the right-hand side holds infinities or NaN.",
        request_.name, what, report_.n_iterations);
  }
  double preconditioned_norm(const Blocks& r, Blocks& z);

  const BlockAction& op_;
  const BlockAction& preconditioner_;
  const Blocks& rhs_;
  Blocks& x_;
  const MinresRequest& request_;
  Communicator comm_;
  MinresReport report_;

  LanczosFactors f_;
  // Lanczos: r_old_, r_ are beta times the dual vectors, z_ = M r_, v_ = z_ / beta.
  Blocks r_old_, r_, z_, v_, product_;
  double beta_old_ = 0, beta_ = 0, beta_next_ = 0;
  Blocks w_, w_1_, w_2_, x_2_;
  double operator_norm_ = 0, smallest_gamma_ = 0, previous_smallest_ = 0;
  double u_qlp_ = 0, u_1_qlp_ = 0, gamma_qlp_ = 0, gamma_1_qlp_ = 0, theta_qlp_ = 0;
  double look_below_ = 0;  ///< phi at which the true residual is worth looking at
};

double Minres::preconditioned_norm(const Blocks& r, Blocks& z) {
  preconditioner_(r, z);
  Lanes sums{};
  pass([&](int lane, double a, double b) { sums[lane] += a * b; }, r, z);
  const double square = total(comm_, sums);
  check_finite(square, "r . M r");
  check_solve(
      square >= 0,
      "{}: the preconditioner is not positive definite (r . M r = {:.3e} in iteration {} of "
      "MINRES). Set \"Check Preconditioner Symmetry\".",
      request_.name, square, report_.n_iterations);
  return std::sqrt(square);
}

/// report_.residuals and product_ := b - A x.
void Minres::compute_residual() {
  op_(x_, product_);
  report_.residuals.resize(rhs_.size());
  for (std::size_t block = 0; block < rhs_.size(); ++block) {
    Lanes sums{};
    for_each_entry_of(
        static_cast<std::ptrdiff_t>(rhs_[block]->getLocalLength()),
        [&](int lane, double& r, double b) {
          r = b - r;
          sums[lane] += r * r;
        },
        values_of(product_[block]), values_of(rhs_[block]));
    report_.residuals[block] = std::sqrt(total(comm_, sums));
    check_finite(report_.residuals[block], "the residual");
  }
}

/// Looks at the true residual, and if it is not small enough says how far phi has to fall.
bool Minres::reached() {
  compute_residual();
  double worst = 0;
  for (std::size_t block = 0; block < rhs_.size(); ++block) {
    if (report_.residuals[block] > request_.targets[block])
      worst =
          std::max(worst, report_.residuals[block] / std::max(request_.targets[block],
                                                              std::numeric_limits<double>::min()));
  }
  report_.converged = worst == 0;
  look_below_ = f_.phi / std::max(1.5, 1.2 * worst);
  return report_.converged;
}

void Minres::start() {
  for (Blocks* blocks : {&r_old_, &r_, &z_, &v_, &product_, &w_, &w_1_, &w_2_})
    *blocks = zero_like(rhs_);
}

MinresReport Minres::run() {
  start();
  if (reached())
    return report_;
  std::swap(r_, product_);
  beta_next_ = f_.phi = preconditioned_norm(r_, z_);
  if (beta_next_ == 0)
    return report_;
  double worst = 1;
  for (std::size_t block = 0; block < rhs_.size(); ++block)
    worst =
        std::max(worst, report_.residuals[block] /
                            std::max(request_.targets[block], std::numeric_limits<double>::min()));
  look_below_ = f_.phi / worst;
  while (report_.n_iterations < request_.maximum_iterations && iterate()) {
  }
  if (!report_.converged)
    reached();
  return report_;
}

/// One step of Lanczos and of the factorisation; false when there is nothing more to do.
bool Minres::iterate() {
  const int k = ++report_.n_iterations;
  beta_old_ = beta_;
  beta_ = beta_next_;
  const double scale = 1 / beta_;
  pass([=](int, double& v, double z) { v = scale * z; }, v_, z_);
  op_(v_, product_);
  Lanes sums{};
  const double back = k > 1 ? beta_ / beta_old_ : 0;
  pass(
      [&](int lane, double& p, double r_old, double v) {
        p -= back * r_old;
        sums[lane] += p * v;
      },
      product_, r_old_, v_);
  const double alpha = total(comm_, sums);
  check_finite(alpha, "v . A v");
  const double along = alpha / beta_;
  pass([=](int, double& p, double r) { p -= along * r; }, product_, r_);
  std::swap(r_old_, r_);
  std::swap(r_, product_);
  beta_next_ = preconditioned_norm(r_, z_);
  const double column_norm = std::hypot(k > 1 ? beta_ : 0.0, alpha, beta_next_);
  // A Lanczos vector that is round-off of the others says that the Krylov space is complete.
  if (beta_next_ <= 1e-15 * column_norm)
    beta_next_ = 0;

  f_.advance(k, alpha, beta_next_);
  operator_norm_ = std::max({operator_norm_, column_norm, f_.gamma_1, std::abs(f_.gamma)});
  // |A r| / |r| was nearly nothing before this step: r is a minimum, and what the step can still do
  // is to make x the shortest of its kind, which takes the last component out of it.
  const bool is_singular_step =
      std::min(std::abs(f_.gamma), k > 1 ? f_.slope : std::abs(f_.gamma)) <=
      request_.least_squares_tolerance * operator_norm_;
  f_.u = is_singular_step ? 0 : (f_.tau - f_.eta * f_.u_2 - f_.theta * f_.u_1) / f_.gamma;
  if (report_.condition < request_.transition_condition && report_.n_qlp_iterations == 0 &&
      !is_singular_step)
    take_minres_step();
  else
    take_qlp_step();

  u_qlp_ = f_.u;
  u_1_qlp_ = f_.u_1;
  gamma_qlp_ = f_.gamma;
  gamma_1_qlp_ = f_.gamma_1;
  theta_qlp_ = f_.theta;
  f_.right_2 = Reflection::of(f_.gamma_1, f_.epsilon_next);
  f_.gamma_1 = f_.right_2.r;
  const double smallest = std::abs(gamma_qlp_);
  smallest_gamma_ = k == 1 ? smallest : std::min({previous_smallest_, gamma_1_qlp_, smallest});
  previous_smallest_ = k == 1 ? smallest : std::min(previous_smallest_, gamma_1_qlp_);
  report_.condition = operator_norm_ / std::max(smallest_gamma_, 1e-300);

  if (f_.phi <= look_below_ && reached())
    return false;
  report_.is_least_squares = is_singular_step;
  return beta_next_ > 0 && !is_singular_step;
}

/// x += tau w with w = (v - epsilon w_2 - delta w_1) / gamma.
void Minres::take_minres_step() {
  std::swap(w_2_, w_1_);
  std::swap(w_1_, w_);
  const double epsilon = f_.epsilon, delta = f_.delta, scale = 1 / f_.gamma_minres, tau = f_.tau;
  pass(
      [=](int, double& w, double w_1, double w_2, double v, double& x) {
        w = (v - epsilon * w_2 - delta * w_1) * scale;
        x += tau * w;
      },
      w_, w_1_, w_2_, v_, x_);
}

/// From the columns of V R^-1 that MINRES keeps to those of V P that MINRES-QLP needs.
void Minres::begin_qlp() {
  x_2_ = zero_like(rhs_);
  const int k = report_.n_iterations;
  const double gamma_3 = k > 3 ? f_.gamma_3 : 0, theta_2 = k > 3 ? f_.theta_2 : 0,
               eta_1 = k > 3 ? f_.eta_1 : 0;
  const double gamma_1 = k > 2 ? gamma_1_qlp_ : 0, theta = k > 2 ? theta_qlp_ : 0;
  const double gamma = k > 1 ? gamma_qlp_ : 0, u = u_qlp_, u_1 = k > 2 ? u_1_qlp_ : 0;
  pass(
      [=](int, double& w_2, double& w_1, double& w) {
        w_2 = gamma_3 * w_2 + theta_2 * w_1 + eta_1 * w;
        w_1 = gamma_1 * w_1 + theta * w;
        w = gamma * w;
      },
      w_2_, w_1_, w_);
  pass([=](int, double& x_2, double x, double w_1, double w) { x_2 = x - u_1 * w_1 - u * w; }, x_2_,
       x_, w_1_, w_);
}

void Minres::take_qlp_step() {
  if (++report_.n_qlp_iterations == 1)
    begin_qlp();
  const int k = report_.n_iterations;
  const Reflection p_1 = k > 1 ? f_.right_1 : Reflection{-1, 0, 0};
  const Reflection p_2 = k > 2 ? f_.right_2 : Reflection{-1, 0, 0};
  const double u = f_.u, u_1 = k > 1 ? f_.u_1 : 0, u_2 = k > 2 ? f_.u_2 : 0;
  pass(
      [=](int, double v, double& w_2, double& w_1, double& w, double& x_2, double& x) {
        // The new column passes through the right reflections with the two before it.
        const double far = p_2.c * w_1 + p_2.s * v, new_far = p_2.s * w_1 - p_2.c * v;
        const double near = p_1.c * w + p_1.s * new_far, last = p_1.s * w - p_1.c * new_far;
        w_2 = far;
        w_1 = near;
        w = last;
        x_2 += u_2 * w_2;
        x = x_2 + u_1 * w_1 + u * w;
      },
      v_, w_2_, w_1_, w_, x_2_, x_);
}

}  // namespace

MinresReport minres(const BlockAction& op, const BlockAction& preconditioner, const Blocks& rhs,
                    Blocks& x, const MinresRequest& request) {
  LOCKSTEP_ASSERT(request.targets.size() == rhs.size() && !rhs.empty());
  return Minres(op, preconditioner, rhs, x, request).run();
}

}  // namespace lockstep
