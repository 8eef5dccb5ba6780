#pragma once
#include <string>
#include <utility>
#include <vector>

#include "deformable/deformable_body.hpp"
#include "deformable/node_space.hpp"

namespace lockstep {

/// The parts of a body that do not change in a run.
struct SoftBody {
  std::string name;
  bool closed = true, consistent_mass = false;
  TimeIntegration integration = TimeIntegration::fully_implicit;
  int most_sub_steps = 1;
  double mass = 0, measure = 0;      ///< [kg]; volume (cloth: area) as meshed
  double fluid_mass = 0;             ///< mass of fluid that it carries along, about [kg]
  int node_begin = 0, node_end = 0;  ///< original numbers

  bool is_explicit() const { return integration == TimeIntegration::explicit_forces; }
  bool is_second_order() const { return integration == TimeIntegration::second_order; }
  /// True if its elasticity is implicit.
  bool is_implicit() const {
    return integration == TimeIntegration::fully_implicit || is_second_order();
  }
};

/// The nodes of all bodies on this rank: masses, loads and holds, which last, and the state. The
/// parts of the model read it, DeformableSolids alone changes it.
template <int dim>
struct BodyNodes {
  using Nodes = std::vector<Point<dim>>;
  /// Gravity [m/s^2], the start of the run [s]. Keeps `space.numbers()` for the other parts'
  /// set-up. Collective.
  BodyNodes(const std::vector<DeformableBody<dim>>& bodies, const Point<dim>& gravity,
            const Communicator& comm, double start_time);

  int n_owned() const { return space.n_owned(); }
  int n_bodies() const { return static_cast<int>(bodies.size()); }
  const SoftBody& body(int node) const { return bodies[body_of[node]]; }
  /// A bound of the eigenvalues of M_S at an owned node [kg].
  double least_mass(int node) const {
    return mass[node] / (body(node).consistent_mass ? dim + 2 : 1);
  }
  /// Sets values of owned nodes to zero where they are held or carried.
  void hold(Nodes& values) const;
  /// The bodies of which nothing is held or carried; the same on all ranks. Collective.
  std::vector<char> free_bodies() const;

  Communicator comm;
  Point<dim> gravity;
  std::vector<SoftBody> bodies;
  NodeSpace<dim> space;
  std::vector<int> body_of;   ///< body of the local nodes
  std::vector<double> mass;   ///< lumped, of the owned nodes [kg]
  std::vector<double> share;  ///< share of the owned nodes in their body's measure, sum 1
  Nodes load;                 ///< constant loads on them [N]
  HeldNodes<dim> held;
  std::vector<std::pair<int, std::string>> attached;  ///< owned nodes and their carriers
  RCP<const LinearOperator> mass_matrix;              ///< M_S
  Nodes x;                                            ///< positions of all local nodes [m]
  RCP<const Vector> velocity;                         ///< V_S
};

/// `corners` of a body's own nodes in original numbers.
ElementCorners shifted(ElementCorners corners, int node_begin);

}  // namespace lockstep
