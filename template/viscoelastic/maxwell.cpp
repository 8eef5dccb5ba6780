// A material with a memory, for `simulate --plug-in libviscoelastic.so`: a standard linear solid.
#include <cmath>

#include "deformable/materials/material_registry.hpp"
#include "deformable/materials/tensor_products.hpp"
#include "interfaces/plug_ins.hpp"
using namespace lockstep;

namespace {

/// A spring and a damper in series, St. Venant-Kirchhoff's law of the strain s = E - E_v: Green's
/// strain without that of the damper, which is the state and follows it in the relaxation time.
template <int dim>
class MaxwellBranch : public MaterialMemory<dim> {
 public:
  using State = typename MaterialMemory<dim>::State;
  MaxwellBranch(const LameConstants& spring, double relaxation_time)
      : spring_(spring), relaxation_time_(relaxation_time) {}

  int n_state() const override { return dim * dim; }
  double energy_density(const Tensor<dim>& f, const State& state) const override {
    const Tensor<dim> s = strain(f) - damper(state);
    return spring_.mu * s.squaredNorm() + 0.5 * spring_.lambda * s.trace() * s.trace();
  }
  Tensor<dim> stress(const Tensor<dim>& f, const State& state) const override {
    return f * second_stress(strain(f) - damper(state));
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f, const State& state) const override {
    const Tensor<dim> present = second_stress(strain(f) - damper(state));
    return matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
      const Tensor<dim> product = f.transpose() * d;
      return d * present + f * second_stress(0.5 * (product + product.transpose()));
    });
  }
  void end_step(const Tensor<dim>& f, double dt, Eigen::Ref<Eigen::VectorXd> state) const override {
    const Tensor<dim> s = strain(f) - damper(state);
    state -= std::expm1(-dt / relaxation_time_) * stacked<dim>(s);
  }

 private:
  static Tensor<dim> strain(const Tensor<dim>& f) {
    return 0.5 * (f.transpose() * f - Tensor<dim>::Identity());
  }
  static Tensor<dim> damper(const State& state) {
    return Eigen::Map<const Tensor<dim>>(state.data());
  }
  Tensor<dim> second_stress(const Tensor<dim>& s) const {
    return 2 * spring_.mu * s + spring_.lambda * s.trace() * Tensor<dim>::Identity();
  }

  LameConstants spring_;
  double relaxation_time_;  ///< [s]
};

/// St. Venant-Kirchhoff's law, to which such a branch is parallel.
template <int dim>
class StandardLinearSolid : public Material<dim> {
 public:
  StandardLinearSolid(std::unique_ptr<Material<dim>> spring, const MaxwellBranch<dim>& branch)
      : spring_(std::move(spring)), branch_(branch) {}

  double energy_density(const Tensor<dim>& f) const override { return spring_->energy_density(f); }
  Tensor<dim> stress(const Tensor<dim>& f) const override { return spring_->stress(f); }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const override {
    return spring_->stress_derivative(f);
  }
  const MaterialMemory<dim>* memory() const override { return &branch_; }

 private:
  std::unique_ptr<Material<dim>> spring_;
  MaxwellBranch<dim> branch_;
};

ParameterList viscoelastic_parameters() {
  ParameterList list = elastic_constants();
  declare_required_positive(list, "Relaxing Modulus",
                            "Young's modulus that relaxes, beside the one that stays [Pa].");
  declare_required_positive(list, "Relaxation Time",
                            "Time in which its stress falls by a factor e at a held strain [s].");
  return list;
}

template <int dim>
std::unique_ptr<Material<dim>> make_viscoelastic(const ParameterList& list) {
  const LameConstants relaxing =
      lame_constants(list.get<double>("Relaxing Modulus"), list.get<double>("Poisson's Ratio"));
  return std::make_unique<StandardLinearSolid<dim>>(
      st_venant_kirchhoff<dim>(read_elastic_constants(list)),
      MaxwellBranch<dim>(relaxing, list.get<double>("Relaxation Time")));
}

template <int dim>
void add_viscoelastic(const Registries<dim>& registries) {
  registries.template part<MaterialRegistry<dim>>().add(
      "standard linear solid", "St. Venant-Kirchhoff, and a part of the stress that relaxes.",
      viscoelastic_parameters, make_viscoelastic<dim>);
}

}  // namespace

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  add_viscoelastic(plug_ins.plane);
  add_viscoelastic(plug_ins.space);
}
