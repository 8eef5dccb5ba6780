#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

/// energy = mu E:E + lambda/2 tr(E)^2, E = (F^T F - I)/2.
template <int dim>
class StVenantKirchhoff : public Material<dim> {
 public:
  explicit StVenantKirchhoff(const LameConstants& lame) : lame_(lame) {}

  double energy_density(const Tensor<dim>& f) const override {
    const Tensor<dim> strain = strain_of(f);
    const double trace = strain.trace();
    return lame_.mu * strain.squaredNorm() + 0.5 * lame_.lambda * trace * trace;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    return f * second_stress(strain_of(f));
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    const Tensor<dim> s = second_stress(strain_of(f));
    return matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
      const Tensor<dim> product = f.transpose() * d;
      return d * s + f * second_stress(0.5 * (product + product.transpose()));
    });
  }

 private:
  static Tensor<dim> strain_of(const Tensor<dim>& f) {
    return 0.5 * (f.transpose() * f - Tensor<dim>::Identity());
  }
  Tensor<dim> second_stress(const Tensor<dim>& strain) const {
    return 2 * lame_.mu * strain + lame_.lambda * strain.trace() * Tensor<dim>::Identity();
  }

  LameConstants lame_;
};

}  // namespace

template <int dim>
std::unique_ptr<Material<dim>> st_venant_kirchhoff(const LameConstants& lame) {
  return std::make_unique<StVenantKirchhoff<dim>>(lame);
}

template std::unique_ptr<Material<2>> st_venant_kirchhoff<2>(const LameConstants&);
template std::unique_ptr<Material<3>> st_venant_kirchhoff<3>(const LameConstants&);

}  // namespace lockstep
