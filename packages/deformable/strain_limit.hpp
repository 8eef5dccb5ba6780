#pragma once
#include <vector>

#include "deformable/node_space.hpp"

namespace lockstep {

/// An edge that may not grow longer.
struct LimitedEdge {
  std::array<int, 2> corners;
  double longest = 0;  ///< [m]
};

/// The edges of a surface of `simplices`, each at most 1 + stretch times as long as at rest; the
/// mesh is the sheet at rest stretched by `mesh_stretch`.
template <int dim>
std::vector<LimitedEdge> limited_edges(const std::vector<Point<dim>>& vertices,
                                       const std::vector<std::array<int, dim>>& simplices,
                                       double mesh_stretch, double stretch);

/// Strain limiting of velocities (Provot 1995, Bridson et al. 2003): equal and opposite impulses
/// along edges, so that moving by dt leaves none too long. Edges are visited colour by colour:
/// those of one colour share no node, so the result does not depend on the number of ranks.
template <int dim>
class StrainLimit {
 public:
  using Nodes = std::vector<Point<dim>>;
  StrainLimit() = default;
  /// Edges of all bodies in original numbers; keeps those that touch a node of this rank.
  StrainLimit(const std::vector<LimitedEdge>& edges, const NodeSpace<dim>& space, int rank);

  /// No edges on any rank?
  bool empty() const { return colors_.empty(); }
  /// Changes the velocities of the local nodes at positions x; `inverse_mass` of each along each
  /// axis, zero where it is held [1/kg]. Adds the impulses to `impulse`, those on held nodes
  /// included, complete on owned nodes. Returns the largest stretch beyond the limit that is left,
  /// relative to the longest length. Collective.
  double apply(const Nodes& x, const Nodes& inverse_mass, double dt, const NodeSpace<dim>& space,
               Nodes& velocity, Nodes& impulse) const;

 private:
  /// Edges without common nodes, in local numbers, and the nodes that other ranks' edges of them
  /// change.
  struct Color {
    std::vector<LimitedEdge> edges;
    RCP<const Import> import;  ///< import of the ghosts' velocities; null: one rank
    std::vector<int> ghosts;   ///< in the order of the import
    std::vector<int> owned;    ///< owned nodes that may be ghosts of others
  };
  void prepare_exchange(Color& color, const std::vector<char>& is_changed,
                        const NodeSpace<dim>& space) const;
  void exchange(const Color& color, Vector& sent, Nodes& velocity) const;
  double sweep(const std::vector<LimitedEdge>& edges, const Nodes& x, const Nodes& inverse_mass,
               double dt, Nodes& velocity, Nodes& impulse) const;

  std::vector<Color> colors_;
};

}  // namespace lockstep
