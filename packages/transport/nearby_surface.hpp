#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "grid/tiled_grid.hpp"
#include "transport/box_bins.hpp"
#include "transport/cell_distance.hpp"

namespace lockstep {

template <int dim>
class VisibilityTable;

/// A snapshot with fast queries near the cells that a rank owns: there its simplices are listed by
/// bins, so that the cost of a query depends on the bins on the way and not on the mesh. Sight
/// lines may leave a periodic domain: they then meet the surfaces at the other end, but surfaces
/// that have left it are not met again inside. Touching counts as meeting, within `tolerance()`, so
/// that round-off never lets a ray see through a surface.
template <int dim>
class NearbySurface {
 public:
  using Snapshot = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Indexes a snapshot, which may be null: no surface. Queries are fast within `reach` cells of
  /// owned ones, if that is no more than `longest_reach`.
  NearbySurface(Snapshot snapshot, const TiledGrid<dim>& grid, int reach);
  ~NearbySurface();
  NearbySurface(const NearbySurface&) = delete;
  NearbySurface& operator=(const NearbySurface&) = delete;

  static constexpr int longest_reach = 24;

  /// x -> normal . x - offset
  struct Plane {
    double operator()(const Point<dim>& x) const { return normal.dot(x) - offset; }
    Point<dim> normal = Point<dim>::Zero();
    double offset = 0;
  };
  /// Edge opposite to a corner: as a plane that gives the distance of a point inside of it, and the
  /// corner's distance `height` [m].
  struct Facet : Plane {
    double height = 0;
  };
  /// The image of a simplex near here.
  struct Image {
    /// True if its plane comes into the cube around a point, or as near as four tolerances [m].
    bool comes_into(const Point<dim>& center, double half_width, double tolerance) const {
      return std::abs(plane(center)) <= half_width * plane.normal.cwiseAbs().sum() + 4 * tolerance;
    }
    int simplex = -1;
    Point<dim> shift;  ///< from the real place to the image
    Plane plane;       ///< its own, [m]; zero if it is degenerate
    std::array<Facet, dim> facets;
  };

  bool empty() const { return !snapshot_; }
  const SurfaceSnapshot<dim>& snapshot() const { return *snapshot_; }
  double tolerance() const { return tolerance_; }  ///< [m], a millionth of h
  /// Box in which answers are fast [m]; may be empty.
  const Box<dim>& reached() const { return reached_; }
  const Point<dim>& lower() const { return lower_; }      ///< lower corner of the domain [m]
  double spacing() const { return spacing_; }             ///< h [m]
  const Index<dim>& n_cells() const { return n_cells_; }  ///< cells of the domain
  bool is_periodic(int axis) const { return period_[axis] > 0; }
  /// The images there, ascending by image and simplex, and their bounds, widened by twice the
  /// tolerance.
  const std::vector<Image>& images() const { return images_; }
  const std::vector<Box<dim>>& bounds() const { return bounds_; }
  std::array<Point<dim>, dim> corners(const Image& image) const;
  /// The images whose planes come into a box of equal edges, wherever it is, ascending.
  std::vector<Image> images_in(const Box<dim>& box) const;
  /// Boxes of samples of a kind (`cell_centers` or a face's axis) that surfaces cut.
  const VisibilityTable<dim>& visibility(int kind) const;

  /// Cells between this one and the nearest that the box of a simplex touches: 0 if it is touched;
  /// a lower bound, exact up to `reach`.
  int cells_to(const Index<dim>& cell) const { return distance_(cell); }
  /// True if the box of a simplex touches this box [m].
  bool touches(const Box<dim>& box) const;
  /// True if no simplex comes into the box [m].
  bool clear(const Box<dim>& box) const;
  /// The 2^dim corners of a box [m], by axis.
  using Corners = std::array<Eigen::Array<double, 1 << dim, 1>, dim>;
  using Hits = std::array<std::optional<SurfacePoint<dim>>, 1 << dim>;
  /// First surface points on the segments from a point of the box to its corners.
  void look_around(const Point<dim>& eye, const Box<dim>& box, const Corners& corners,
                   Hits& hits) const;
  /// First surface point on the segment a -> b of any length; its position is the real one, not
  /// that of a periodic image.
  std::optional<SurfacePoint<dim>> first_hit(const Point<dim>& a, const Point<dim>& b) const;

 private:
  struct Hit {
    std::optional<SurfacePoint<dim>> point;
    int image = -1;
  };
  void list_images();
  /// True if the image of a simplex with this shift lies beyond the domain, or is that of another.
  bool is_left_out(int simplex, const Point<dim>& shift) const;
  Image picture(int simplex, const Point<dim>& shift) const;
  void make_bins();
  /// Calls f(shift) for each period by which the surface may have to be moved to touch the box,
  /// until f returns true.
  template <typename Function>
  bool any_image(const Box<dim>& box, const Function& f) const;
  /// The box shrunk by the tolerance: bounds that touch only the box's boundary do not reach into
  /// it.
  Box<dim> interior(const Box<dim>& box) const;
  /// Takes the hit on one simplex if it comes before the one found, or is as near, within the
  /// tolerance, and the simplex comes first.
  void look_at(int image, const Point<dim>& a, const Point<dim>& b, double length, Hit& hit) const;

  Snapshot snapshot_;
  Point<dim> lower_, period_;  ///< period 0: not periodic
  Index<dim> n_cells_;
  double spacing_, tolerance_;
  Box<dim> reached_;  ///< where all simplices are listed; empty if there is no such place
  std::vector<Image> images_;
  std::vector<Box<dim>> bounds_;
  bool small_simplices_ = false;  ///< bins are smaller than half a cell
  BoxBins<dim> bins_;             ///< bins of `images_`; every half cell is one or several bins
  CellDistance<dim> distance_;    ///< to `bounds_`
  mutable std::vector<unsigned> seen_;  ///< the question that each simplex last came up for
  mutable unsigned question_ = 0;
  /// By kind, cell centres first; made when they are first asked for.
  mutable std::array<std::unique_ptr<VisibilityTable<dim>>, dim + 1> visibility_;
};

/// Cache of the last two indexed surfaces, those before and after a step.
template <int dim>
class KeptSurface {
 public:
  /// The surface near owned cells, fast within `reach` cells of them or more. May be null or empty.
  std::shared_ptr<const NearbySurface<dim>> of(
      const std::shared_ptr<const SurfaceSnapshot<dim>>& snapshot, const TiledGrid<dim>& grid,
      int reach);

 private:
  struct Entry {
    std::shared_ptr<const SurfaceSnapshot<dim>> snapshot;
    std::shared_ptr<const NearbySurface<dim>> surface;  ///< null: none is kept
    int reach = 0;
  };
  std::array<Entry, 2> entries_;  ///< the last one asked for first
  /// Largest reach that was needed since the last surface was indexed, and between the one before
  /// and it: it is likely to be needed again.
  int recent_reach_ = 0, earlier_reach_ = 0;
};

/// The box widened by a distance on all sides.
template <int dim>
Box<dim> widened(const Box<dim>& box, double distance) {
  const Point<dim> margin = Point<dim>::Constant(distance);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace lockstep
