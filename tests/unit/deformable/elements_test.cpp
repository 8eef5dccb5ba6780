// Finite elements of volumes: forces from the energy, stiffness from the forces, momentum.
#include <Eigen/Dense>

#include "deformable/elements/volume_elements.hpp"
#include "deformable/mesh/volume_generators.hpp"
#include "nodes.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

template <int dim>
struct Elements {
  VolumeMesh<dim> mesh = box_volume<dim>(Point<dim>::Constant(1), 0.5);
  std::unique_ptr<ElementGroup<dim>> group;
  int n = static_cast<int>(mesh.vertices.size());

  explicit Elements(const std::string& law)
      : group(volume_elements<dim>(mesh, make_material<dim>(law, {2, 1.5}), {0.3, 0.2})) {}
  double energy(const Nodes<dim>& x) const {
    Nodes<dim> force(n, Point<dim>::Zero());
    return group->add_elastic_forces(x, n, force);
  }
  Nodes<dim> force(const Nodes<dim>& x) const {
    Nodes<dim> result(n, Point<dim>::Zero());
    group->add_elastic_forces(x, n, result);
    return result;
  }
  NodeMatrix<dim> empty_matrix() const { return NodeMatrix<dim>(n, {group->corners()}); }
};

template <int dim>
void check_volume_forces() {
  for (const auto& material : shipped_materials<dim>()) {
    SCOPED_TRACE(material.name);
    const Elements<dim> elements(material.name);
    Nodes<dim> x = shaken<dim>(elements.mesh.vertices, 1.1, 0.1, 7);
    const Nodes<dim> force = elements.force(x);
    Point<dim> sum = Point<dim>::Zero();
    AngularVector<dim> torque = AngularVector<dim>::Zero();
    for (int n = 0; n < elements.n; ++n) {
      sum += force[n];
      torque += cross<dim>(x[n], force[n]);
    }
    EXPECT_LE(sum.norm(), 1e-14);
    if (material.name != "linear") {
      EXPECT_LE(torque.norm(), 1e-14);
    }
    const double step = 1e-5;
    for (int n = 0; n < elements.n; n += 3) {
      for (int a = 0; a < dim; ++a) {
        Nodes<dim> up = x, down = x;
        up[n][a] += step;
        down[n][a] -= step;
        EXPECT_NEAR(force[n][a], -(elements.energy(up) - elements.energy(down)) / (2 * step), 1e-8);
      }
    }
  }
}
TEST(VolumeElements, ForcesAreThoseOfTheEnergyAndHaveNoMomentum) {
  check_volume_forces<2>();
  check_volume_forces<3>();
}

template <int dim>
void check_stiffness() {
  for (const auto& material : shipped_materials<dim>()) {
    SCOPED_TRACE(material.name);
    const Elements<dim> elements(material.name);
    // Stretched a little, so that nothing has to be clamped.
    const Nodes<dim> x = shaken<dim>(elements.mesh.vertices, 1.1, 0.002, 7);
    auto matrix = elements.empty_matrix();
    EXPECT_EQ(elements.group->add_stiffness(x, matrix), 0);
    const Eigen::MatrixXd stiffness = dense_blocks(matrix);
    EXPECT_LE((stiffness - stiffness.transpose()).norm(), 1e-13 * stiffness.norm());
    const double step = 1e-5;
    for (int n = 0; n < elements.n; n += 3) {
      for (int a = 0; a < dim; ++a) {
        Nodes<dim> up = x, down = x;
        up[n][a] += step;
        down[n][a] -= step;
        const Nodes<dim> f_up = elements.force(up), f_down = elements.force(down);
        for (int m = 0; m < elements.n; ++m) {
          const Point<dim> column = -(f_up[m] - f_down[m]) / (2 * step);
          EXPECT_LE((column - stiffness.block<dim, 1>(dim * m, dim * n + a)).norm(), 1e-8);
        }
      }
    }
  }
}
TEST(VolumeElements, StiffnessIsTheDerivativeOfTheForces) {
  check_stiffness<2>();
  check_stiffness<3>();
}

template <int dim>
void check_clamping() {
  for (const char* law : {"corotated", "neo-hookean", "st venant-kirchhoff"}) {
    SCOPED_TRACE(law);
    const Elements<dim> elements(law);
    Nodes<dim> x = shaken<dim>(elements.mesh.vertices, 1.1, 0.05, 7);
    for (auto& point : x)
      point[0] *= -0.4;  // compressed and inverted
    auto matrix = elements.empty_matrix();
    const int n_clamped = elements.group->add_stiffness(x, matrix);
    EXPECT_GT(n_clamped, 0);
    EXPECT_LE(n_clamped, static_cast<int>(elements.mesh.elements.size()));
    const Eigen::MatrixXd stiffness = dense_blocks(matrix);
    const Eigen::VectorXd eigenvalues = stiffness.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
    // Translations cost nothing.
    const Eigen::VectorXd shift = Point<dim>::Unit(1).replicate(elements.n, 1);
    EXPECT_LE((stiffness * shift).norm(), 1e-13 * stiffness.norm());
  }
}
TEST(VolumeElements, StiffnessIsMadeDefinite) {
  check_clamping<2>();
  check_clamping<3>();
}

template <int dim>
void check_damping() {
  const Elements<dim> elements("corotated");
  const Nodes<dim> x = shaken<dim>(elements.mesh.vertices, 1.1, 0.15, 7);
  auto matrix = elements.empty_matrix();
  elements.group->add_damping(x, matrix);
  const Eigen::MatrixXd damping = dense_blocks(matrix);
  EXPECT_LE((damping - damping.transpose()).norm(), 1e-13 * damping.norm());
  const Eigen::VectorXd eigenvalues = damping.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  const AngularVector<dim> turn = AngularVector<dim>::LinSpaced(1, 2);
  Eigen::VectorXd rigid(dim * elements.n);
  for (int n = 0; n < elements.n; ++n)
    rigid.segment<dim>(dim * n) = Point<dim>::Constant(0.3) + rotate<dim>(turn, x[n]);
  EXPECT_LE((damping * rigid).norm(), 1e-13 * damping.norm());
  // A uniform stretch rate of the cube at rest: power = (2 shear dim + bulk dim^2) rate^2.
  auto at_rest = elements.empty_matrix();
  elements.group->add_damping(elements.mesh.vertices, at_rest);
  Eigen::VectorXd stretch(dim * elements.n);
  for (int n = 0; n < elements.n; ++n)
    stretch.segment<dim>(dim * n) = 2 * elements.mesh.vertices[n];
  EXPECT_NEAR(stretch.dot(dense_blocks(at_rest) * stretch), 4 * (0.6 * dim + 0.2 * dim * dim),
              1e-12);
}
TEST(VolumeElements, DampingIsDissipativeAndLeavesRigidMotionsAlone) {
  check_damping<2>();
  check_damping<3>();
}

/// Uniform stretch by 1 % of a bar between frictionless sides: sigma = (lambda + 2 mu) 0.01.
TEST(VolumeElements, PatchTest) {
  const Elements<3> elements("linear");
  Nodes<3> x = elements.mesh.vertices;
  for (auto& point : x)
    point.x() *= 1.01;
  const Nodes<3> force = elements.force(x);
  Point<3> right = Point<3>::Zero();
  for (int n = 0; n < elements.n; ++n) {
    const Point<3>& at = elements.mesh.vertices[n];
    if (at.cwiseAbs().maxCoeff() < 0.4) {
      EXPECT_LE(force[n].norm(), 1e-15);
    }  // inside
    if (at.x() > 0.4)
      right += force[n];
  }
  EXPECT_NEAR(right.x(), -(2 + 2 * 1.5) * 0.01, 1e-14);
}

TEST(Clamping, OnlyNegativeEigenvaluesChange) {
  Eigen::Matrix4d vectors =
      Eigen::HouseholderQR<Eigen::Matrix4d>(Eigen::Matrix4d::Random()).householderQ();
  Eigen::Vector4d values(3, -2, 0, 1);
  Eigen::Matrix4d matrix = vectors * values.asDiagonal() * vectors.transpose();
  EXPECT_TRUE(clamp_eigenvalues<4>(matrix));
  values[1] = 0;
  EXPECT_LE((matrix - vectors * values.asDiagonal() * vectors.transpose()).norm(), 1e-14);
  const Eigen::Matrix4d before = matrix;
  EXPECT_FALSE(clamp_eigenvalues<4>(matrix));
  EXPECT_EQ(before, matrix);
}

}  // namespace
}  // namespace lockstep::test
