#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

/// energy = mu e:e + lambda/2 tr(e)^2, e = sym(F) - I.
template <int dim>
class LinearElasticity : public Material<dim> {
 public:
  explicit LinearElasticity(const LameConstants& lame) : lame_(lame) {
    derivative_ = matrix_of<dim>([this](const Tensor<dim>& d) { return stress_of(d); });
  }

  double energy_density(const Tensor<dim>& f) const override {
    const Tensor<dim> strain = strain_of(f);
    const double trace = strain.trace();
    return lame_.mu * strain.squaredNorm() + 0.5 * lame_.lambda * trace * trace;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override { return stress_of(strain_of(f)); }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>&) const override { return derivative_; }
  bool feels_rotations() const override { return true; }

 private:
  static Tensor<dim> strain_of(const Tensor<dim>& f) {
    return 0.5 * (f + f.transpose()) - Tensor<dim>::Identity();
  }
  Tensor<dim> stress_of(const Tensor<dim>& d) const {
    return lame_.mu * (d + d.transpose()) + lame_.lambda * d.trace() * Tensor<dim>::Identity();
  }

  LameConstants lame_;
  TensorDerivative<dim> derivative_;
};

}  // namespace

template <int dim>
std::unique_ptr<Material<dim>> linear_elasticity(const LameConstants& lame) {
  return std::make_unique<LinearElasticity<dim>>(lame);
}

template std::unique_ptr<Material<2>> linear_elasticity<2>(const LameConstants&);
template std::unique_ptr<Material<3>> linear_elasticity<3>(const LameConstants&);

}  // namespace lockstep
