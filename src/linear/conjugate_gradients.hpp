#pragma once
#include <functional>
#include <string>

#include "linear/null_space.hpp"

namespace lockstep {

/// y = (operator) x. Collective.
using Action = std::function<void(const Vector& x, Vector& y)>;

struct ConjugateGradientsRequest {
  std::string name;   ///< for messages
  double target = 0;  ///< stop when the recurrence residual's 2-norm is at most this
  int maximum_iterations = 0;
  /// Null vectors of the operator, orthonormal: kept out of every preconditioned residual.
  NullSpace null_space;
  /// Asked when the target is reached: the target for this x, if it depends on x. The iteration
  /// goes on if the new one is not reached yet. Collective.
  std::function<double(const Vector& x)> update_target = {};
  /// r = rhs - (operator) x, where the operator that the iteration applies is a rounded one: asked
  /// whenever |r| has fallen by another 1e-3, so that rounding never shows ("reliable updates",
  /// Clark et al. 2010). False ends the iteration. Collective.
  std::function<bool(const Vector& x, Vector& r)> true_residual = {};
  /// Stop as well when sqrt(r . M r) is at most this: the residual in the preconditioner's norm,
  /// which knows of units.
  double preconditioned_target = 0;
};

/// The vector operations of an iteration, in as few passes over memory as the operators allow.
/// The preconditioned residual z and the direction d belong to the kernels. All sums are global,
/// all calls collective.
class ConjugateGradientKernels {
 public:
  virtual ~ConjugateGradientKernels() = default;
  /// z = M r; returns r.z. `r_norm` is |r|.
  virtual double precondition(const Vector& r, double r_norm) = 0;
  /// d = z + beta d; returns d.(operator) d. With beta 0 the old d does not matter.
  virtual double advance_direction(double beta) = 0;
  /// x += step d, r -= step (operator) d; returns r.r.
  virtual double advance(double step, Vector& x, Vector& r) = 0;
  /// d. Entries that belong to no unknown may have any value.
  virtual const Vector& direction() const = 0;
};

/// Preconditioned conjugate gradients on a symmetric positive (semi)definite operator, from a zero
/// initial guess (pass the residual of a better one as right-hand side, and add the result to it).
/// `r` is the right-hand side, and in the end what is left of it. Returns the number of iterations;
/// running out of them is no error here, for the caller checks the true residual; nor is a residual
/// that round-off keeps from falling on. Throws SolveError if the operator or the preconditioner
/// turns out indefinite or not finite. Right on ranks that own no row. Collective.
int conjugate_gradients(ConjugateGradientKernels& kernels, Vector& r, Vector& x,
                        const ConjugateGradientsRequest& request);

/// Iterates with kernels made of two operators; the request's null vectors are projected out of z.
int conjugate_gradients(const Action& op, const Action& preconditioner, const Vector& rhs,
                        Vector& x, const ConjugateGradientsRequest& request);

}  // namespace lockstep
