#pragma once
#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "contact/bodies/contact_images.hpp"
#include "coupling/solid_system.hpp"
#include "geometry/box_tree.hpp"

namespace lockstep {

/// An edge of a 3D surface.
struct SurfaceEdge {
  std::array<int, 2> vertices{};
  std::array<int, 2> simplices{-1, -1};  ///< the second is -1 at the rim of a shell
};

/// Connectivity of the surfaces, which does not change while the solids move: simplices around a
/// vertex, edges, sharp edges.
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
  /// True if the vertices are those of one edge.
  bool connected(int vertex, int other) const;
  /// Edges of one solid; none in 2D, where a corner is a vertex.
  const std::vector<SurfaceEdge>& edges(int solid) const { return edges_[solid]; }
  /// Edges at which the surface bends by more than the mesh of a smooth body does, or ends.
  const std::vector<SurfaceEdge>& sharp_edges(int solid) const { return sharp_edges_[solid]; }
  /// Orders of the boxes of a solid's vertices, simplices and edges in their last trees: the next
  /// boxes are mostly as good in the same order.
  std::array<BoxOrder, 3>& orders(int solid) const { return orders_[solid]; }

 private:
  std::vector<std::array<int, dim>> simplices_;
  std::vector<int> begin_{0}, around_;
  std::vector<std::vector<SurfaceEdge>> edges_, sharp_edges_;
  mutable std::vector<std::array<BoxOrder, 3>> orders_;
};

/// The surfaces of all solids at one instant, with the numbers of `SolidSystem::surface`, those of
/// images after them, and the geometric queries of contacts. The same on all ranks.
template <int dim>
class ContactShapes {
 public:
  /// `topology` is renewed if it belongs to another mesh. Collective.
  ContactShapes(const SolidSystem<dim>& system, ContactTopology<dim>& topology);

  /// Returns those of the system at their own places, then images of them (`contact_images`).
  const std::vector<SolidDescription>& solids() const {
    return images_.empty() ? system_.solids() : with_images_;
  }
  int n_solids() const { return static_cast<int>(solids().size()); }
  bool is_image(int solid) const { return solid >= static_cast<int>(system_.solids().size()); }
  /// The solid of the system that this one is, or is an image of.
  int source(int solid) const { return is_image(solid) ? image(solid).solid : solid; }
  /// From the place of that solid to this one [m].
  Point<dim> shift(int solid) const {
    return is_image(solid) ? image(solid).shift : Point<dim>(Point<dim>::Zero());
  }
  /// True if a contact of these two counts: of a pair one image does, and none of itself.
  bool may_meet(int solid, int other) const;
  /// Returns the point with the simplex that the system knows; its position stays.
  SurfacePoint<dim> known_to_system(SurfacePoint<dim> point) const;
  const SurfaceMesh<dim>& mesh() const { return mesh_; }
  const ContactTopology<dim>& topology() const { return *topology_; }

  const Box<dim>& bounds(int simplex) const { return bounds_[simplex]; }
  const Box<dim>& bounds_of_solid(int solid) const { return solid_bounds_[solid]; }
  /// Makes the row of a point of a surface over dofs that are unknowns or given: combinations are
  /// replaced by the dofs that they are made of.
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const;
  /// True if a dof is a combination of others.
  bool follows(GlobalIndex dof) const { return combinations_.count(dof) > 0; }
  /// The velocity of a point of a rigid solid that is not prescribed, with a surface or without.
  Point<dim> rigid_velocity(int solid, const Point<dim>& x,
                            const std::vector<double>& velocity) const;
  /// Makes the row of a point of a rigid solid that is not prescribed, with a surface or without.
  void rigid_row(int solid, const Point<dim>& x, VelocityRow<dim>& row) const;
  /// Returns the dofs that move a rigid solid.
  std::vector<GlobalIndex> rigid_dofs(int solid) const;
  /// The rigid solid that this vertex is attached to; -1: none.
  int carrier(int vertex) const { return carriers_.empty() ? -1 : carriers_[vertex]; }
  /// True if any vertex is attached to this solid.
  bool carries(int solid) const {
    return std::find(carriers_.begin(), carriers_.end(), solid) != carriers_.end();
  }
  /// True if a vertex is attached to this solid, or shares a simplex with one that is; likewise of
  /// a point, if that is so of a vertex that moves it.
  bool hangs_on(int vertex, int solid) const;
  bool hangs_on(const SurfacePoint<dim>& point, int solid) const;
  /// Returns a combination of dofs with those that are combinations themselves replaced by the dofs
  /// that they are made of.
  std::vector<std::pair<GlobalIndex, double>> resolved(
      const std::vector<std::pair<GlobalIndex, double>>& terms) const;
  /// Returns the dofs that others are combinations of.
  std::vector<GlobalIndex> leading_dofs() const;
  /// Sets the velocities that combinations have beside their terms
  /// (`ClosedMotion::constraint_error`), by id.
  void set_constraint_error(std::vector<double> constraint_error) {
    constraint_error_ = std::move(constraint_error);
  }
  /// Returns the part of a point's velocity that is due to `set_constraint_error`.
  Point<dim> constraint_error(const SurfacePoint<dim>& point, const Point<dim>& x) const {
    return velocity_by(constraint_error_, point, x);
  }
  /// Sets what dofs go beside their velocities (`SolidSystem::drift`), by id.
  void set_drift(std::vector<double> drift) { drift_ = std::move(drift); }
  bool has_drift() const { return !drift_.empty(); }
  /// Returns the drift of a point [m/s].
  Point<dim> drift(const SurfacePoint<dim>& point, const Point<dim>& x) const {
    return velocity_by(drift_, point, x);
  }
  Point<dim> prescribed_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const {
    return system_.prescribed_velocity(known_to_system(point), x);
  }
  /// True if contact cannot move this vertex: of a prescribed solid, or a pinned node.
  bool held(int vertex) const { return held_[vertex]; }
  std::array<Point<dim>, dim> corners(int simplex) const;
  Point<dim> normal(int simplex) const;           ///< unit
  Point<dim> vertex_normal(int vertex) const;     ///< unit, weighted by area
  SurfacePoint<dim> at_vertex(int vertex) const;  ///< simplex -1 if no simplex has it
  /// Normal of a smooth surface, interpolated between vertices; nothing beside a sharp edge.
  std::optional<Point<dim>> smooth_normal(const SurfacePoint<dim>& point) const;
  /// True if x is on the inner side of the closest point of the solid, or of these simplices,
  /// within `radius`.
  bool inside(int solid, const Point<dim>& x, double radius) const;
  bool inside(const std::vector<int>& simplices, const Point<dim>& x, double radius) const;

 private:
  /// True if x is on the inner side of the simplices that for_each_simplex(look) looks at.
  template <typename ForEach>
  bool inside_of(const ForEach& for_each_simplex, const Point<dim>& x, double radius) const;

  const typename SolidImages<dim>::Image& image(int solid) const {
    return images_[solid - system_.solids().size()];
  }
  void add_images();
  void find_combinations();
  void find_carriers();
  void resolve(VelocityRow<dim>& row) const;
  /// Velocity of a point by these velocities of dofs; zero if there are none.
  Point<dim> velocity_by(const std::vector<double>& of_dofs, const SurfacePoint<dim>& point,
                         const Point<dim>& x) const;
  void find_held();

  const SolidSystem<dim>& system_;
  const ContactTopology<dim>* topology_;
  SurfaceMesh<dim> mesh_;
  std::vector<typename SolidImages<dim>::Image> images_;
  std::vector<SolidDescription> with_images_;  ///< empty without images
  std::vector<Box<dim>> bounds_, solid_bounds_;
  std::unordered_map<GlobalIndex, std::vector<std::pair<GlobalIndex, double>>> combinations_;
  std::vector<double> constraint_error_, drift_;  ///< empty: none
  std::vector<int> carriers_;  ///< carrier of each vertex; empty: no node is attached
  std::vector<bool> held_;
};

}  // namespace lockstep
