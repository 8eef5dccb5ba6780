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
/// that side, and none of the other.
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

  /// Samples around a point, bit k for corner k.
  struct Seen {
    unsigned seen = 0;     ///< by the point
    unsigned unknown = 0;  ///< samples in the slab, of which only rays tell
  };
  /// Samples that a point in the box sees [m]; none: only rays tell.
  std::optional<Seen> seen_from(const Point<dim>& eye) const {
    const double height = normal_.dot(eye) - middle_;
    if (!is_flat_ || std::abs(height) <= half_thickness_)
      return std::nullopt;
    return Seen{samples_[height > 0 ? 2 : 0], samples_[1]};
  }
  /// Point of the surface beside a point in the box: the nearest of the simplex that is nearest to
  /// the middle of the box.
  SurfacePoint<dim> beside(const SurfaceSnapshot<dim>& snapshot, const Point<dim>& eye) const;

 private:
  void find_slab(const NearbySurface<dim>& surface, const std::vector<Image>& images,
                 const Box<dim>& box);
  /// Sorts the samples by their sides of the slab; false if open edges join both.
  bool part_samples(const NearbySurface<dim>& surface, const Corners& samples);

  Point<dim> normal_ =
      Point<dim>::Zero();  ///< normal of the slab |normal . x - middle| <= half_thickness [1]
  double middle_ = 0, half_thickness_ = 0;  ///< [m]
  bool is_flat_ = false;                    ///< the slab is thin, and nothing is seen through it
  std::array<std::uint8_t, 3> samples_{};   ///< below, in and above the slab, bit k for corner k
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
  Index<dim> begin_{}, end_{};      ///< boxes that lie where the surface is indexed
  BoxBins<dim> boxes_;              ///< images of simplices by box, where the surface is indexed
  mutable std::vector<int> known_;  ///< by box that is not empty: its place in `found_`, or -1
  mutable std::vector<BoxVisibility<dim>> found_;
  mutable std::optional<BoxVisibility<dim>> beyond_;  ///< the last one asked for elsewhere
};

}  // namespace lockstep
