#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "grid/tiled_grid.hpp"
#include "mac/transport/box_bins.hpp"

namespace lockstep {

/// A snapshot asked many times about one place: its simplices near there are gathered once. Sight
/// lines may leave a periodic domain: they then meet what lies at the other end. Touching counts as
/// meeting, within `tolerance()`, so that nothing is ever seen through a surface by round-off.
template <int dim>
class NearbySurface {
 public:
  using Snapshot = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// The snapshot may be null: no surface.
  NearbySurface(Snapshot snapshot, const TiledGrid<dim>& grid);
  NearbySurface(const NearbySurface&) = delete;
  NearbySurface& operator=(const NearbySurface&) = delete;

  bool empty() const { return !snapshot_; }
  const SurfaceSnapshot<dim>& snapshot() const { return *snapshot_; }
  double tolerance() const { return tolerance_; }  ///< [m], a millionth of h

  /// True if the box of a simplex touches this box [m].
  bool touches(const Box<dim>& box) const;
  /// First surface point on the segment a -> b of any length; its position is the real one, not
  /// that of a periodic image.
  std::optional<SurfacePoint<dim>> first_hit(const Point<dim>& a, const Point<dim>& b) const;

  /// Remembers what touches the box [m], so that `touches` and `gather` for boxes inside it are
  /// fast; forgets what was gathered.
  void enter(const Box<dim>& box);
  /// Makes `near_hit` and `focus` know what touches the box [m].
  void gather(const Box<dim>& box);
  /// First simplex that the segment, inside the box gathered, meets.
  std::optional<SurfacePoint<dim>> near_hit(const Point<dim>& a, const Point<dim>& b) const;
  /// Picks the simplices that touch a smaller box, for many segments inside it.
  void focus(const Box<dim>& box);
  std::optional<SurfacePoint<dim>> focused_hit(const Point<dim>& a, const Point<dim>& b) const {
    return focused_.empty() ? std::nullopt : hit_among(focused_, a, b);
  }

 private:
  struct Near {
    int simplex;
    std::array<Point<dim>, dim> corners;  ///< of the image
    Point<dim> normal;                    ///< of length one; zero if the simplex is degenerate
    Point<dim> shift;                     ///< from the real place to the image
  };
  /// All images of simplices that touch a box.
  struct Place {
    Box<dim> box;                  ///< empty: of nothing
    std::vector<Near> simplices;   ///< ascending by image and simplex
    std::vector<Box<dim>> bounds;  ///< of the images, widened by the tolerance
    BoxBins<dim> bins;             ///< of `bounds`
  };
  void fetch(const Box<dim>& box, Place& place);
  void list_all();
  /// Calls f(shift) for each period by which the surface may have to be moved to touch the box,
  /// until f returns true.
  template <typename Function>
  bool any_image(const Box<dim>& box, const Function& f) const;
  static Box<dim> span(const Point<dim>& a, const Point<dim>& b) {
    return {a.cwiseMin(b), a.cwiseMax(b)};
  }
  /// `among`: indices of simplices in the place gathered.
  std::optional<SurfacePoint<dim>> hit_among(const std::vector<int>& among, const Point<dim>& a,
                                             const Point<dim>& b) const;

  Snapshot snapshot_;
  Point<dim> lower_, period_;  ///< period 0: not periodic
  double spacing_, tolerance_;
  std::vector<Box<dim>> all_bounds_;
  BoxBins<dim> all_;                   ///< of `all_bounds_`; made when first needed
  Place entered_, elsewhere_;          ///< what `enter` and `gather` last asked for
  const Place* gathered_ = &entered_;  ///< one of the two
  std::vector<int> focused_;           ///< indices of simplices in the place gathered
  mutable std::vector<int> found_;
};

/// The box widened by a distance on all sides.
template <int dim>
Box<dim> widened(const Box<dim>& box, double distance) {
  const Point<dim> margin = Point<dim>::Constant(distance);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace lockstep
