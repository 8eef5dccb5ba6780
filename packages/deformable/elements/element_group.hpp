#pragma once
#include <memory>
#include <vector>

#include "deformable/elements/node_matrix.hpp"

namespace lockstep {

/// Stress and strain of elements, for output. In 2D the entries of z are zero.
struct ElementStates {
  std::vector<int> corners;             ///< corners, those of an element together
  std::vector<Eigen::Matrix3d> stress;  ///< Cauchy's, of forces beside the damping [Pa]
  std::vector<Eigen::Matrix3d> strain;  ///< Green's; of sheets turned into their planes [1]
  std::vector<double> energy_density;   ///< per volume at rest [J/m^3]
};

/// Elements of one kind and law that pull on their corners, as one rank holds them. Positions,
/// velocities and forces are indexed by local node number; of the nodes of other ranks (ghosts)
/// only positions and velocities count, forces on them may be left anything.
template <int dim>
class ElementGroup {
 public:
  using Nodes = std::vector<Point<dim>>;
  virtual ~ElementGroup() = default;

  /// The corners of all elements.
  virtual ElementCorners corners() const = 0;
  /// The elements `kept`, in that order, with node n renamed to number[n].
  virtual std::unique_ptr<ElementGroup> restricted(const std::vector<int>& kept,
                                                   const std::vector<int>& number) const = 0;

  /// Adds the elastic forces [N] and returns the energy [J] of the elements whose first corner is
  /// below `n_owned`.
  virtual double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const = 0;
  /// Appends the elements whose first corner is below `n_owned`; of springs nothing.
  virtual void add_states(const Nodes&, int /*n_owned*/, ElementStates&) const {}
  /// Adds K = -d force / dx [N/m], made positive semidefinite element by element; returns how many
  /// elements (counted as above) had to be changed for it.
  virtual int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const = 0;
  /// Adds B [N s/m], damping force = -B v: symmetric positive semidefinite, zero for rigid motions.
  virtual void add_damping(const Nodes& x, NodeMatrix<dim>& damping) const = 0;

  /// Numbers that a law with a memory keeps of each element; 0: it has none.
  virtual int n_state() const { return 0; }
  /// The states, of one element after the other; null: the law has no memory.
  virtual std::vector<double>* states() { return nullptr; }
  /// Changes them over a step of dt [s] that ends at x.
  virtual void end_step(const Nodes& /*x*/, double /*dt*/) {}

 protected:
  ElementGroup() = default;
  ElementGroup(const ElementGroup&) = default;
  ElementGroup& operator=(const ElementGroup&) = default;
};

}  // namespace lockstep
