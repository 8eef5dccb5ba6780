#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "geometry/box_tree.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Description of one solid's surface, as the framework knows it.
struct SolidDescription {
  std::string name;
  bool closed = true;       ///< encloses a volume; false: a thin shell
  bool prescribed = false;  ///< kinematic or static: contributes velocities, not unknowns
  bool rigid = true;        ///< all its velocity rows are those of one rigid motion
  double density = 0;       ///< [kg/m^dim], of a shell [kg/m^(dim-1)]; for reports
  double restitution = 0;   ///< restitution in contacts: speed after over speed before [1]
  double friction = 0;      ///< Coulomb's coefficient [1]
  int model = 0;            ///< index of its SolidModel in the SolidSystem
  int index_in_model = 0;   ///< its place in that model's `solids()`
  int simplex_begin = 0, simplex_end = 0;  ///< its range of simplices in the snapshot
  int vertex_begin = 0, vertex_end = 0;    ///< its range of vertices in the snapshot
  /// True for a volume that deforms as its nodes move, which are unknowns.
  bool is_soft_body() const { return closed && !rigid && !prescribed; }
};

/// A point on the surface.
template <int dim>
struct SurfacePoint {
  int simplex = -1;
  Barycentric<dim> barycentric = Barycentric<dim>::Zero();
  Point<dim> position = Point<dim>::Zero();
  double fraction =
      0;  ///< for hits of a segment: 0 at its start, 1 at its end; for closest points: distance [m]
};

/// Where a line of cell centres, parallel to `axis`, crosses the surface.
template <int dim>
struct Crossing {
  double coordinate = 0;  ///< along the axis [m]
  int simplex = -1;
  Barycentric<dim> barycentric = Barycentric<dim>::Zero();
  bool entering = false;  ///< the line enters the solid here when walked in the positive direction
};

/// All crossings of the lines through the centres of a box of lattice cells; the sparse product of
/// `SurfaceSnapshot::cross_lattice`. Lines without crossings cost nothing.
template <int dim>
struct LatticeCrossings {
  struct Line {
    Index<dim> cell{};  ///< lattice coordinates of the line; the entry of `axis` is meaningless (0)
    std::vector<Crossing<dim>> crossings;  ///< sorted by coordinate
  };
  std::array<std::vector<Line>, dim> lines;  ///< per axis, sorted lexicographically by `cell`
};

/// The cell-centre lattice of a Cartesian grid: the centre of cell c is lower + (c + 1/2) *
/// spacing.
template <int dim>
struct Lattice {
  Point<dim> lower = Point<dim>::Zero();  ///< [m]
  double spacing = 1;                     ///< h [m]
  Point<dim> center(const Index<dim>& cell) const {
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = lower[a] + (cell[a] + 0.5) * spacing;
    return x;
  }
};

/// Places at which a periodic domain shows the solids that it repeats: each at one, a whole number
/// of periods from its own, and at others where it reaches across a side.
template <int dim>
struct SolidImages {
  struct Image {
    int solid = -1;
    Point<dim> shift = Point<dim>::Zero();  ///< from the first place shown to this one [m]
    bool operator==(const Image& other) const {
      return solid == other.solid && shift == other.shift;
    }
  };
  Point<dim> period = Point<dim>::Zero();  ///< [m]; 0 along axes that are not periodic
  std::vector<char> repeated;              ///< by solid; empty: none is
  std::vector<Point<dim>> shifts;          ///< by solid, from its own place to the first shown [m]
  std::vector<Image> others;
  bool operator==(const SolidImages& other) const {
    return shifts == other.shifts && others == other.others;
  }
  bool repeats(int solid) const { return !repeated.empty() && repeated[solid]; }
  /// The image of x that is nearest to a place.
  Point<dim> nearest(Point<dim> x, const Point<dim>& place) const {
    for (int a = 0; a < dim; ++a)
      if (period[a] > 0)
        x[a] += period[a] * std::round((place[a] - x[a]) / period[a]);
    return x;
  }
};

/// Appends a copy of a solid's surface to the mesh that has it, moved by `shift`; returns the
/// description of the copy.
template <int dim>
SolidDescription append_copy(const SolidDescription& solid, const Point<dim>& shift,
                             SurfaceMesh<dim>& mesh);

/// An immutable picture of all solids' surfaces at one instant, replicated on every rank, with the
/// queries that everyone needs. Built once per geometry change; queries are const and thread-safe.
/// Two snapshots of one step have the same simplices and differ in vertex positions only.
///
/// Simplices of further images come after those of all solids, whose ranges are the first images.
template <int dim>
class SurfaceSnapshot {
 public:
  /// `order`: that of an earlier snapshot of the same solids, which saves sorting. `mesh`: of the
  /// first images; the others are made of it.
  SurfaceSnapshot(SurfaceMesh<dim> mesh, std::vector<SolidDescription> solids,
                  BoxOrder order = nullptr, SolidImages<dim> images = {});
  SurfaceSnapshot(const SurfaceSnapshot&) = delete;
  SurfaceSnapshot(SurfaceSnapshot&&) = default;

  const SurfaceMesh<dim>& mesh() const { return mesh_; }
  const std::vector<SolidDescription>& solids() const { return solids_; }
  const BoxOrder& order() const { return tree_.order(); }
  int n_simplices() const { return static_cast<int>(mesh_.simplices.size()); }
  bool empty() const { return n_simplices() == 0; }
  int solid_of(int simplex) const { return solid_of_[simplex]; }
  std::array<Point<dim>, dim> corners(int simplex) const {
    std::array<Point<dim>, dim> points;
    for (int k = 0; k < dim; ++k)
      points[k] = mesh_.vertices[mesh_.simplices[simplex][k]];
    return points;
  }
  const Box<dim>& bounds(int simplex) const { return tree_.box(simplex); }
  /// Bounds of a solid with all its images.
  const Box<dim>& bounds_of_solid(int solid) const { return solid_tree_.box(solid); }

  const SolidImages<dim>& images() const { return images_; }
  /// Bounds of the first image alone.
  const Box<dim>& own_bounds(int solid) const {
    return own_bounds_.empty() ? bounds_of_solid(solid) : own_bounds_[solid];
  }
  /// True if an image of its solid stands where this simplex would be, moved by `shift` [m], whole
  /// periods and not zero.
  bool is_shown_at(int simplex, const Point<dim>& shift) const;
  /// Bounds of each image of a solid.
  std::vector<Box<dim>> bounds_of_images(int solid) const;
  /// Image of x that is nearest to the first image of a solid; x if that is not repeated.
  Point<dim> beside(int solid, const Point<dim>& x) const {
    return images_.repeats(solid) ? images_.nearest(x, own_bounds(solid).center()) : x;
  }
  /// A box without the sides that a solid goes through and comes back: where its first image is.
  Box<dim> room_of(int solid, Box<dim> box) const;
  /// The surface of one solid, vertices numbered from 0.
  SurfaceMesh<dim> mesh_of_solid(int solid) const;

  /// First simplex that the segment a -> b meets (within `tolerance` [m] of its ends and of the
  /// simplex' facet), or none. Touching counts as meeting, and so does running inside the plane of
  /// a simplex. No segment slips through between two neighbouring simplices.
  std::optional<SurfacePoint<dim>> first_hit(const Point<dim>& a, const Point<dim>& b,
                                             double tolerance = 0) const;
  /// Closest surface point within `radius`, or none.
  std::optional<SurfacePoint<dim>> closest(const Point<dim>& x, double radius) const;
  /// Closest point of one solid (no radius); simplex -1 if the solid has no simplices.
  SurfacePoint<dim> closest_on_solid(const Point<dim>& x, int solid) const;
  /// Lowest index of a closed solid that contains x, or -1. x is inside if an odd number of
  /// crossings of its line along axis 0 have coordinate <= x[0]: a point exactly on an
  /// axis-parallel face is inside at the lower face and outside at the upper one, along every axis.
  /// Consistent with `cross_lattice` (same code decides).
  int inside(const Point<dim>& x) const;
  /// Simplices whose bounding box touches `box`, in ascending order; replaces the content of
  /// `found`.
  void touching(const Box<dim>& box, std::vector<int>& found) const;
  /// Solids (closed or not) whose bounding box touches `box`, in ascending order; replaces `found`.
  void solids_touching(const Box<dim>& box, std::vector<int>& found) const;
  /// True if any simplex' bounding box touches the box.
  bool touches(const Box<dim>& box) const;

  /// Crossings of the cell-centre lines through the cells [begin, end) of `lattice` with the
  /// surface. The lines are infinite: crossings outside [begin, end) along the line's own axis are
  /// listed too, so that parities can be counted from the start. Watertight: a closed surface gives
  /// an even number of crossings on every whole line, because an edge shared by two simplices is
  /// decided by one and the same floating-point expression and a half-open rule. Costs O(area /
  /// h^(dim-1)).
  LatticeCrossings<dim> cross_lattice(const Lattice<dim>& lattice, const Index<dim>& begin,
                                      const Index<dim>& end) const;

 private:
  void add_images();

  SurfaceMesh<dim> mesh_;
  std::vector<SolidDescription> solids_;
  std::vector<int> solid_of_;  ///< per simplex, -1: none
  double typical_size_ = 0;    ///< mean diagonal of the simplices' boxes [m]
  BoxTree<dim> tree_, solid_tree_;
  SolidImages<dim> images_;
  std::vector<Box<dim>> own_bounds_;  ///< empty: there is one image of each
};

/// First passage of the surface, whose vertices move linearly from `before` to `after` (same
/// simplices), over the fixed point x, or none: the simplex, its barycentric coordinates and, as
/// `fraction`, the time of the passage in (0, 1]. `candidates` limits the simplices that are looked
/// at (those whose swept box holds x). Ties: a surface that starts on x does not sweep over it by
/// leaving, one that ends on x does; touching x and turning back counts; sliding over x inside the
/// surface's own plane does not.
template <int dim>
std::optional<SurfacePoint<dim>> swept_over(const SurfaceSnapshot<dim>& before,
                                            const SurfaceSnapshot<dim>& after, const Point<dim>& x,
                                            const std::vector<int>& candidates);

/// First passage of the surface over a point that moves linearly as well, from -> to; `position` is
/// meaningless.
template <int dim>
std::optional<SurfacePoint<dim>> swept_over(const SurfaceSnapshot<dim>& before,
                                            const SurfaceSnapshot<dim>& after,
                                            const Point<dim>& from, const Point<dim>& to,
                                            const std::vector<int>& candidates);

}  // namespace lockstep
