#include "deformable/elements/volume_elements.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "deformable/elements/element_list.hpp"
#include "deformable/materials/tensor_products.hpp"

namespace lockstep {

namespace {

template <int dim>
struct VolumeElement {
  std::array<int, dim + 1> corners;
  Eigen::Matrix<double, dim, dim + 1>
      gradients;  ///< gradients of the shape functions at rest [1/m]
  double volume;  ///< at rest [m^dim]
};

/// A law without a memory: that of element e is that of all.
template <int dim>
struct ElasticLaw {
  std::shared_ptr<const Material<dim>> material;

  double energy_density(const Tensor<dim>& f, std::ptrdiff_t) const {
    return material->energy_density(f);
  }
  Tensor<dim> stress(const Tensor<dim>& f, std::ptrdiff_t) const { return material->stress(f); }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f, std::ptrdiff_t) const {
    return material->stress_derivative(f);
  }
  static int n_state() { return 0; }
  static std::vector<double>* all_states() { return nullptr; }
  void end_step(const Tensor<dim>&, std::ptrdiff_t, double) {}
};

/// A law with a memory, and the states of all elements.
template <int dim>
struct RememberingLaw {
  std::shared_ptr<const Material<dim>> material;
  std::vector<double> states;

  double energy_density(const Tensor<dim>& f, std::ptrdiff_t e) const {
    return material->energy_density(f) + memory().energy_density(f, state(e));
  }
  Tensor<dim> stress(const Tensor<dim>& f, std::ptrdiff_t e) const {
    return material->stress(f) + memory().stress(f, state(e));
  }
  TensorDerivative<dim> stress_derivative(const Tensor<dim>& f, std::ptrdiff_t e) const {
    return material->stress_derivative(f) + memory().stress_derivative(f, state(e));
  }
  int n_state() const { return memory().n_state(); }
  std::vector<double>* all_states() { return &states; }
  void end_step(const Tensor<dim>& f, std::ptrdiff_t e, double dt) {
    memory().end_step(f, dt, Eigen::Map<Eigen::VectorXd>(&states[e * n_state()], n_state()));
  }

 private:
  const MaterialMemory<dim>& memory() const { return *material->memory(); }
  Eigen::Map<const Eigen::VectorXd> state(std::ptrdiff_t e) const {
    return {&states[e * n_state()], n_state()};
  }
};

template <int dim, typename Law>
class VolumeElements : public ElementList<dim, VolumeElement<dim>, VolumeElements<dim, Law>> {
 public:
  using Nodes = typename ElementGroup<dim>::Nodes;

  VolumeElements(const VolumeMesh<dim>& rest, Law law, const StrainRateDamping& damping)
      : law_(std::move(law)), damping_(damping) {
    for (int e = 0; e < static_cast<int>(rest.elements.size()); ++e) {
      VolumeElement<dim> element;
      element.corners = rest.elements[e];
      element.volume = element_volume(rest, e);
      Tensor<dim> edges;
      for (int k = 0; k < dim; ++k)
        edges.col(k) = rest.vertices[element.corners[k + 1]] - rest.vertices[element.corners[0]];
      element.gradients.template rightCols<dim>() = edges.inverse().transpose();
      element.gradients.col(0) = -element.gradients.template rightCols<dim>().rowwise().sum();
      elements_.push_back(element);
    }
  }

  double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const override {
    double energy = 0;
    for (const auto& element : elements_) {
      const Tensor<dim> f = deformation_gradient(element, x);
      const Tensor<dim> pull = -element.volume * law_.stress(f, number(element));
      // The first corner takes what keeps the sum at zero.
      Point<dim> rest = Point<dim>::Zero();
      for (int k = 1; k <= dim; ++k) {
        const Point<dim> part = pull * element.gradients.col(k);
        force[element.corners[k]] += part;
        rest -= part;
      }
      force[element.corners[0]] += rest;
      if (element.corners[0] < n_owned)
        energy += element.volume * law_.energy_density(f, number(element));
    }
    return energy;
  }

  void add_states(const Nodes& x, int n_owned, ElementStates& states) const override {
    constexpr double flattest = 1e-6;  // an element that inverts has no stress per area
    for (const auto& element : elements_) {
      if (element.corners[0] >= n_owned)
        continue;
      const Tensor<dim> f = deformation_gradient(element, x);
      Eigen::Matrix3d stress = Eigen::Matrix3d::Zero(), strain = Eigen::Matrix3d::Zero();
      stress.topLeftCorner<dim, dim>() = law_.stress(f, number(element)) * f.transpose() /
                                         std::max(std::abs(f.determinant()), flattest);
      strain.topLeftCorner<dim, dim>() = 0.5 * (f.transpose() * f - Tensor<dim>::Identity());
      states.corners.insert(states.corners.end(), element.corners.begin(), element.corners.end());
      states.stress.push_back(stress);
      states.strain.push_back(strain);
      states.energy_density.push_back(law_.energy_density(f, number(element)));
    }
  }

  int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const override {
    int n_clamped = 0;
    for (const auto& element : elements_) {
      TensorDerivative<dim> derivative =
          law_.stress_derivative(deformation_gradient(element, x), number(element));
      const bool clamped = clamp_eigenvalues<dim * dim>(derivative);
      n_clamped += clamped && element.corners[0] < stiffness.n_rows() ? 1 : 0;
      add_matrix(element, derivative, stiffness);
    }
    return n_clamped;
  }

  void add_damping(const Nodes& x, NodeMatrix<dim>& damping) const override {
    if (!damping_.active())
      return;
    for (const auto& element : elements_) {
      const Tensor<dim> f = deformation_gradient(element, x);
      const auto derivative = matrix_of<dim>([&](const Tensor<dim>& rate) -> Tensor<dim> {
        const Tensor<dim> product = f.transpose() * rate;
        const Tensor<dim> green = 0.5 * (product + product.transpose());
        return f * (2 * damping_.shear * green +
                    damping_.bulk * green.trace() * Tensor<dim>::Identity());
      });
      add_matrix(element, derivative, damping);
    }
  }

  int n_state() const override { return law_.n_state(); }
  std::vector<double>* states() override { return law_.all_states(); }
  void end_step(const Nodes& x, double dt) override {
    for (const auto& element : elements_)
      law_.end_step(deformation_gradient(element, x), number(element), dt);
  }

 private:
  using ElementList<dim, VolumeElement<dim>, VolumeElements<dim, Law>>::elements_;

  std::ptrdiff_t number(const VolumeElement<dim>& element) const {
    return &element - elements_.data();
  }

  static Tensor<dim> deformation_gradient(const VolumeElement<dim>& element, const Nodes& x) {
    Tensor<dim> f = Tensor<dim>::Zero();
    for (int k = 1; k <= dim; ++k) {
      const Point<dim> edge = x[element.corners[k]] - x[element.corners[0]];
      f += edge * element.gradients.col(k).transpose();
    }
    return f;
  }

  /// volume g_i : dP/dF : g_j on the corners i and j.
  static void add_matrix(const VolumeElement<dim>& element, const TensorDerivative<dim>& derivative,
                         NodeMatrix<dim>& matrix) {
    for (int j = 0; j <= dim; ++j) {
      Eigen::Matrix<double, dim * dim, dim> column = Eigen::Matrix<double, dim * dim, dim>::Zero();
      for (int b = 0; b < dim; ++b)
        column += element.gradients(b, j) * derivative.template middleCols<dim>(dim * b);
      for (int i = 0; i <= dim; ++i) {
        Tensor<dim> block = Tensor<dim>::Zero();
        for (int a = 0; a < dim; ++a)
          block += element.gradients(a, i) * column.template middleRows<dim>(dim * a);
        matrix.add(element.corners[i], element.corners[j], element.volume * block);
      }
    }
  }

  Law law_;
  StrainRateDamping damping_;
};

}  // namespace

template <int n>
bool clamp_eigenvalues(Eigen::Matrix<double, n, n>& matrix) {
  using Matrix = Eigen::Matrix<double, n, n>;
  const double roundoff = 1e-12 * matrix.diagonal().cwiseAbs().maxCoeff();
  // Cheaper than eigenvalues, and most elements pass.
  if (Eigen::LLT<Matrix>(matrix + roundoff * Matrix::Identity()).info() == Eigen::Success)
    return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix);
  if (eigen.eigenvalues()[0] >= -roundoff)
    return false;
  const Eigen::Matrix<double, n, 1> values = eigen.eigenvalues().cwiseMax(0);
  matrix = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  return true;
}

template <int dim>
std::unique_ptr<ElementGroup<dim>> volume_elements(const VolumeMesh<dim>& rest,
                                                   std::shared_ptr<const Material<dim>> material,
                                                   const StrainRateDamping& damping) {
  if (material->memory() == nullptr)
    return std::make_unique<VolumeElements<dim, ElasticLaw<dim>>>(
        rest, ElasticLaw<dim>{std::move(material)}, damping);
  std::vector<double> states(rest.elements.size() * material->memory()->n_state(), 0);
  return std::make_unique<VolumeElements<dim, RememberingLaw<dim>>>(
      rest, RememberingLaw<dim>{std::move(material), std::move(states)}, damping);
}

template bool clamp_eigenvalues<4>(Eigen::Matrix<double, 4, 4>&);
template bool clamp_eigenvalues<9>(Eigen::Matrix<double, 9, 9>&);
template std::unique_ptr<ElementGroup<2>> volume_elements<2>(const VolumeMesh<2>&,
                                                             std::shared_ptr<const Material<2>>,
                                                             const StrainRateDamping&);
template std::unique_ptr<ElementGroup<3>> volume_elements<3>(const VolumeMesh<3>&,
                                                             std::shared_ptr<const Material<3>>,
                                                             const StrainRateDamping&);

}  // namespace lockstep
