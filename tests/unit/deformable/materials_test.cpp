// The laws against finite differences, Hooke's law, rotations and inversion.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "deformable/materials/tensor_products.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

const LameConstants lame{2.0, 1.5};

template <int dim>
Tensor<dim> rotation(double angle) {
  Tensor<dim> r = Tensor<dim>::Identity();
  r.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
  if constexpr (dim == 3)
    r = r * Eigen::AngleAxisd(0.7 * angle, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  return r;
}

/// Stretched, turned and sheared; `inverted` ones have a negative determinant.
template <int dim>
std::vector<Tensor<dim>> samples(bool inverted) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  std::vector<Tensor<dim>> all;
  for (int i = 0; i < 6; ++i) {
    Tensor<dim> stretch;
    for (int k = 0; k < dim * dim; ++k)
      stretch(k) = (k % (dim + 1) == 0 ? 1 : 0) + 0.6 * number(random);
    if (inverted)
      stretch.row(0) *= -0.6;
    all.push_back(rotation<dim>(i) * stretch);
  }
  return all;
}

template <int dim>
class Laws : public ::testing::Test {
 protected:
  template <typename Check>
  void for_each(const Check& check) const {
    for (const auto& entry : shipped_materials<dim>()) {
      SCOPED_TRACE(entry.name);
      check(*make_material<dim>(entry.name, lame), entry.name);
    }
  }
};
using Laws2 = Laws<2>;
using Laws3 = Laws<3>;

template <int dim>
void check_derivatives(const Material<dim>& law, const Tensor<dim>& f) {
  const double step = 1e-5;
  const Tensor<dim> p = law.stress(f);
  const TensorDerivative<dim> h = law.stress_derivative(f);
  EXPECT_LE((h - h.transpose()).norm(), 1e-12 * h.norm());
  for (int c = 0; c < dim * dim; ++c) {
    Tensor<dim> up = f, down = f;
    up(c) += step;
    down(c) -= step;
    EXPECT_NEAR(p(c), (law.energy_density(up) - law.energy_density(down)) / (2 * step), 1e-8);
    const Tensor<dim> change = (law.stress(up) - law.stress(down)) / (2 * step);
    EXPECT_LE((stacked<dim>(change) - h.col(c)).norm(), 1e-7 * h.norm());
  }
}

template <int dim>
void check_law(const Material<dim>& law, const std::string& name) {
  for (const bool inverted : {false, true}) {
    for (const auto& f : samples<dim>(inverted))
      check_derivatives(law, f);
  }
  // At rest: no energy, no stress, Hooke's law.
  const Tensor<dim> one = Tensor<dim>::Identity();
  EXPECT_NEAR(law.energy_density(one), 0, 1e-14);
  EXPECT_LE(law.stress(one).norm(), 1e-14);
  const auto hooke = matrix_of<dim>([&](const Tensor<dim>& d) -> Tensor<dim> {
    return lame.mu * (d + d.transpose()) + lame.lambda * d.trace() * one;
  });
  EXPECT_LE((law.stress_derivative(one) - hooke).norm(), 1e-12);
  EXPECT_NEAR(law.at_rest().lambda, lame.lambda, 1e-12);
  EXPECT_NEAR(law.at_rest().mu, lame.mu, 1e-12);
  EXPECT_EQ(law.feels_rotations(), name == "linear");
  if (name == "linear")
    return;
  // A turned frame sees the turned stress, and P F^T is symmetric: no torque.
  for (const auto& f : samples<dim>(false)) {
    const Tensor<dim> r = rotation<dim>(2.1);
    EXPECT_NEAR(law.energy_density(r * f), law.energy_density(f), 1e-12);
    EXPECT_LE((law.stress(r * f) - r * law.stress(f)).norm(), 1e-12);
    const Tensor<dim> kirchhoff = law.stress(f) * f.transpose();
    EXPECT_LE((kirchhoff - kirchhoff.transpose()).norm(), 1e-12);
  }
}

TEST_F(Laws2, AreDerivativesOfTheirEnergy) {
  for_each(check_law<2>);
}
TEST_F(Laws3, AreDerivativesOfTheirEnergy) {
  for_each(check_law<3>);
}

/// From a mirrored shape, steps along -P lead back to rest.
template <int dim>
void check_recovery(const std::string& name) {
  const auto law = make_material<dim>(name, lame);
  for (Tensor<dim> f : samples<dim>(true)) {
    ASSERT_LT(f.determinant(), 0);
    for (int i = 0; i < 4000; ++i)
      f -= 0.02 * law->stress(f);
    EXPECT_GT(f.determinant(), 0.99);
    EXPECT_LE(law->energy_density(f), 1e-12);
  }
}
TEST(Inversion, CorotatedAndNeoHookeanTurnBack) {
  check_recovery<2>("corotated");
  check_recovery<3>("corotated");
  check_recovery<2>("neo-hookean");
  check_recovery<3>("neo-hookean");
}

TEST(Inversion, StressIsFiniteWhenCollapsed) {
  for (const char* name : {"corotated", "neo-hookean"}) {
    const auto law = make_material<3>(name, lame);
    EXPECT_TRUE(law->stress(Tensor<3>::Zero()).allFinite());
    EXPECT_TRUE(law->stress_derivative(Tensor<3>::Zero()).allFinite());
    Tensor<3> flat = Tensor<3>::Identity();
    flat(2, 2) = 0;
    EXPECT_LT(law->stress(flat)(2, 2), -0.1);  // pushes open
  }
}

TEST(Inputs, ModuliAreChecked) {
  EXPECT_THAT(test::error([] { lame_constants(1, 0.5); }), ::testing::HasSubstr("0.49"));
  EXPECT_THAT(test::error([] { lame_constants(0, 0.3); }), ::testing::HasSubstr("positive"));
  const auto steel = lame_constants(210e9, 0.3);
  EXPECT_NEAR(steel.mu, 80.769e9, 1e6);
  EXPECT_NEAR(steel.lambda, 121.154e9, 1e6);
}

}  // namespace
}  // namespace lockstep::test
