#include "linear/exact_inverse.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/gathered_direct.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

constexpr int largest_block = 24;
constexpr Tpetra::global_size_t largest_direct = 20000;

class ConjugateGradientInverse : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  ConjugateGradientInverse(const RCP<const LinearOperator>& op, double tolerance,
                           int maximum_iterations, const std::string& name)
      : op_(op),
        map_(domain_map(*op)),
        tolerance_(tolerance),
        request_{name, 0, maximum_iterations, {}} {
    if (const auto matrix = assembled(op); !matrix.is_null())
      jacobi_ = jacobi_inverse(*matrix, name);
  }

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    Vector solution(map_);
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      solve(*x.getVector(column), solution);
      y.getVectorNonConst(column)->update(alpha, solution, beta);
    }
  }

 private:
  void solve(const Vector& rhs, Vector& solution) const {
    ConjugateGradientsRequest request = request_;
    const double norm = rhs.norm2();
    request.target = tolerance_ * norm;
    const int iterations =
        conjugate_gradients([this](const Vector& u, Vector& v) { lockstep::apply(*op_, u, v); },
                            [this](const Vector& u, Vector& v) {
                              if (jacobi_.is_null())
                                v.update(1, u, 0);
                              else
                                jacobi_->apply(u, v);
                            },
                            rhs, solution, request);
    Vector residual(rhs, Teuchos::Copy);
    lockstep::apply(*op_, solution, residual, -1, 1);
    check_solve(iterations < request.maximum_iterations,
                "The inner conjugate gradients on the {} stopped at a relative residual of {:.1e} "
                "after {} iterations, but {:.1e} is required.",
                request.name, residual.norm2() / norm, iterations, tolerance_);
  }

  RCP<const LinearOperator> op_;
  RCP<const Map> map_;
  RCP<const CrsMatrix> jacobi_;
  double tolerance_;
  ConjugateGradientsRequest request_;
};

}  // namespace

RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     double tolerance, int maximum_iterations,
                                                     const std::string& name) {
  using Operator = Tpetra::Operator<double, int, GlobalIndex>;
  const RCP<const Operator> inverse =
      rcp(new ConjugateGradientInverse(op, tolerance, maximum_iterations, name));
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(inverse);
}

RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name) {
  if (const auto matrix = assembled(op); !matrix.is_null()) {
    const auto blocks = block_diagonal_inverse(matrix, largest_block, name);
    if (blocks.exact)
      return as_operator(blocks.inverse);
    if (matrix->getGlobalNumRows() <= largest_direct)
      return gathered_direct(matrix, name);
  }
  return conjugate_gradient_inverse(op, 1e-14, 20000, name);
}

}  // namespace lockstep
