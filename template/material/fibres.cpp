// A material of your own, for `simulate --plug-in libfibres.so`.
#include <cmath>

#include "deformable/materials/material_registry.hpp"
#include "deformable/materials/tensor_products.hpp"
#include "interfaces/plug_ins.hpp"
using namespace lockstep;

namespace {

/// Flesh with fibres along a direction a of the body at rest: St. Venant-Kirchhoff's law, and
/// k/2 E_a^2 with the Green strain E_a = (|F a|^2 - 1)/2 along them.
template <int dim>
class Fibres : public Material<dim> {
 public:
  Fibres(std::unique_ptr<Material<dim>> flesh, double stiffness, const Point<dim>& direction)
      : flesh_(std::move(flesh)), stiffness_(stiffness), direction_(direction) {}

  double energy_density(const Tensor<dim>& f) const override {
    const double strain = this->strain(f);
    return flesh_->energy_density(f) + 0.5 * stiffness_ * strain * strain;
  }
  Tensor<dim> stress(const Tensor<dim>& f) const override {
    const Point<dim> fibre = f * direction_;
    return flesh_->stress(f) + stiffness_ * strain(f) * fibre * direction_.transpose();
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    const Point<dim> fibre = f * direction_;
    const double strain = this->strain(f);
    return flesh_->stress_derivative(f) + matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
             const Point<dim> change = d * direction_;
             return stiffness_ * (fibre.dot(change) * fibre + strain * change) *
                    direction_.transpose();
           });
  }
  LameConstants at_rest() const override { return flesh_->at_rest(); }

 private:
  double strain(const Tensor<dim>& f) const { return 0.5 * ((f * direction_).squaredNorm() - 1); }

  std::unique_ptr<Material<dim>> flesh_;
  double stiffness_;  ///< [Pa]
  Point<dim> direction_;
};

ParameterList fibre_parameters() {
  ParameterList list = elastic_constants();
  declare_at_least(list, "Fibre Stiffness", 0., 0., "Of the fibres along themselves [Pa].");
  declare_between(list, "Fibre Angle", 0., -180., 180.,
                  "From x to the fibres in the x-y plane of the body at rest [degrees].");
  return list;
}

template <int dim>
std::unique_ptr<Material<dim>> make_fibres(const ParameterList& list) {
  const double angle = list.get<double>("Fibre Angle") * std::acos(-1.) / 180;
  Point<dim> direction = Point<dim>::Zero();
  direction[0] = std::cos(angle);
  direction[1] = std::sin(angle);
  return std::make_unique<Fibres<dim>>(st_venant_kirchhoff<dim>(read_elastic_constants(list)),
                                       list.get<double>("Fibre Stiffness"), direction);
}

template <int dim>
void add_fibres(const Registries<dim>& registries) {
  registries.template part<MaterialRegistry<dim>>().add(
      "fibres", "St. Venant-Kirchhoff with fibres that resist stretch along one direction.",
      fibre_parameters, make_fibres<dim>);
}

}  // namespace

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  add_fibres(plug_ins.plane);
  add_fibres(plug_ins.space);
}
