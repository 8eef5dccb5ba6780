#include "deformable/materials/material.hpp"

#include "base/errors.hpp"

namespace lockstep {

LameConstants lame_constants(double youngs_modulus, double poisson_ratio) {
  check_input(youngs_modulus > 0, "Young's modulus must be positive, but is {} Pa.",
              youngs_modulus);
  check_input(poisson_ratio > -1 && poisson_ratio < 0.5,
              "Poisson's ratio must lie between -1 and 0.5, but is {}; nearly incompressible is "
              "0.49.",
              poisson_ratio);
  return {youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          youngs_modulus / (2 * (1 + poisson_ratio))};
}

template <int dim>
LameConstants Material<dim>::at_rest() const {
  const TensorDerivative<dim> hooke = stress_derivative(Tensor<dim>::Identity());
  constexpr int second = dim + 1;  // entry of F_11; 0 is that of F_00, 1 of F_10
  return {hooke(0, second), hooke(1, 1)};
}

template LameConstants Material<2>::at_rest() const;
template LameConstants Material<3>::at_rest() const;

}  // namespace lockstep
