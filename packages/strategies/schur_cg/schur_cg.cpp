#include "strategies/schur_cg/schur_cg.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

#include "linear/conjugate_gradients.hpp"
#include "linear/vector_sums.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

namespace {

/// Term that the elimination of V_S adds to A: B C^-1 B^T. Where C^-1 iterates, its tolerance
/// follows the outer residual r: an error of C^-1 relative to the vector it is applied to may be
/// the larger, the nearer |r| is to its target (Simoncini and Szyld 2003). Refinement removes the
/// rest.
class Eliminated {
 public:
  Eliminated(const BlockSystem& system, const SolidInverse& solid, double target)
      : coupling_(*system.coupling_transposed()),
        solid_(solid),
        target_(target),
        force_(coupling_.getRangeMap()),
        velocity_(coupling_.getRangeMap()) {}

  void set_residual(double norm) {
    constexpr double share = 0.3, loosest = 1e-1;
    inverse_ = solid_.to(std::min(loosest, share * target_ / norm));
  }

  /// Finds C^-1 B^T x; returns x.B C^-1 B^T x.
  double find(const Vector& x) {
    coupling_.apply(x, force_);
    apply(*inverse_, force_, velocity_);
    return dot(force_, velocity_);
  }
  /// y += factor B C^-1 B^T x, of the x last found.
  void add(double factor, Vector& y) const {
    coupling_.apply(velocity_, y, Teuchos::TRANS, factor, 1);
  }

 private:
  const CrsMatrix& coupling_;
  const SolidInverse& solid_;
  double target_;
  RCP<const LinearOperator> inverse_;
  Vector force_, velocity_;
};

class SchurKernels final : public ConjugateGradientKernels {
 public:
  SchurKernels(ConjugateGradientKernels& pressure, Eliminated& eliminated)
      : pressure_(pressure), eliminated_(eliminated) {}
  double precondition(const Vector& r, double r_norm) override {
    eliminated_.set_residual(r_norm);
    return pressure_.precondition(r, r_norm);
  }
  double advance_direction(double beta) override {
    const double of_pressure = pressure_.advance_direction(beta);
    return of_pressure + eliminated_.find(direction());
  }
  double advance(double step, Vector& x, Vector& r) override {
    eliminated_.add(-step, r);
    return pressure_.advance(step, x, r);
  }
  const Vector& direction() const override { return pressure_.direction(); }

 private:
  ConjugateGradientKernels& pressure_;
  Eliminated& eliminated_;
};

}  // namespace

ParameterList SchurCg::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  return list;
}

SchurCg::SchurCg(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")) {}

int SchurCg::correct(const BlockSystem& system, const CorrectionRequest& request,
                     Vector& correction) {
  const ConjugateGradientsRequest cg{request.name, request.target, request.maximum_iterations,
                                     iteration_null_space(system), request.update_target};
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  Eliminated eliminated(system, solid(), request.target);
  eliminated.set_residual(request.residual_norm);
  if (layout() != nullptr) {
    SchurKernels kernels(layout()->schur_kernels(), eliminated);
    return conjugate_gradients(kernels, *request.residual, correction, cg);
  }
  return conjugate_gradients(
      [&](const Vector& x, Vector& y) {
        apply(*system.pressure_block(), x, y);
        eliminated.find(x);
        eliminated.add(1, y);
      },
      [&](const Vector& x, Vector& y) { apply(*pressure_inverse(), x, y); }, *request.residual,
      correction, cg);
}

}  // namespace lockstep
