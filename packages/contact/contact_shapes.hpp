#pragma once
#include <optional>
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// An edge of a 3D surface at which it bends by more than the mesh of a smooth body does, or at
/// which a shell ends.
struct SharpEdge {
  std::array<int, 2> vertices{};
  std::array<int, 2> simplices{-1, -1};  ///< the second is -1 at the rim of a shell
};

/// What does not change while the solids move: who shares a vertex, which edges are sharp.
template <int dim>
class ContactTopology {
 public:
  ContactTopology() = default;
  ContactTopology(const SurfaceMesh<dim>& mesh, const std::vector<SolidDescription>& solids);

  bool belongs_to(const SurfaceMesh<dim>& mesh) const {
    return simplices_ == mesh.simplices && n_vertices() == static_cast<int>(mesh.vertices.size());
  }
  int n_vertices() const { return static_cast<int>(begin_.size()) - 1; }
  /// Simplices around a vertex: [begin, end).
  const int* begin(int vertex) const { return around_.data() + begin_[vertex]; }
  const int* end(int vertex) const { return around_.data() + begin_[vertex + 1]; }
  /// Of one solid; none in 2D, where a corner is a vertex.
  const std::vector<SharpEdge>& sharp_edges(int solid) const { return sharp_edges_[solid]; }

 private:
  std::vector<std::array<int, dim>> simplices_;
  std::vector<int> begin_{0}, around_;
  std::vector<std::vector<SharpEdge>> sharp_edges_;
};

/// The surfaces of all solids at one instant, with the numbers of `SolidSystem::snapshot`, and what
/// the search for contacts asks of them. Local, the same on all ranks.
template <int dim>
class ContactShapes {
 public:
  /// `topology` is renewed if it belongs to another mesh.
  ContactShapes(const SolidSystem<dim>& system, ContactTopology<dim>& topology);

  const std::vector<SolidDescription>& solids() const { return solids_; }
  int n_solids() const { return static_cast<int>(solids_.size()); }
  const SurfaceMesh<dim>& mesh() const { return mesh_; }
  const ContactTopology<dim>& topology() const { return *topology_; }

  const Box<dim>& bounds(int simplex) const { return bounds_[simplex]; }
  const Box<dim>& bounds_of_solid(int solid) const { return solid_bounds_[solid]; }
  std::array<Point<dim>, dim> corners(int simplex) const;
  Point<dim> normal(int simplex) const;           ///< unit
  Point<dim> vertex_normal(int vertex) const;     ///< unit, weighted by area
  SurfacePoint<dim> at_vertex(int vertex) const;  ///< simplex -1 if no simplex has it
  /// Normal of a smooth surface, interpolated between vertices; nothing beside a sharp edge.
  std::optional<Point<dim>> smooth_normal(const SurfacePoint<dim>& point) const;
  /// True if x is on the inner side of the closest point of the solid within `radius`.
  bool inside(int solid, const Point<dim>& x, double radius) const;

 private:
  const std::vector<SolidDescription>& solids_;
  const ContactTopology<dim>* topology_;
  SurfaceMesh<dim> mesh_;
  std::vector<Box<dim>> bounds_, solid_bounds_;
};

}  // namespace lockstep
