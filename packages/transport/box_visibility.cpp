#include "transport/box_visibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/simplex_queries.hpp"

namespace lockstep {

namespace {
/// A slab of more than this lets samples beside it be seen round a bend of the surface [cells].
/// Neither bound is a round number, which round-off would decide for bodies along the grid, and
/// otherwise in a scene that is turned by 90 degrees.
constexpr double thickest_slab = 0.47;
/// Least cosine between the normals of a simplex and of the slab: layers that face each other, as
/// those of a thin lens, and rims have none in common.
constexpr double least_cosine = 0.48;
}  // namespace

template <int dim>
BoxVisibility<dim>::BoxVisibility(const NearbySurface<dim>& surface,
                                  const std::vector<Image>& images, const Box<dim>& box,
                                  const Corners& samples) {
  find_slab(surface, images, box);
  is_flat_ = 2 * half_thickness_ <= thickest_slab * box.sizes()[0] &&
             std::all_of(images.begin(), images.end(), [&](const Image& image) {
               return image.plane.normal.dot(normal_) >= least_cosine;
             });
  is_flat_ = is_flat_ && part_samples(surface, samples);
}

/// The mean of the normals is weighted by area, of which no simplex counts with more than a face of
/// the box. Within the box and its own bounds, a simplex is part of a plane; heights over it are
/// those of n less its part along the simplex' own normal m, w = n - (n.m) m.
template <int dim>
void BoxVisibility<dim>::find_slab(const NearbySurface<dim>& surface,
                                   const std::vector<Image>& images, const Box<dim>& box) {
  const double face = std::pow(box.sizes()[0], dim - 1);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Image& image : images) {
    const auto corners = surface.corners(image);
    normal_ += std::min(area_vector<dim>(corners).norm(), face) * image.plane.normal;
    const double distance = closest_on_simplex<dim>(corners, box.center()).distance;
    // As near but for round-off: the first one.
    if (distance < nearest - surface.tolerance()) {
      nearest = distance;
      simplex_ = image.simplex;
      shift_ = image.shift;
    }
  }
  normal_.normalize();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Image& image : images) {
    const auto corners = surface.corners(image);
    Box<dim> bounds;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Point<dim>& corner : corners) {
      bounds.extend(corner);
      least = std::min(least, normal_.dot(corner));
      most = std::max(most, normal_.dot(corner));
    }
    const Box<dim> part = widened<dim>(bounds, surface.tolerance()).intersection(box);
    if (part.isEmpty())
      continue;
    const Point<dim>& m = image.plane.normal;
    const Point<dim> w = normal_ - normal_.dot(m) * m;
    const double middle = normal_.dot(corners[0]) + w.dot(part.center() - corners[0]);
    const double reach = 0.5 * w.cwiseAbs().dot(part.sizes());
    low = std::min(low, std::max(least, middle - reach));
    high = std::max(high, std::min(most, middle + reach));
  }
  // Without any part in the box, all that they do is touch it.
  middle_ = low <= high ? 0.5 * (low + high) : 0;
  half_thickness_ = low <= high ? 0.5 * (high - low) + 4 * surface.tolerance()
                                : std::numeric_limits<double>::infinity();
}

template <int dim>
bool BoxVisibility<dim>::part_samples(const NearbySurface<dim>& surface, const Corners& samples) {
  constexpr int n_corners = 1 << dim;
  std::array<int, n_corners> group, side;  // side: -1 below, 0 in the slab, 1 above
  for (int k = 0; k < n_corners; ++k) {
    const double height = normal_.dot(samples[k]) - middle_;
    side[k] = std::abs(height) <= half_thickness_ ? 0 : height > 0 ? 1 : -1;
    group[k] = k;
  }
  std::array<std::array<bool, dim>, n_corners> is_open{};
  for (int k = 0; k < n_corners; ++k)
    for (int a = 0; a < dim; ++a)
      if (const int l = k | 1 << a; l != k)
        is_open[k][a] =
            (side[k] != 0 && side[k] == side[l]) || !surface.first_hit(samples[k], samples[l]);
  for (int pass = 0; pass < n_corners; ++pass)
    for (int k = 0; k < n_corners; ++k)
      for (int a = 0; a < dim; ++a)
        if (is_open[k][a])
          group[k] = group[k | 1 << a] = std::min(group[k], group[k | 1 << a]);
  for (int k = 0; k < n_corners; ++k) {
    samples_[side[k] + 1] |= 1 << k;
    for (int l = 0; l < n_corners; ++l)
      if (side[k] * side[l] < 0 && group[k] == group[l])
        return false;
  }
  return true;
}

template <int dim>
SurfacePoint<dim> BoxVisibility<dim>::beside(const SurfaceSnapshot<dim>& snapshot,
                                             const Point<dim>& eye) const {
  const auto closest = closest_on_simplex<dim>(snapshot.corners(simplex_), eye - shift_);
  return {simplex_, closest.barycentric, closest.position, closest.distance};
}

template <int dim>
VisibilityTable<dim>::VisibilityTable(const NearbySurface<dim>& surface, SampleKind kind)
    : surface_(surface), kind_(kind), offset_(sample_offset<dim>(kind)) {
  const double h = surface.spacing();
  Box<dim> region;
  for (const Box<dim>& bounds : surface.bounds())
    region.extend(bounds);
  boxes_.build(surface.bounds(), region.intersection(surface.reached()),
               surface.lower() + h * offset_, h, [&](int i, const Point<dim>& center) {
                 return surface.images()[i].comes_into(center, 0.5 * h, surface.tolerance());
               });
  known_.assign(boxes_.n_used(), -1);
  for (int a = 0; a < dim; ++a) {
    const auto cell_of = [&](double x) {
      return static_cast<int>(std::lround((x - surface.lower()[a]) / h));
    };
    begin_[a] = surface.reached().isEmpty() ? 0 : cell_of(surface.reached().min()[a]);
    end_[a] = surface.reached().isEmpty() ? 0 : cell_of(surface.reached().max()[a]);
    end_[a] -= offset_[a] > 0 ? 1 : 0;
  }
}

template <int dim>
Box<dim> VisibilityTable<dim>::box_of(const Index<dim>& place) const {
  Point<dim> first;
  for (int a = 0; a < dim; ++a)
    first[a] = surface_.lower()[a] + surface_.spacing() * (place[a] + offset_[a]);
  return {first, first + Point<dim>::Constant(surface_.spacing())};
}

template <int dim>
BoxVisibility<dim> VisibilityTable<dim>::look_at(const Index<dim>& place,
                                                 const std::vector<Image>& images) const {
  typename BoxVisibility<dim>::Corners samples;
  for (int k = 0; k < 1 << dim; ++k)
    for (int a = 0; a < dim; ++a) {
      int i = place[a] + (k >> a & 1);
      if (!surface_.is_periodic(a))
        i = std::clamp(i, 0, surface_.n_cells()[a] - (a == kind_ ? 0 : 1));
      samples[k][a] = surface_.lower()[a] + surface_.spacing() * (i + offset_[a]);
    }
  return {surface_, images, box_of(place), samples};
}

template <int dim>
const BoxVisibility<dim>* VisibilityTable<dim>::around(const Point<dim>& x) const {
  if (surface_.empty())
    return nullptr;
  Index<dim> place;
  bool is_indexed = true;
  for (int a = 0; a < dim; ++a) {
    place[a] = static_cast<int>(std::floor(x[a] - offset_[a]));
    is_indexed = is_indexed && place[a] >= begin_[a] && place[a] < end_[a];
  }
  if (!is_indexed) {
    const std::vector<Image> images = surface_.images_in(box_of(place));
    if (images.empty())
      return nullptr;
    beyond_.emplace(look_at(place, images));
    return &*beyond_;
  }
  const auto list = boxes_.in(place);
  if (list.place < 0)
    return nullptr;
  int& known = known_[list.place];
  if (known < 0) {
    std::vector<Image> images;
    for (const int i : list)
      images.push_back(surface_.images()[i]);
    known = static_cast<int>(found_.size());
    found_.push_back(look_at(place, images));
  }
  return &found_[known];
}

template class BoxVisibility<2>;
template class BoxVisibility<3>;
template class VisibilityTable<2>;
template class VisibilityTable<3>;

}  // namespace lockstep
