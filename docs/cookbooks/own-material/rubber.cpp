// Rubber that stiffens as it is stretched, for `simulate --plug-in librubber.so`.
#include "deformable/materials/material_registry.hpp"
#include "deformable/materials/tensor_products.hpp"
#include "interfaces/plug_ins.hpp"
using namespace lockstep;

namespace {

/// Yeoh's second term, c (I - 3)^2 with I = tr(F^T F), on top of the neo-Hookean law that ships.
template <int dim>
class Rubber : public Material<dim> {
 public:
  Rubber(std::unique_ptr<Material<dim>> base, double stiffening)
      : base_(std::move(base)), stiffening_(stiffening) {}

  double energy_density(const Tensor<dim>& f) const override {
    return base_->energy_density(f) + stiffening_ * stretch(f) * stretch(f);
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    return base_->stress(f) + 4 * stiffening_ * stretch(f) * f;
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    return base_->stress_derivative(f) + matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
             return 4 * stiffening_ * (2 * f.cwiseProduct(d).sum() * f + stretch(f) * d);
           });
  }
  LameConstants at_rest() const override { return base_->at_rest(); }

 private:
  /// I - 3; in the plane F_zz = 1.
  static double stretch(const Tensor<dim>& f) { return f.squaredNorm() - dim; }

  std::unique_ptr<Material<dim>> base_;
  double stiffening_;  ///< c [Pa]
};

ParameterList rubber_parameters() {
  ParameterList list = elastic_constants();
  declare_at_least(list, "Stiffening", 0., 0., "Yeoh's second constant [Pa].");
  return list;
}

template <int dim>
void add_rubber(const Registries<dim>& registries) {
  registries.template part<MaterialRegistry<dim>>().add(
      "rubber", "Neo-Hookean rubber that stiffens (Yeoh 1993).", rubber_parameters,
      [](const ParameterList& list) {
        return std::make_unique<Rubber<dim>>(neo_hookean<dim>(read_elastic_constants(list)),
                                             list.get<double>("Stiffening"));
      });
}

}  // namespace

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  add_rubber(plug_ins.plane);
  add_rubber(plug_ins.space);
}
