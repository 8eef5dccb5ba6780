#include <Eigen/Dense>
#include <cmath>

#include "base/round_off.hpp"
#include "deformable/elements/element_list.hpp"
#include "deformable/elements/shell_elements.hpp"

namespace lockstep {

namespace {

/// Tensors of the surface, and what maps it to space.
template <int dim>
using SurfaceTensor = Eigen::Matrix<double, dim - 1, dim - 1>;
template <int dim>
using SurfaceGradient = Eigen::Matrix<double, dim, dim - 1>;

template <int dim>
struct MembraneElement {
  std::array<int, dim> corners;
  Eigen::Matrix<double, dim - 1, dim>
      gradients;  ///< gradients of the shape functions in the sheet [1/m]
  double volume;  ///< area at rest times thickness
};

/// Gradients of the shape functions of a simplex of space in an orthonormal basis of its plane.
template <int dim>
Eigen::Matrix<double, dim - 1, dim> plane_gradients(const SurfaceGradient<dim>& edges) {
  SurfaceTensor<dim> flat;
  if constexpr (dim == 2) {
    flat(0, 0) = edges.norm();
  } else {
    const Point<3> first = edges.col(0).normalized();
    const Point<3> second = (edges.col(1) - first.dot(edges.col(1)) * first).normalized();
    flat << first.dot(edges.col(0)), first.dot(edges.col(1)), 0, second.dot(edges.col(1));
  }
  Eigen::Matrix<double, dim - 1, dim> gradients;
  gradients.template rightCols<dim - 1>() = flat.inverse().transpose();
  gradients.col(0) = -gradients.template rightCols<dim - 1>().rowwise().sum();
  return gradients;
}

template <int dim>
SurfaceGradient<dim> edges_of(const std::array<int, dim>& corners,
                              const std::vector<Point<dim>>& x) {
  SurfaceGradient<dim> edges;
  for (int k = 1; k < dim; ++k)
    edges.col(k - 1) = x[corners[k]] - x[corners[0]];
  return edges;
}

template <int dim>
std::array<Point<dim>, dim> points_of(const std::array<int, dim>& corners,
                                      const std::vector<Point<dim>>& x) {
  std::array<Point<dim>, dim> points;
  for (int k = 0; k < dim; ++k)
    points[k] = x[corners[k]];
  return points;
}

/// Second Piola stress lambda tr(E) + 2 mu E in plane stress (3D), or plane strain along the
/// missing direction (2D).
template <int dim>
class MembraneElements : public ElementList<dim, MembraneElement<dim>, MembraneElements<dim>> {
 public:
  using Nodes = typename ElementGroup<dim>::Nodes;

  MembraneElements(const SurfaceMesh<dim>& mesh, const SheetMaterial& sheet, double stretch)
      : damping_(sheet.damping) {
    const double e = sheet.youngs_modulus, nu = sheet.poisson_ratio;
    lambda_ = dim == 2 ? 0 : e * nu / (1 - nu * nu);
    mu_ = dim == 2 ? 0.5 * e / (1 - nu * nu) : 0.5 * e / (1 + nu);
    for (const auto& simplex : mesh.simplices) {
      MembraneElement<dim> element;
      element.corners = simplex;
      element.gradients = plane_gradients<dim>(edges_of<dim>(simplex, mesh.vertices)) * stretch;
      element.volume = area_vector<dim>(points_of<dim>(simplex, mesh.vertices)).norm() *
                       sheet.thickness / std::pow(stretch, dim - 1);
      elements_.push_back(element);
    }
  }

  double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const override {
    double energy = 0;
    for (const auto& element : elements_) {
      const SurfaceGradient<dim> f = gradient(element, x);
      const SurfaceTensor<dim> strain = strain_of(f), s = stress(strain);
      const SurfaceGradient<dim> pull = -element.volume * f * s;
      Point<dim> rest = Point<dim>::Zero();
      for (int k = 1; k < dim; ++k) {
        const Point<dim> part = pull * element.gradients.col(k);
        force[element.corners[k]] += part;
        rest -= part;
      }
      force[element.corners[0]] += rest;
      if (element.corners[0] < n_owned)
        energy += 0.5 * element.volume * s.cwiseProduct(strain).sum();
    }
    return energy;
  }

  void add_states(const Nodes& x, int n_owned, ElementStates& states) const override {
    for (const auto& element : elements_) {
      if (element.corners[0] >= n_owned)
        continue;
      const SurfaceGradient<dim> f = gradient(element, x);
      const SurfaceTensor<dim> strain = strain_of(f), s = stress(strain);
      Eigen::Matrix3d in_space = Eigen::Matrix3d::Zero(), turned = Eigen::Matrix3d::Zero();
      const Eigen::SelfAdjointEigenSolver<SurfaceTensor<dim>> squared(f.transpose() * f);
      // F = Q U; Q turns the sheet into its plane. An element without area has none.
      constexpr double no_area = 1e-20;
      if (squared.eigenvalues().minCoeff() > no_area) {
        const SurfaceGradient<dim> q = f * squared.operatorInverseSqrt();
        const double stretch = squared.operatorSqrt().determinant();
        in_space.topLeftCorner<dim, dim>() = f * s * f.transpose() / stretch;
        turned.topLeftCorner<dim, dim>() = q * strain * q.transpose();
      }
      states.corners.insert(states.corners.end(), element.corners.begin(), element.corners.end());
      states.stress.push_back(in_space);
      states.strain.push_back(turned);
      states.energy_density.push_back(0.5 * s.cwiseProduct(strain).sum());
    }
  }

  /// Compression counts as no stress: its geometric stiffness is what is not definite.
  int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const override {
    int n_clamped = 0;
    for (const auto& element : elements_) {
      const SurfaceGradient<dim> f = gradient(element, x);
      const Eigen::SelfAdjointEigenSolver<SurfaceTensor<dim>> eigen(stress(strain_of(f)));
      const double round_off = rounding::sums * (lambda_ + mu_);
      if (eigen.eigenvalues().minCoeff() < -round_off && element.corners[0] < stiffness.n_rows())
        ++n_clamped;
      const SurfaceTensor<dim> tension = eigen.eigenvectors() *
                                         eigen.eigenvalues().cwiseMax(0).asDiagonal() *
                                         eigen.eigenvectors().transpose();
      add_matrix(element, f, tension, 1, stiffness);
    }
    return n_clamped;
  }
  void add_damping(const Nodes& x, NodeMatrix<dim>& damping) const override {
    for (const auto& element : elements_)
      add_matrix(element, gradient(element, x), SurfaceTensor<dim>::Zero(), damping_, damping);
  }

 private:
  using ElementList<dim, MembraneElement<dim>, MembraneElements<dim>>::elements_;

  static SurfaceGradient<dim> gradient(const MembraneElement<dim>& element, const Nodes& x) {
    return edges_of<dim>(element.corners, x) *
           element.gradients.template rightCols<dim - 1>().transpose();
  }
  static SurfaceTensor<dim> strain_of(const SurfaceGradient<dim>& f) {
    return 0.5 * (f.transpose() * f - SurfaceTensor<dim>::Identity());
  }
  SurfaceTensor<dim> stress(const SurfaceTensor<dim>& strain) const {
    return 2 * mu_ * strain + lambda_ * strain.trace() * SurfaceTensor<dim>::Identity();
  }

  /// Geometric stiffness of `tension`, plus `factor` times that of the material.
  void add_matrix(const MembraneElement<dim>& element, const SurfaceGradient<dim>& f,
                  const SurfaceTensor<dim>& tension, double factor, NodeMatrix<dim>& matrix) const {
    using Square = Eigen::Matrix<double, dim, dim>;
    for (int i = 0; i < dim; ++i) {
      const auto gi = element.gradients.col(i);
      for (int j = 0; j < dim; ++j) {
        const auto gj = element.gradients.col(j);
        const SurfaceTensor<dim> c = mu_ * gi.dot(gj) * SurfaceTensor<dim>::Identity() +
                                     mu_ * gj * gi.transpose() + lambda_ * gi * gj.transpose();
        const Square block =
            gi.dot(tension * gj) * Square::Identity() + factor * f * c * f.transpose();
        matrix.add(element.corners[i], element.corners[j], element.volume * block);
      }
    }
  }

  double lambda_, mu_, damping_;
};

template <int dim>
struct TensionElement {
  std::array<int, dim> corners;
};

template <int dim>
class SurfaceTensionElements
    : public ElementList<dim, TensionElement<dim>, SurfaceTensionElements<dim>> {
 public:
  using Nodes = typename ElementGroup<dim>::Nodes;

  SurfaceTensionElements(const SurfaceMesh<dim>& mesh, double tension) : tension_(tension) {
    for (const auto& simplex : mesh.simplices)
      elements_.push_back({simplex});
  }

  double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const override {
    double energy = 0;
    for (const auto& element : elements_) {
      const double area = area_vector<dim>(points_of<dim>(element.corners, x)).norm();
      if (area == 0)
        continue;
      // d area / dx_k = area grad N_k, tangential; grad N_k = edges G^T, G of the present shape.
      const SurfaceGradient<dim> edges = edges_of<dim>(element.corners, x);
      const auto gradients = tangential_gradients(edges);
      Point<dim> rest = Point<dim>::Zero();
      for (int k = 1; k < dim; ++k) {
        const Point<dim> part = -tension_ * area * gradients.col(k);
        force[element.corners[k]] += part;
        rest -= part;
      }
      force[element.corners[0]] += rest;
      if (element.corners[0] < n_owned)
        energy += tension_ * area;
    }
    return energy;
  }
  /// Adds the stiffness of Dirichlet's energy on the present surface, which bounds the area's from
  /// above.
  int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const override {
    for (const auto& element : elements_) {
      const double area = area_vector<dim>(points_of<dim>(element.corners, x)).norm();
      if (area == 0)
        continue;
      const auto gradients = tangential_gradients(edges_of<dim>(element.corners, x));
      for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim; ++j) {
          stiffness.add(element.corners[i], element.corners[j],
                        tension_ * area * gradients.col(i).dot(gradients.col(j)) *
                            Eigen::Matrix<double, dim, dim>::Identity());
        }
      }
    }
    return 0;
  }
  void add_damping(const Nodes&, NodeMatrix<dim>&) const override {}

 private:
  using ElementList<dim, TensionElement<dim>, SurfaceTensionElements<dim>>::elements_;

  static Eigen::Matrix<double, dim, dim> tangential_gradients(const SurfaceGradient<dim>& edges) {
    Eigen::Matrix<double, dim, dim> gradients;
    const SurfaceTensor<dim> metric = edges.transpose() * edges;
    gradients.template rightCols<dim - 1>() = edges * metric.inverse();
    gradients.col(0) = -gradients.template rightCols<dim - 1>().rowwise().sum();
    return gradients;
  }

  double tension_;
};

}  // namespace

template <int dim>
std::unique_ptr<ElementGroup<dim>> membrane_elements(const SurfaceMesh<dim>& mesh,
                                                     const SheetMaterial& sheet, double stretch) {
  return std::make_unique<MembraneElements<dim>>(mesh, sheet, stretch);
}

template <int dim>
std::unique_ptr<ElementGroup<dim>> surface_tension_elements(const SurfaceMesh<dim>& mesh,
                                                            double tension) {
  return std::make_unique<SurfaceTensionElements<dim>>(mesh, tension);
}

template std::unique_ptr<ElementGroup<2>> membrane_elements<2>(const SurfaceMesh<2>&,
                                                               const SheetMaterial&, double);
template std::unique_ptr<ElementGroup<3>> membrane_elements<3>(const SurfaceMesh<3>&,
                                                               const SheetMaterial&, double);
template std::unique_ptr<ElementGroup<2>> surface_tension_elements<2>(const SurfaceMesh<2>&,
                                                                      double);
template std::unique_ptr<ElementGroup<3>> surface_tension_elements<3>(const SurfaceMesh<3>&,
                                                                      double);

}  // namespace lockstep
