#pragma once
#include <initializer_list>
#include <vector>

#include "deformable/body_nodes.hpp"
#include "interfaces/solid.hpp"

namespace lockstep {

/// The surfaces of all bodies, replicated: each vertex is a node.
template <int dim>
class NodalSurface {
 public:
  using Nodes = std::vector<Point<dim>>;
  /// `nodes` must outlive it and still know its numbers. Vertices are where `move` puts them.
  /// Local.
  NodalSurface(const std::vector<DeformableBody<dim>>& bodies, const BodyNodes<dim>& nodes);

  const std::vector<SolidDescription>& solids() const { return solids_; }
  const SurfaceMesh<dim>& mesh() const { return mesh_; }
  /// The barycentric weights of the vertices' dofs.
  void velocity_row(const SurfacePoint<dim>& point, VelocityRow<dim>& row) const;
  /// Velocities of the vertices in the last move [m/s], and of a point between them.
  const Nodes& velocity() const { return velocity_; }
  Point<dim> velocity_at(const SurfacePoint<dim>& point) const;
  /// Puts the vertices where the nodes are; `velocity` takes them there [m/s], of all owned nodes.
  /// Collective.
  void move(const Nodes& velocity);
  /// Places the vertices without a move; `velocity` of each vertex. Collective.
  void place(Nodes velocity);

  /// Several values of this rank's nodes at all vertices, by one message. Collective.
  std::vector<Nodes> gather(std::initializer_list<const Nodes*> of_nodes) const;
  /// The vertex' node if this rank owns it, else -1.
  int own_node(int vertex) const { return own_node_[vertex]; }
  /// Values of vertices at the corners of a simplex.
  std::array<Point<dim>, dim> corners(int simplex, const Nodes& of_vertices) const;

 private:
  const BodyNodes<dim>& nodes_;
  std::vector<SolidDescription> solids_;
  SurfaceMesh<dim> mesh_;
  std::vector<GlobalIndex> node_;  ///< global number of each vertex
  std::vector<int> own_node_;      ///< local number of each vertex; -1: another rank's
  std::vector<int> gathered_;      ///< the vertex of each gathered value: by ranks
  Nodes velocity_;
};

}  // namespace lockstep
