#include "mac/transport/nearby_surface.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/simplex_queries.hpp"

namespace lockstep {

template <int dim>
NearbySurface<dim>::NearbySurface(Snapshot snapshot, const TiledGrid<dim>& grid)
    : snapshot_(snapshot && !snapshot->empty() ? std::move(snapshot) : nullptr),
      lower_(grid.lower()),
      spacing_(grid.spacing()),
      tolerance_(1e-6 * grid.spacing()) {
  for (int a = 0; a < dim; ++a)
    period_[a] = grid.description().periodic[a] ? grid.n_cells()[a] * grid.spacing() : 0;
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
  if (entered_.box.contains(box))
    return entered_.bins.any_touches(box);
  return any_image(box, [&](const Point<dim>& shift) {
    return snapshot_->touches(Box<dim>(box.min() - shift, box.max() - shift));
  });
}

template <int dim>
std::optional<SurfacePoint<dim>> NearbySurface<dim>::first_hit(const Point<dim>& a,
                                                               const Point<dim>& b) const {
  std::optional<SurfacePoint<dim>> first;
  if (empty())
    return first;
  any_image(span(a, b), [&](const Point<dim>& shift) {
    const auto hit = snapshot_->first_hit(a - shift, b - shift, tolerance_);
    if (hit && (!first || hit->fraction < first->fraction))
      first = hit;
    return false;
  });
  return first;
}

template <int dim>
void NearbySurface<dim>::list_all() {
  Box<dim> region;
  for (int s = 0; s < snapshot_->n_simplices(); ++s) {
    all_bounds_.push_back(snapshot_->bounds(s));
    region.extend(all_bounds_.back());
  }
  all_.build(all_bounds_, region, spacing_);
}

template <int dim>
void NearbySurface<dim>::fetch(const Box<dim>& box, Place& place) {
  if (all_bounds_.empty())
    list_all();
  place.box = box;
  place.simplices.clear();
  place.bounds.clear();
  any_image(box, [&](const Point<dim>& shift) {
    all_.touching(Box<dim>(box.min() - shift, box.max() - shift), found_);
    std::sort(found_.begin(), found_.end());
    for (const int s : found_) {
      Near near;
      near.simplex = s;
      near.corners = snapshot_->corners(s);
      Box<dim> bounds;
      for (Point<dim>& corner : near.corners) {
        corner += shift;
        bounds.extend(corner);
      }
      near.normal = area_vector<dim>(near.corners);
      near.normal.normalize();
      near.shift = shift;
      place.simplices.push_back(near);
      place.bounds.push_back(widened<dim>(bounds, 2 * tolerance_));
    }
    return false;
  });
  place.bins.build(place.bounds, box, spacing_);
}

template <int dim>
void NearbySurface<dim>::enter(const Box<dim>& box) {
  focused_.clear();
  gathered_ = &entered_;
  if (!empty())
    fetch(box, entered_);
}

template <int dim>
void NearbySurface<dim>::gather(const Box<dim>& box) {
  focused_.clear();
  if (empty())
    return;
  const Box<dim> wide = widened<dim>(box, tolerance_);
  gathered_ = entered_.box.contains(wide) ? &entered_ : &elsewhere_;
  if (!gathered_->box.contains(wide))
    fetch(wide, elsewhere_);
}

template <int dim>
void NearbySurface<dim>::focus(const Box<dim>& box) {
  focused_.clear();
  const Point<dim> center = box.center(), half = 0.5 * box.sizes();
  gathered_->bins.touching(box, found_);
  for (const int n : found_) {
    // No segment in the box meets a simplex whose plane passes by.
    const Near& near = gathered_->simplices[n];
    const double height = std::abs(near.normal.dot(center - near.corners[0]));
    if (height <= near.normal.cwiseAbs().dot(half) + 3 * tolerance_)
      focused_.push_back(n);
  }
  std::sort(focused_.begin(), focused_.end());  // of equally near hits the first counts
}

template <int dim>
std::optional<SurfacePoint<dim>> NearbySurface<dim>::near_hit(const Point<dim>& a,
                                                              const Point<dim>& b) const {
  gathered_->bins.touching(span(a, b), found_);
  std::sort(found_.begin(), found_.end());
  return found_.empty() ? std::nullopt : hit_among(found_, a, b);
}

template <int dim>
std::optional<SurfacePoint<dim>> NearbySurface<dim>::hit_among(const std::vector<int>& among,
                                                               const Point<dim>& a,
                                                               const Point<dim>& b) const {
  std::optional<SurfacePoint<dim>> first;
  const Box<dim> box = span(a, b);
  // A segment shorter than the tolerance has no direction to speak of.
  const bool is_point = (b - a).norm() <= tolerance_;
  for (const int n : among) {
    if (!gathered_->bounds[n].intersects(box))
      continue;
    const Near& near = gathered_->simplices[n];
    const double from = near.normal.dot(a - near.corners[0]);
    const double to = near.normal.dot(b - near.corners[0]);
    if (std::min(from, to) > 3 * tolerance_ || std::max(from, to) < -3 * tolerance_)
      continue;
    if (is_point) {
      const auto closest = closest_on_simplex<dim>(near.corners, a);
      if (closest.distance <= 2 * tolerance_)
        return SurfacePoint<dim>{near.simplex, closest.barycentric, closest.position - near.shift,
                                 0};
      continue;
    }
    const auto hit = hit_simplex<dim>(near.corners, a, b, tolerance_);
    if (hit && (!first || hit->fraction < first->fraction))
      first = SurfacePoint<dim>{near.simplex, hit->barycentric, hit->position - near.shift,
                                hit->fraction};
  }
  return first;
}

template class NearbySurface<2>;
template class NearbySurface<3>;

}  // namespace lockstep
