#include "transport/nearby_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/simplex_queries.hpp"
#include "transport/box_visibility.hpp"
#include "transport/strip_values.hpp"

namespace lockstep {

namespace {
/// Bins are no smaller than h over this, and no more than so many.
constexpr double finest_bins = 16;
constexpr double most_bins = 1e9;
}  // namespace

template <int dim>
NearbySurface<dim>::NearbySurface(Snapshot snapshot, const TiledGrid<dim>& grid, int reach)
    : snapshot_(snapshot && !snapshot->empty() ? std::move(snapshot) : nullptr),
      lower_(grid.lower()),
      n_cells_(grid.n_cells()),
      spacing_(grid.spacing()),
      tolerance_(1e-6 * grid.spacing()) {
  for (int a = 0; a < dim; ++a)
    period_[a] = grid.description().periodic[a] ? grid.n_cells()[a] * grid.spacing() : 0;
  if (empty() || grid.n_owned_tiles() == 0)
    return;
  reach = std::min(reach, longest_reach);
  Index<dim> begin = grid.tile_begin(0), end = begin;
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
    for (int a = 0; a < dim; ++a) {
      begin[a] = std::min(begin[a], grid.tile_begin(tile)[a] - reach);
      end[a] = std::max(end[a], grid.tile_begin(tile)[a] + tile_width<dim> + reach);
    }
  for (int a = 0; a < dim; ++a) {
    reached_.min()[a] = lower_[a] + begin[a] * spacing_;
    reached_.max()[a] = lower_[a] + end[a] * spacing_;
  }
  list_images();
  make_bins();
  std::vector<Box<dim>> in_cells;
  in_cells.reserve(bounds_.size());
  for (const Box<dim>& box : bounds_)
    in_cells.emplace_back((box.min() - lower_) / spacing_, (box.max() - lower_) / spacing_);
  distance_.build(in_cells, begin, end, reach);
}

template <int dim>
NearbySurface<dim>::~NearbySurface() = default;

template <int dim>
void NearbySurface<dim>::list_images() {
  bounds_.reserve(snapshot_->n_simplices());
  images_.reserve(snapshot_->n_simplices());
  any_image(reached_, [&](const Point<dim>& shift) {
    const Box<dim> place(reached_.min() - shift, reached_.max() - shift);
    for (int s = 0; s < snapshot_->n_simplices(); ++s) {
      const Box<dim>& bounds = snapshot_->bounds(s);
      if (!place.intersects(bounds) || is_left_out(s, shift))
        continue;
      bounds_.push_back(widened<dim>(bounds.translated(shift), 2 * tolerance_));
      images_.push_back(picture(s, shift));
    }
    return false;
  });
}

/// Simplices that have left through a periodic side are not repeated inside of the other; and where
/// a solid reaches across a side the snapshot itself has it at both, so that its simplices are not
/// listed twice, which would give them twice the weight in the mean of a box.
template <int dim>
bool NearbySurface<dim>::is_left_out(int simplex, const Point<dim>& shift) const {
  if (shift.isZero(0))
    return false;
  const Box<dim>& bounds = snapshot_->bounds(simplex);
  for (int a = 0; a < dim; ++a)
    if ((shift[a] < 0 && bounds.min()[a] >= lower_[a] + period_[a]) ||
        (shift[a] > 0 && bounds.max()[a] <= lower_[a]))
      return true;
  return snapshot_->is_shown_at(simplex, shift);
}

template <int dim>
std::array<Point<dim>, dim> NearbySurface<dim>::corners(const Image& image) const {
  auto result = snapshot_->corners(image.simplex);
  for (Point<dim>& corner : result)
    corner += image.shift;
  return result;
}

template <int dim>
typename NearbySurface<dim>::Image NearbySurface<dim>::picture(int simplex,
                                                               const Point<dim>& shift) const {
  Image image;
  image.simplex = simplex;
  image.shift = shift;
  const auto points = corners(image);
  const auto plane = [](Point<dim> normal, const Point<dim>& x) {
    normal.normalize();
    return Plane{normal, normal.dot(x)};
  };
  image.plane = plane(area_vector<dim>(points), points[0]);
  for (int k = 0; k < dim; ++k) {
    const Point<dim>&facet = points[(k + 1) % dim], &end = points[(k + dim - 1) % dim];
    const Point<dim> along = end - facet, inward = points[k] - facet;
    const double square = along.squaredNorm();
    static_cast<Plane&>(image.facets[k]) =
        plane(inward - (square > 0 ? along.dot(inward) / square : 0) * along, facet);
    image.facets[k].height = image.facets[k](points[k]);
  }
  return image;
}

/// Bins of half a cell tell stencils that surfaces cut from the others; where many small simplices
/// are in each, smaller ones pay.
template <int dim>
void NearbySurface<dim>::make_bins() {
  Box<dim> region;
  double mean_extent = 0;
  for (const Box<dim>& box : bounds_) {
    region.extend(box);
    mean_extent += box.sizes().maxCoeff() / static_cast<double>(bounds_.size());
  }
  region = region.intersection(reached_);
  double width = 0.5 * spacing_;
  while (width > spacing_ / finest_bins && 2.4 * mean_extent < width &&
         region.volume() / std::pow(0.5 * width, dim) < most_bins)
    width *= 0.5;
  small_simplices_ = width < 0.5 * spacing_;
  seen_.assign(images_.size(), 0);
  bins_.build(bounds_, region, lower_, width, [&](int i, const Point<dim>& center) {
    return images_[i].comes_into(center, 0.5 * width, tolerance_);
  });
}

template <int dim>
template <typename Function>
bool NearbySurface<dim>::any_image(const Box<dim>& box, const Function& f) const {
  Index<dim> first{}, count{};
  int n_images = 1;
  for (int a = 0; a < dim; ++a) {
    int last = 0;
    if (period_[a] > 0) {
      first[a] = std::min(0, static_cast<int>(std::floor((box.min()[a] - lower_[a]) / period_[a])));
      last = std::max(0, static_cast<int>(std::floor((box.max()[a] - lower_[a]) / period_[a])));
    }
    count[a] = last - first[a] + 1;
    n_images *= count[a];
  }
  for (int i = 0; i < n_images; ++i) {
    Point<dim> shift;
    for (int a = 0, rest = i; a < dim; ++a) {
      shift[a] = (first[a] + rest % count[a]) * period_[a];
      rest /= count[a];
    }
    if (f(shift))
      return true;
  }
  return false;
}

template <int dim>
bool NearbySurface<dim>::touches(const Box<dim>& box) const {
  if (empty())
    return false;
  const auto any_touches = [&](const Box<dim>& place, double margin) {
    return any_image(place, [&](const Point<dim>& shift) {
      const Box<dim> moved = widened<dim>(Box<dim>(box.min() - shift, box.max() - shift), margin);
      if (shift.isZero())
        return snapshot_->touches(moved);
      std::vector<int> found;
      snapshot_->touching(moved, found);
      return std::any_of(found.begin(), found.end(), [&](int s) { return !is_left_out(s, shift); });
    });
  };
  if (!reached_.contains(box))
    return any_touches(box, 0);
  // The rings of cells around the middle one that hold the box, and those that it holds.
  Index<dim> middle;
  int outer = 0, inner = NearbySurface::longest_reach;
  for (int a = 0; a < dim; ++a) {
    const double low = (box.min()[a] - lower_[a]) / spacing_;
    const double high = (box.max()[a] - lower_[a]) / spacing_;
    const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::floor(high));
    middle[a] = (first + last) >> 1;
    outer = std::max({outer, middle[a] - first, last - middle[a]});
    inner = std::min({inner, middle[a] - static_cast<int>(std::ceil(low)), last - 1 - middle[a]});
  }
  const int distance = distance_(middle);
  if (distance > outer || distance <= inner)
    return distance <= inner;
  return !bins_.clear_of_boxes(box) &&
         (bins_.box_within(box) || any_touches(reached_, 2 * tolerance_));
}

template <int dim>
Box<dim> NearbySurface<dim>::interior(const Box<dim>& box) const {
  const Point<dim> middle = box.center(), margin = Point<dim>::Constant(tolerance_);
  return {(box.min() + margin).cwiseMin(middle), (box.max() - margin).cwiseMax(middle)};
}

template <int dim>
bool NearbySurface<dim>::clear(const Box<dim>& box) const {
  return empty() || (reached_.contains(box) && bins_.clear(interior(box)));
}

template <int dim>
std::optional<SurfacePoint<dim>> NearbySurface<dim>::first_hit(const Point<dim>& a,
                                                               const Point<dim>& b) const {
  Hit first;
  if (empty())
    return first.point;
  if (reached_.contains(a) && reached_.contains(b)) {
    const double length = (b - a).norm();
    bins_.walk(a, b, [&](const auto& list, double fraction) {
      if (first.point && (fraction - first.point->fraction) * length > 4 * tolerance_)
        return true;
      for (const int image : list)
        look_at(image, a, b, length, first);
      return false;
    });
    return first.point;
  }
  const Box<dim> box(a.cwiseMin(b), a.cwiseMax(b));
  any_image(box, [&](const Point<dim>& shift) {
    const auto hit = snapshot_->first_hit(a - shift, b - shift, tolerance_);
    if (hit && (!first.point || hit->fraction < first.point->fraction))
      first.point = hit;
    return false;
  });
  return first.point;
}

template <int dim>
void NearbySurface<dim>::look_around(const Point<dim>& eye, const Box<dim>& box,
                                     const Corners& corners, Hits& hits) const {
  using Values = Eigen::Array<double, 1 << dim, 1>;
  const auto corner = [&](int k) {
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = corners[a][k];
    return x;
  };
  // Walks cost by the bins on the way, the rest of this by the simplices in the box.
  if (empty() || small_simplices_ || !reached_.contains(box)) {
    for (int k = 0; k < 1 << dim; ++k)
      hits[k] = first_hit(eye, corner(k));
    return;
  }
  const auto at_corners = [&](const Plane& plane) {
    Values value = Values::Constant(-plane.offset);
    for (int a = 0; a < dim; ++a)
      value += plane.normal[a] * corners[a];
    return value;
  };
  Values square = Values::Zero();
  for (int a = 0; a < dim; ++a)
    square += (corners[a] - eye[a]).square();
  const Values length = square.sqrt();
  std::array<Hit, 1 << dim> first;
  ++question_;
  bins_.visit(interior(box), [&](const auto& list) {
    for (const int i : list) {
      if (seen_[i] == question_)
        continue;
      seen_[i] = question_;
      if (!bounds_[i].intersects(box))
        continue;
      const Image& image = images_[i];
      const double from = image.plane(eye);
      const Values to = at_corners(image.plane);
      const double tolerance = 3 * tolerance_;
      if (std::min(from, to.minCoeff()) > tolerance || std::max(from, to.maxCoeff()) < -tolerance)
        continue;
      // In terms of minima alone, which Eigen vectorizes, as it does no choices: segments reach the
      // plane, and do not pass by the simplex.
      const Values drop = from - to, size = drop.abs();
      Values inside = Values::Constant(std::numeric_limits<double>::infinity());
      for (const Facet& facet : image.facets)
        inside = inside.min(drop * (from * at_corners(facet) - facet(eye) * to));
      const Values reaches = (tolerance - to.min(from)).min(tolerance + to.max(from));
      const Values passes = (-2 * tolerance_ * length * size - inside)
                                .min(size - 1e-9 * length)
                                .min(length - tolerance_);
      const Values meets = reaches.min(-passes);
      for (unsigned left = bits_of_non_negative(meets); left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        look_at(i, eye, corner(k), length[k], first[k]);
      }
    }
  });
  for (int k = 0; k < 1 << dim; ++k)
    hits[k] = first[k].point;
}

template <int dim>
void NearbySurface<dim>::look_at(int i, const Point<dim>& a, const Point<dim>& b, double length,
                                 Hit& first) const {
  const Image& image = images_[i];
  const double from = image.plane(a), to = image.plane(b);
  if (i == first.image || std::min(from, to) > 3 * tolerance_ ||
      std::max(from, to) < -3 * tolerance_ ||
      (!small_simplices_ && !bounds_[i].intersects(Box<dim>(a.cwiseMin(b), a.cwiseMax(b)))))
    return;
  const auto take = [&](const Barycentric<dim>& barycentric, const Point<dim>& position,
                        double fraction) {
    // Simplices that share the edge under the segment are as near but for round-off. Their normals
    // differ: bodies that a plane of the grid cuts in two equal halves must not slip by another one
    // because a solve stopped elsewhere.
    const double farther = first.point ? (fraction - first.point->fraction) * length : 0;
    if (first.point && (farther > tolerance_ || (farther >= -tolerance_ && i > first.image)))
      return;
    first.image = i;
    first.point = SurfacePoint<dim>{image.simplex, barycentric, position - image.shift, fraction};
  };
  // Most that cross the plane pass by the simplex, and most others cross it clear of its facets,
  // where its neighbours are.
  const double drop = from - to;
  if (length > tolerance_ && std::abs(drop) > 1e-9 * length) {
    const double slack = 2 * tolerance_ * length;
    Barycentric<dim> shares;
    bool is_clear = from * to < 0;
    for (int k = 0; k < dim; ++k) {
      const Facet& facet = image.facets[k];
      const double inside = std::copysign(1.0, drop) * (from * facet(b) - to * facet(a));
      if (inside < -slack)
        return;
      is_clear = is_clear && inside > slack;
      shares[k] = inside / facet.height;
    }
    if (is_clear) {
      const double fraction = from / drop;
      return take(shares / shares.sum(), a + fraction * (b - a), fraction);
    }
  }
  // A segment shorter than the tolerance has no direction to speak of.
  if (length <= tolerance_) {
    const auto closest = closest_on_simplex<dim>(corners(image), a);
    if (closest.distance <= 2 * tolerance_)
      take(closest.barycentric, closest.position, 0);
  } else if (const auto hit = hit_simplex<dim>(corners(image), a, b, tolerance_)) {
    take(hit->barycentric, hit->position, hit->fraction);
  }
}

template <int dim>
std::vector<typename NearbySurface<dim>::Image> NearbySurface<dim>::images_in(
    const Box<dim>& box) const {
  std::vector<Image> found;
  std::vector<int> simplices;
  any_image(box, [&](const Point<dim>& shift) {
    const Box<dim> place(box.min() - shift, box.max() - shift);
    snapshot_->touching(widened<dim>(place, 2 * tolerance_), simplices);
    std::sort(simplices.begin(), simplices.end());
    for (const int s : simplices)
      if (!is_left_out(s, shift)) {
        const Image image = picture(s, shift);
        if (image.comes_into(box.center(), 0.5 * box.sizes()[0], tolerance_))
          found.push_back(image);
      }
    return false;
  });
  return found;
}

template <int dim>
const VisibilityTable<dim>& NearbySurface<dim>::visibility(int kind) const {
  auto& table = visibility_[kind + 1];
  if (!table)
    table = std::make_unique<VisibilityTable<dim>>(*this, kind);
  return *table;
}

template <int dim>
std::shared_ptr<const NearbySurface<dim>> KeptSurface<dim>::of(
    const std::shared_ptr<const SurfaceSnapshot<dim>>& snapshot, const TiledGrid<dim>& grid,
    int reach) {
  if (entries_[0].snapshot != snapshot)
    std::swap(entries_[0], entries_[1]);
  Entry& entry = entries_[0];
  recent_reach_ = std::max(recent_reach_, reach);
  if (!entry.surface || entry.snapshot != snapshot || entry.reach < reach) {
    entry.snapshot = snapshot;
    entry.reach = std::max(recent_reach_, earlier_reach_);
    entry.surface = std::make_shared<const NearbySurface<dim>>(snapshot, grid, entry.reach);
    earlier_reach_ = recent_reach_;
    recent_reach_ = reach;
  }
  return entry.surface;
}

template class NearbySurface<2>;
template class NearbySurface<3>;
template class KeptSurface<2>;
template class KeptSurface<3>;

}  // namespace lockstep
