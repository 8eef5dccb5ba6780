#include <cmath>

#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

/// energy = mu'/2 (I_C - 3) + lambda'/2 (J - alpha)^2 - mu'/2 log(I_C + 1) + constant, with
/// mu' = 4/3 mu, lambda' = lambda + 5/6 mu and alpha = 1 + 3 mu'/(4 lambda'), which make the rest
/// state stress free and Hooke's law hold there. In 2D F_zz = 1 adds one to I_C.
template <int dim>
class NeoHookean : public Material<dim> {
 public:
  explicit NeoHookean(const LameConstants& lame)
      : mu_(4.0 / 3 * lame.mu),
        lambda_(lame.lambda + 5.0 / 6 * lame.mu),
        alpha_(1 + 0.75 * mu_ / lambda_) {
    at_rest_ = energy(3, 1);
  }

  double energy_density(const Tensor<dim>& f) const override {
    return energy(first_invariant(f), f.determinant()) - at_rest_;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    return mu_ * (1 - 1 / (first_invariant(f) + 1)) * f +
           lambda_ * (f.determinant() - alpha_) * cofactors<dim>(f);
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    const double k = 1 / (first_invariant(f) + 1);
    const auto column = stacked<dim>(f);
    const auto cofactor = stacked<dim>(cofactors<dim>(f));
    const double pressure = lambda_ * (f.determinant() - alpha_);
    TensorDerivative<dim> result =
        pressure * matrix_of<dim>([&](const Tensor<dim>& d) { return cofactor_change<dim>(f, d); });
    result.diagonal().array() += mu_ * (1 - k);
    result += (2 * mu_ * k * k) * column * column.transpose();
    result += lambda_ * cofactor * cofactor.transpose();
    return result;
  }

 private:
  static double first_invariant(const Tensor<dim>& f) { return f.squaredNorm() + (3 - dim); }
  double energy(double i, double j) const {
    return 0.5 * (mu_ * (i - 3 - std::log(i + 1)) + lambda_ * (j - alpha_) * (j - alpha_));
  }

  double mu_, lambda_, alpha_, at_rest_ = 0;
};

}  // namespace

template <int dim>
std::unique_ptr<Material<dim>> neo_hookean(const LameConstants& lame) {
  return std::make_unique<NeoHookean<dim>>(lame);
}

template std::unique_ptr<Material<2>> neo_hookean<2>(const LameConstants&);
template std::unique_ptr<Material<3>> neo_hookean<3>(const LameConstants&);

}  // namespace lockstep
