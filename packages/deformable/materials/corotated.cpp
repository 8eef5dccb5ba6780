#include <cmath>

#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

/// F = U diag(sigma) V^T with rotations U and V: the smallest singular value carries the sign of
/// det F.
template <int dim>
struct SignedSingularValues {
  Tensor<dim> u, v;
  Eigen::Matrix<double, dim, 1> sigma;

  explicit SignedSingularValues(const Tensor<dim>& f) {
    const Eigen::JacobiSVD<Tensor<dim>> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    u = svd.matrixU();
    v = svd.matrixV();
    sigma = svd.singularValues();
    for (Tensor<dim>* rotation : {&u, &v}) {
      if (rotation->determinant() < 0) {
        rotation->col(dim - 1) *= -1;
        sigma[dim - 1] *= -1;
      }
    }
  }
};

/// energy = mu |F - R|^2 + lambda/2 tr(S - I)^2.
template <int dim>
class Corotated : public Material<dim> {
 public:
  explicit Corotated(const LameConstants& lame) : lame_(lame) {}

  double energy_density(const Tensor<dim>& f) const override {
    const SignedSingularValues<dim> svd(f);
    const double trace = svd.sigma.sum() - dim;
    return lame_.mu * (svd.sigma.array() - 1).square().sum() + 0.5 * lame_.lambda * trace * trace;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    const SignedSingularValues<dim> svd(f);
    const Tensor<dim> r = svd.u * svd.v.transpose();
    return 2 * lame_.mu * (f - r) + lame_.lambda * (svd.sigma.sum() - dim) * r;
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    const SignedSingularValues<dim> svd(f);
    const Tensor<dim> r = svd.u * svd.v.transpose();
    const double rotation_factor = lame_.lambda * (svd.sigma.sum() - dim) - 2 * lame_.mu;
    return matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
      const Tensor<dim> m = svd.u.transpose() * d * svd.v;
      Tensor<dim> turn;  // turn of R, in the basis of the singular vectors
      for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim; ++j)
          turn(i, j) = i == j ? 0 : (m(i, j) - m(j, i)) / bounded(svd.sigma[i] + svd.sigma[j]);
      }
      return 2 * lame_.mu * d + rotation_factor * (svd.u * turn * svd.v.transpose()) +
             lame_.lambda * m.trace() * r;
    });
  }

 private:
  /// R turns infinitely fast where two singular values of opposite sign meet.
  static double bounded(double sum) {
    constexpr double least = 1e-3;
    return std::abs(sum) < least ? std::copysign(least, sum) : sum;
  }

  LameConstants lame_;
};

}  // namespace

template <int dim>
std::unique_ptr<Material<dim>> corotated(const LameConstants& lame) {
  return std::make_unique<Corotated<dim>>(lame);
}

template std::unique_ptr<Material<2>> corotated<2>(const LameConstants&);
template std::unique_ptr<Material<3>> corotated<3>(const LameConstants&);

}  // namespace lockstep
