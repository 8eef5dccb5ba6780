#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace lockstep {

/// Deformation gradient F = dx/dX, stress, ... at a point.
template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

/// dP/dF: entry (a + dim i, b + dim j) is dP_ai / dF_bj, as for columns stacked to a vector.
/// Symmetric.
template <int dim>
using TensorDerivative = Eigen::Matrix<double, dim * dim, dim * dim>;

/// Lamé's constants [Pa].
struct LameConstants {
  double lambda = 0, mu = 0;
};

/// Returns Lamé's constants for Young's modulus [Pa] and Poisson's ratio in (-1, 0.5). Throws
/// InputError.
LameConstants lame_constants(double youngs_modulus, double poisson_ratio);

/// Side of a law whose stress depends on the past, by a state of some numbers in each element: what
/// it adds to the energy and the stress of the law. While a step is solved states stay as they are,
/// and the law is hyperelastic; they change where the step ends, at the shape that it has reached.
/// All functions are local, and depend on their arguments alone.
template <int dim>
class MaterialMemory {
 public:
  using State = Eigen::Ref<const Eigen::VectorXd>;
  virtual ~MaterialMemory() = default;
  /// Size of a state, whose numbers are 0 in a body as it is meshed.
  virtual int n_state() const = 0;
  /// Energy per volume at rest [J/m^3].
  virtual double energy_density(const Tensor<dim>& f, const State& state) const = 0;
  /// d energy / dF [Pa].
  virtual Tensor<dim> stress(const Tensor<dim>& f, const State& state) const = 0;
  /// d stress / dF [Pa].
  virtual TensorDerivative<dim> stress_derivative(const Tensor<dim>& f,
                                                  const State& state) const = 0;
  /// Changes a state over a step of dt [s] that ends at f, by which energy may fall but not rise.
  virtual void end_step(const Tensor<dim>& f, double dt,
                        Eigen::Ref<Eigen::VectorXd> state) const = 0;

 protected:
  MaterialMemory() = default;
  MaterialMemory(const MaterialMemory&) = default;
  MaterialMemory& operator=(const MaterialMemory&) = default;
};

/// A hyperelastic law. In 2D it is that of plane strain: F_zz = 1.
template <int dim>
class Material {
 public:
  virtual ~Material() = default;
  /// Elastic energy per volume at rest [J/m^3]; zero at rest.
  virtual double energy_density(const Tensor<dim>& f) const = 0;
  /// First Piola-Kirchhoff stress P = d energy / dF [Pa]; zero at rest.
  virtual Tensor<dim> stress(const Tensor<dim>& f) const = 0;
  /// dP/dF [Pa].
  virtual TensorDerivative<dim> stress_derivative(const Tensor<dim>& f) const = 0;
  /// Hooke's law of small strains, by which damping is scaled [Pa]. Default: that of
  /// `stress_derivative` at rest along the first axis, and of shear in the first plane.
  virtual LameConstants at_rest() const;
  /// True if rotations strain it, so that they count from the start. Local.
  virtual bool feels_rotations() const { return false; }
  /// Part that depends on the past, and is added; null: none. Lives as long as the law.
  virtual const MaterialMemory<dim>* memory() const { return nullptr; }

 protected:
  Material() = default;
  Material(const Material&) = default;
  Material& operator=(const Material&) = default;
};

/// Small strain about the reference position: for small displacements and rotations only, does not
/// conserve angular momentum beyond them. Linear.
template <int dim>
std::unique_ptr<Material<dim>> linear_elasticity(const LameConstants& lame);

/// Linear in the strain S - I of F = R S. The rotation R of an inverted element is that of the
/// nearest upright shape, so that it turns back.
template <int dim>
std::unique_ptr<Material<dim>> corotated(const LameConstants& lame);

/// Linear in Green's strain. Weak under strong compression: a crushed element offers no resistance
/// and may invert.
template <int dim>
std::unique_ptr<Material<dim>> st_venant_kirchhoff(const LameConstants& lame);

/// Stable neo-Hookean after Smith, de Goes and Kim (2018), Eq. 14: finite and with restoring forces
/// at every F, inverted ones included.
template <int dim>
std::unique_ptr<Material<dim>> neo_hookean(const LameConstants& lame);

/// Adds a `stiffness` [Pa] against stretches beyond four to a material: nodes inside a body too
/// soft for its weight have nothing else that keeps them from falling out of it. Returns the
/// material itself if that is 0.
template <int dim>
std::unique_ptr<Material<dim>> held_together(std::unique_ptr<Material<dim>> material,
                                             double stiffness);

}  // namespace lockstep
