#pragma once
#include <memory>
#include <vector>

#include "deformable/body_nodes.hpp"

namespace lockstep {

/// Forces of all elements and their derivatives, at positions of choice. ImplicitForces, which
/// chooses them, changes it; others read it.
template <int dim>
struct ElementForces {
  using Nodes = std::vector<Point<dim>>;
  /// `of_nodes` must outlive it and still know its numbers. All is zero before `assemble`. Local.
  ElementForces(const std::vector<DeformableBody<dim>>& bodies, const BodyNodes<dim>& of_nodes);
  /// Ends a step of dt [s] at positions x of all local nodes for laws with a memory. Returns false,
  /// on all ranks, if there are none. Local.
  bool end_step(const Nodes& x, double dt);
  /// All of the below at positions x of all local nodes [m]. Collective.
  void assemble(const Nodes& x);

  const BodyNodes<dim>& nodes;
  /// Elements of each body that touch nodes of this rank.
  std::vector<std::vector<std::unique_ptr<ElementGroup<dim>>>> elements;
  /// Elements whose law has a memory: their body, and their numbers among all of the group.
  struct Remembering {
    int body = 0;
    ElementGroup<dim>* group = nullptr;
    std::vector<int> numbers;
  };
  std::vector<Remembering> remembering;
  std::vector<double> softening;       ///< factor of each body's elastic forces in this step [1]
  std::vector<double> energy;          ///< elastic energy of each body on all ranks [J]
  Nodes elastic;                       ///< elastic force on the owned nodes [N]
  NodeMatrix<dim> stiffness, damping;  ///< K [N/m], B [N s/m]
  GlobalIndex n_clamped = 0;           ///< elements whose K was changed, on all ranks
  unsigned number = 0;                 ///< another one after each assembly
};

}  // namespace lockstep
