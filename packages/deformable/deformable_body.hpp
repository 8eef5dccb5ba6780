#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "deformable/elements/element_group.hpp"
#include "deformable/held_nodes.hpp"
#include "deformable/strain_limit.hpp"

namespace lockstep {

/// Time integration of a body's forces (docs/method.md: D in Eq. 16).
enum class TimeIntegration {
  explicit_forces,  ///< D = 0: elasticity and damping at the present state
  semi_implicit,    ///< D = -B: elasticity at the present positions, implicit damping
  fully_implicit,   ///< D(dt) = -(B + dt K): both linearised at the present positions
  second_order      ///< fully implicit in S1; in S2 D(dt) = -(B + dt/2 K), both linearised halfway
};

/// One deformable body at the start, in nodes of its own, from which the model is made.
template <int dim>
struct DeformableBody {
  std::string name;
  bool closed = true;  ///< a volume; false: a thin shell
  double density = 0;  ///< [kg/m^dim], of a shell [kg/m^(dim-1)]
  double fluid_density =
      0;  ///< density of the fluid that it carries along, about, per the same measure
  double restitution = 0, friction = 0;
  TimeIntegration integration = TimeIntegration::fully_implicit;
  int most_sub_steps =
      1;  ///< most sub-steps that average its elastic forces; 1: its stable step bounds the step
  bool consistent_mass =
      false;  ///< true: mass matrix of the finite elements; false: lumped to the nodes

  std::vector<Point<dim>> position;           ///< positions of the nodes [m]
  std::vector<Point<dim>> velocity;           ///< [m/s]
  std::vector<std::array<int, dim>> surface;  ///< simplices of nodes, normals outwards
  std::vector<std::array<bool, dim>> locked;  ///< per node and axis: held at the start
  std::vector<NodeHold<dim>> holds;           ///< held nodes that move or are let go
  std::vector<std::pair<int, std::string>>
      attached;                   ///< nodes and the rigid solids that carry them
  std::vector<Point<dim>> force;  ///< constant load on each node [N]
  std::vector<std::unique_ptr<ElementGroup<dim>>> elements;
  /// Simplices of even mass. Nodes of none (the anchors of tethers) must be locked.
  ElementCorners mass_elements;
  /// Measure of each element as meshed: volume, or area of cloth [m^dim, m^(dim-1)]; times density
  /// it is its mass.
  std::vector<double> element_measure;

  std::vector<LimitedEdge> limited_edges;  ///< edges that may not stretch further

  int n_nodes() const { return static_cast<int>(position.size()); }
};

}  // namespace lockstep
