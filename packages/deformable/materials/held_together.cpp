#include <algorithm>

#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

/// Adds k/4 (|F|^2/L^2 - 1)^2 L^2 to the energy of what is longer than L.
template <int dim>
class HeldTogether : public Material<dim> {
 public:
  HeldTogether(std::unique_ptr<Material<dim>> material, double stiffness)
      : material_(std::move(material)), stiffness_(stiffness) {}

  double energy_density(const Tensor<dim>& f) const override {
    const double excess = this->excess(f);
    return material_->energy_density(f) + 0.25 * stiffness_ * longest * excess * excess;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    return material_->stress(f) + stiffness_ * excess(f) * f;
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    TensorDerivative<dim> result = material_->stress_derivative(f);
    const double excess = this->excess(f);
    if (excess == 0)
      return result;
    result.diagonal().array() += stiffness_ * excess;
    return result + 2 * stiffness_ / longest * stacked<dim>(f) * stacked<dim>(f).transpose();
  }
  const MaterialMemory<dim>* memory() const override { return material_->memory(); }

 private:
  static constexpr double longest = 16;  ///< L^2: four times the length at rest
  static double excess(const Tensor<dim>& f) {
    return std::max(0.0, f.squaredNorm() / longest - 1);
  }

  std::unique_ptr<Material<dim>> material_;
  double stiffness_;
};

}  // namespace

template <int dim>
std::unique_ptr<Material<dim>> held_together(std::unique_ptr<Material<dim>> material,
                                             double stiffness) {
  if (stiffness == 0)
    return material;
  return std::make_unique<HeldTogether<dim>>(std::move(material), stiffness);
}

template std::unique_ptr<Material<2>> held_together<2>(std::unique_ptr<Material<2>>, double);
template std::unique_ptr<Material<3>> held_together<3>(std::unique_ptr<Material<3>>, double);

}  // namespace lockstep
