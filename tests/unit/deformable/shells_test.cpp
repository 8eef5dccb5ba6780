// Membranes, springs, bending and surface tension: derivatives, momentum, exact figures.
#include <Eigen/Dense>
#include <cmath>

#include "deformable/elements/shell_elements.hpp"
#include "geometry/generators.hpp"
#include "nodes.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

const SheetMaterial sheet_material{100, 0.3, 0.02, 0.1};

template <int dim>
using Group = std::unique_ptr<ElementGroup<dim>>;

/// A ring of segments, a sphere of triangles: shapes with normals of all directions.
template <int dim>
SurfaceMesh<dim> round_shell() {
  return ball_surface<dim>(0.5, dim == 2 ? 0.3 : 0.45);
}

template <int dim>
std::vector<std::pair<std::string, Group<dim>>> kinds(const SurfaceMesh<dim>& mesh) {
  std::vector<std::pair<std::string, Group<dim>>> all;
  all.emplace_back("membrane", membrane_elements<dim>(mesh, sheet_material, 1.1));
  all.emplace_back("springs", membrane_springs<dim>(mesh, sheet_material, 1.1, 0.5));
  SheetMaterial stiff = sheet_material;
  stiff.thickness = 0.3;
  all.emplace_back("bending", bending_elements<dim>(mesh, stiff, true));
  all.emplace_back("surface tension", surface_tension_elements<dim>(mesh, 2));
  return all;
}

template <int dim>
double energy_of(const ElementGroup<dim>& group, const Nodes<dim>& x, Nodes<dim>& force) {
  force.assign(x.size(), Point<dim>::Zero());
  return group.add_elastic_forces(x, static_cast<int>(x.size()), force);
}

template <int dim>
void check_shell_forces() {
  const SurfaceMesh<dim> mesh = round_shell<dim>();
  for (const auto& [name, group] : kinds<dim>(mesh)) {
    SCOPED_TRACE(name);
    const Nodes<dim> x = shaken<dim>(mesh.vertices, 1.1, 0.02, 3);
    Nodes<dim> force, ignored;
    energy_of<dim>(*group, x, force);
    Point<dim> sum = Point<dim>::Zero();
    AngularVector<dim> torque = AngularVector<dim>::Zero();
    const double step = 1e-5;
    for (std::size_t n = 0; n < x.size(); ++n) {
      sum += force[n];
      torque += cross<dim>(x[n], force[n]);
      for (int a = 0; a < dim; ++a) {
        Nodes<dim> up = x, down = x;
        up[n][a] += step;
        down[n][a] -= step;
        const double slope =
            (energy_of<dim>(*group, up, ignored) - energy_of<dim>(*group, down, ignored)) /
            (2 * step);
        EXPECT_NEAR(force[n][a], -slope, 1e-7);
      }
    }
    EXPECT_LE(sum.norm(), 1e-13);
    EXPECT_LE(torque.norm(), 1e-13);
  }
}
TEST(ShellElements, ForcesAreThoseOfTheEnergyAndHaveNoMomentum) {
  check_shell_forces<2>();
  check_shell_forces<3>();
}

template <int dim>
void check_matrices() {
  const SurfaceMesh<dim> mesh = round_shell<dim>();
  const int n = static_cast<int>(mesh.vertices.size());
  for (const auto& [name, group] : kinds<dim>(mesh)) {
    SCOPED_TRACE(name);
    for (const double stretch : {0.6, 1.2}) {
      const Nodes<dim> x = shaken<dim>(mesh.vertices, stretch, 0.02, 3);
      NodeMatrix<dim> stiffness(n, {group->corners()}), damping = stiffness;
      const int n_clamped = group->add_stiffness(x, stiffness);
      if (name == "membrane" || name == "springs") {
        EXPECT_EQ(n_clamped > 0, stretch < 1);
      }
      group->add_damping(x, damping);
      Eigen::VectorXd shift = Point<dim>::Constant(0.3).replicate(n, 1), rigid = shift;
      const AngularVector<dim> turn = AngularVector<dim>::LinSpaced(1, 2);
      for (int v = 0; v < n; ++v)
        rigid.segment<dim>(dim * v) += rotate<dim>(turn, x[v]);
      EXPECT_LE((dense_blocks(damping) * rigid).norm(), 1e-12);
      EXPECT_LE((dense_blocks(stiffness) * shift).norm(), 1e-12);
      for (const Eigen::MatrixXd& matrix : {dense_blocks(stiffness), dense_blocks(damping)}) {
        EXPECT_LE((matrix - matrix.transpose()).norm(), 1e-13 * (1 + matrix.norm()));
        const Eigen::VectorXd eigenvalues = matrix.selfadjointView<Eigen::Lower>().eigenvalues();
        EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * (1 + eigenvalues.maxCoeff()));
      }
      if (stretch < 1 || name == "bending" || name == "surface tension")
        continue;
      // Nothing clamped: the derivative of the forces.
      const double step = 1e-5;
      Nodes<dim> up = x, down = x, f_up, f_down;
      up[1][0] += step;
      down[1][0] -= step;
      energy_of<dim>(*group, up, f_up);
      energy_of<dim>(*group, down, f_down);
      const Eigen::MatrixXd k = dense_blocks(stiffness);
      for (int v = 0; v < n; ++v) {
        const Point<dim> column = -(f_up[v] - f_down[v]) / (2 * step);
        EXPECT_LE((column - k.block<dim, 1>(dim * v, dim)).norm(), 1e-7);
      }
    }
  }
}
TEST(ShellElements, MatricesAreDefiniteAndKnowRigidMotions) {
  check_matrices<2>();
  check_matrices<3>();
}

/// A strip bent to a circle: moment = rigidity times curvature, energy per area D kappa^2 / 2.
TEST(ShellElements, BentStrip) {
  const double thickness = 0.1, rigidity = 100 * 1e-3 / (12 * 0.91), curvature = 0.5;
  const SheetMaterial plate{100, 0.3, thickness, 0};
  const auto roll = [&](auto x, int up) {
    for (auto& point : x) {
      const double angle = curvature * point.x();
      point.x() = std::sin(angle) / curvature;
      point[up] = (1 - std::cos(angle)) / curvature;
    }
    return x;
  };
  const auto segments = plate_surface<2>({1, 0}, 1, 0.1);
  Nodes<2> ignored;
  const double strip = energy_of<2>(*bending_elements<2>(segments, plate, true),
                                    roll(segments.vertices, 1), ignored);
  EXPECT_NEAR(strip, 0.5 * rigidity * curvature * curvature * 0.9, 2e-3 * strip);  // 9 hinges
  const auto triangles = plate_surface<3>({1, 0, 1}, 1, 0.1);
  Nodes<3> unused;
  const double sheet_energy = energy_of<3>(*bending_elements<3>(triangles, plate, true),
                                           roll(triangles.vertices, 1), unused);
  EXPECT_NEAR(sheet_energy, 0.5 * rigidity * curvature * curvature, 0.12 * sheet_energy);
  const auto ball = round_shell<3>();
  EXPECT_NEAR(energy_of<3>(*bending_elements<3>(ball, plate, false), ball.vertices, unused), 0,
              1e-25);
}

/// Springs and finite elements stretched alike along x: the force of a bar without (3D: free to
/// contract by nu = 1/3, which springs always have) lateral stress.
TEST(ShellElements, StretchedSheet) {
  const SheetMaterial cloth{100, 1. / 3, 0.02, 0};
  const auto mesh = plate_surface<3>({1, 0, 1}, 1, 0.2);
  const double strain = 1e-4;
  Nodes<3> x = mesh.vertices;
  for (auto& point : x) {
    point.x() *= 1 + strain;
    point.z() *= 1 - strain / 3;
  }
  for (const bool spring : {false, true}) {
    const auto group =
        spring ? membrane_springs<3>(mesh, cloth, 1, 0) : membrane_elements<3>(mesh, cloth, 1);
    Nodes<3> force;
    energy_of<3>(*group, x, force);
    double right = 0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      if (mesh.vertices[n].x() > 0.49)
        right -= force[n].x();
    }
    EXPECT_NEAR(right, 100 * 0.02 * strain, (spring ? 0.2 : 1e-3) * 2 * strain) << spring;
  }
}

TEST(ShellElements, PreStrainAndSurfaceTensionAreTension) {
  // A ring of tension T is pulled inwards by 2 pi T in all; a sphere's energy is T 4 pi r^2.
  const auto ring = ball_surface<2>(0.5, 0.02);
  Nodes<2> force;
  energy_of<2>(*surface_tension_elements<2>(ring, 3), ring.vertices, force);
  double inwards = 0;
  for (std::size_t n = 0; n < force.size(); ++n)
    inwards -= force[n].dot(ring.vertices[n].normalized());
  EXPECT_NEAR(inwards, 2 * pi * 3, 2e-3);
  const auto sphere = ball_surface<3>(0.5, 0.05);
  Nodes<3> ignored;
  EXPECT_NEAR(energy_of<3>(*surface_tension_elements<3>(sphere, 3), sphere.vertices, ignored),
              3 * pi, 2e-2);
  // A ring at 1.1 times its rest length: tension E' t (1.1^2 - 1)/2 * 1.1.
  const SheetMaterial rubber{100, 0, 0.02, 0};
  energy_of<2>(*membrane_elements<2>(ring, rubber, 1.1), ring.vertices, force);
  inwards = 0;
  for (std::size_t n = 0; n < force.size(); ++n)
    inwards -= force[n].dot(ring.vertices[n].normalized());
  EXPECT_NEAR(inwards, 2 * pi * 2 * 0.5 * (1.21 - 1) * 1.1, 1e-3);
}

template <int dim>
void check_collapsed_hinges() {
  // Half of a shell is squeezed to nothing: what is left must stay finite, and balanced.
  const SurfaceMesh<dim> mesh = round_shell<dim>();
  const auto group = bending_elements<dim>(mesh, sheet_material, true);
  for (const double squeeze : {0., 1e-12, 1e-5}) {
    SCOPED_TRACE(squeeze);
    Nodes<dim> x = shaken<dim>(mesh.vertices, 1, 0.02, 3), force;
    for (auto& point : x)
      point[0] *= point[0] > 0 ? squeeze : 1;
    energy_of<dim>(*group, x, force);
    Point<dim> sum = Point<dim>::Zero();
    AngularVector<dim> torque = AngularVector<dim>::Zero();
    double largest = 0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      sum += force[n];
      torque += cross<dim>(x[n], force[n]);
      largest = std::max(largest, force[n].norm());
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(sum.norm(), 1e-12 * largest);
    EXPECT_LT(torque.norm(), 1e-12 * largest);
    // Angles turn by pi within a thousandth of an edge at most.
    EXPECT_LT(largest, 1e4 * pi * 100 * std::pow(sheet_material.thickness, 3));
  }
}

TEST(ShellElements, CollapsedHingesPushFinitely) {
  check_collapsed_hinges<2>();
  check_collapsed_hinges<3>();
}

}  // namespace
}  // namespace lockstep::test
