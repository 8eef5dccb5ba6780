#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "transport/nearby_surface.hpp"
#include "transport/sample_lattice.hpp"

namespace lockstep {

/// Sight within a box of 2^dim samples that surfaces cut. Where these lie within a thin slab whose
/// two sides no open edge of the box joins, a point on one side of the slab sees the samples of
/// that side, and none of the others.
template <int dim>
class BoxVisibility {
 public:
  using Image = typename NearbySurface<dim>::Image;

  using Corners = std::array<Point<dim>, 1 << dim>;

  /// `images`: those of simplices that may come into the box, not none, ascending; `samples` lie at
  /// its corners, or within it where the last samples stand for those beyond a side of the domain
  /// [m].
  BoxVisibility(const NearbySurface<dim>& surface, const std::vector<Image>& images,
                const Box<dim>& box, const Corners& samples);

  /// Samples that a point in the box sees [m], bit k for corner k; none: only rays tell.
  std::optional<unsigned> seen_from(const Point<dim>& eye) const {
    const double height = normal_.dot(eye) - middle_;
    const unsigned seen = seen_[height > 0];
    return std::abs(height) <= half_thickness_ || seen == 0 ? std::nullopt : std::optional(seen);
  }
  /// Point of the surface beside a point in the box: the nearest of the simplex that is nearest to
  /// the middle of the box.
  SurfacePoint<dim> beside(const SurfaceSnapshot<dim>& snapshot, const Point<dim>& eye) const;

 private:
  void find_slab(const NearbySurface<dim>& surface, const std::vector<Image>& images,
                 const Box<dim>& box);
  /// Joins samples by open edges, and sets what both sides see; false if these see each other.
  bool part_samples(const NearbySurface<dim>& surface, const Corners& samples);

  Point<dim> normal_ =
      Point<dim>::Zero();  ///< normal of the slab |normal . x - middle| <= half_thickness [1]
  double middle_ = 0, half_thickness_ = 0;  ///< [m]
  std::array<std::uint8_t, 2> seen_{};      ///< samples seen from below and from above; 0: unknown
  int simplex_ = -1;                        ///< the nearest to the middle of the box
  Point<dim> shift_ = Point<dim>::Zero();   ///< from its real place to the image in the box [m]
};

/// The boxes of samples of one kind that surfaces come into. Each is looked at once, when it is
/// first asked for, so that an interpolation need not send rays to its samples.
template <int dim>
class VisibilityTable {
 public:
  VisibilityTable(const NearbySurface<dim>& surface, SampleKind kind);

  /// The box of samples around x (lattice units); null if no surface comes into it. Valid until the
  /// next call.
  const BoxVisibility<dim>* around(const Point<dim>& x) const;

 private:
  using Image = typename NearbySurface<dim>::Image;
  Box<dim> box_of(const Index<dim>& place) const;
  BoxVisibility<dim> look_at(const Index<dim>& place, const std::vector<Image>& images) const;

  const NearbySurface<dim>& surface_;
  SampleKind kind_;
  Point<dim> offset_;               ///< place of the samples in their cells [cells]
  BoxBins<dim> boxes_;              ///< images of simplices by box, where the surface is indexed
  mutable std::vector<int> known_;  ///< by box that is not empty: its place in `found_`, or -1
  mutable std::vector<BoxVisibility<dim>> found_;
  mutable std::optional<BoxVisibility<dim>> beyond_;  ///< the last one asked for elsewhere
};

}  // namespace lockstep
