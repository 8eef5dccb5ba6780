#include "coupling/repeated_solids.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
template <int dim>
Box<dim> bounds_of(const SurfaceMesh<dim>& mesh, const SolidDescription& solid) {
  Box<dim> box;
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
    box.extend(mesh.vertices[v]);
  return box;
}

/// A point that moves with a rigid solid.
template <int dim>
Point<dim> middle_of(const SurfaceMesh<dim>& mesh, const SolidDescription& solid) {
  Point<dim> sum = Point<dim>::Zero();
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
    sum += mesh.vertices[v];
  return sum / std::max(solid.vertex_end - solid.vertex_begin, 1);
}

/// True if the middle of a solid is nearer to all its points, and to what is within two margins,
/// than half a period: so that of the images of a point the nearest is the solid's.
template <int dim>
bool fits_between_images(const SurfaceMesh<dim>& mesh, const SolidDescription& solid,
                         const Point<dim>& period, double margin) {
  const Point<dim> middle = middle_of<dim>(mesh, solid);
  double reach = 0;
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
    reach = std::max(reach, (mesh.vertices[v] - middle).norm());
  for (int a = 0; a < dim; ++a)
    if (period[a] > 0 && reach + 2 * margin > 0.5 * period[a])
      return false;
  return reach > 0;
}

/// The whole periods that bring a point into the domain.
template <int dim>
Point<dim> shift_into(const Box<dim>& domain, const Point<dim>& period, const Point<dim>& x) {
  Point<dim> shift = Point<dim>::Zero();
  for (int a = 0; a < dim; ++a)
    if (period[a] > 0)
      shift[a] = -period[a] * std::floor((x[a] - domain.min()[a]) / period[a]);
  return shift;
}

/// Calls f(shift) for the places around: one period on and one back along each periodic axis.
template <int dim, typename Function>
void for_each_shift(const Point<dim>& period, const Function& f) {
  for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
    Point<dim> shift;
    bool exists = true;
    for (int a = 0, rest = k; a < dim; ++a, rest /= 3) {
      shift[a] = (rest % 3 - 1) * period[a];
      exists = exists && (period[a] > 0 || rest % 3 == 1);
    }
    if (exists && !shift.isZero(0))
      f(shift);
  }
}
}  // namespace

template <int dim>
RepeatedSolids<dim>::RepeatedSolids(const Box<dim>& domain, const std::array<bool, dim>& periodic,
                                    double margin, const std::vector<SolidDescription>& solids,
                                    const SurfaceMesh<dim>& mesh, std::vector<char> wanted)
    : domain_(domain), margin_(margin) {
  for (int a = 0; a < dim; ++a)
    images_.period[a] = periodic[a] ? domain.sizes()[a] : 0;
  for (const SolidDescription& solid : solids)
    own_middle_.push_back(middle_of<dim>(mesh, solid));
  for (std::size_t i = 0; i < solids.size(); ++i)
    wanted[i] = wanted[i] && fits_between_images<dim>(mesh, solids[i], images_.period, margin);
  if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end())
    return;
  images_.repeated = std::move(wanted);
  for (std::size_t i = 0; i < solids.size(); ++i)
    solid_of_simplex_.resize(solids[i].simplex_end, static_cast<int>(i));
}

template <int dim>
SurfacePoint<dim> RepeatedSolids<dim>::own_point(SurfacePoint<dim> point) const {
  const int n_own = static_cast<int>(solid_of_simplex_.size());
  if (point.simplex >= n_own)
    point.simplex = simplex_of_image_[point.simplex - n_own];
  point.position = own_place(solid_of_simplex_[point.simplex], point.position);
  return point;
}

template <int dim>
void RepeatedSolids<dim>::show(const std::vector<SolidDescription>& solids,
                               const SurfaceSnapshot<dim>* before, SurfaceMesh<dim>& mesh) {
  const Point<dim> margin = Point<dim>::Constant(margin_);
  const Box<dim> room(domain_.min() - margin, domain_.max() + margin);
  images_.others.clear();
  images_.shifts.assign(solids.size(), Point<dim>::Zero());
  simplex_of_image_.clear();
  for (int i = 0; i < static_cast<int>(solids.size()); ++i) {
    if (!includes(i))
      continue;
    Box<dim> box = bounds_of<dim>(mesh, solids[i]);
    own_middle_[i] = middle_of<dim>(mesh, solids[i]);
    const Point<dim> shift = shift_into<dim>(domain_, images_.period, own_middle_[i]);
    images_.shifts[i] = shift;
    for (int v = solids[i].vertex_begin; v < solids[i].vertex_end; ++v)
      mesh.vertices[v] += shift;
    box.translate(shift);
    if (before)
      box.extend(before->own_bounds(i).translated(shift - before->images().shifts[i]));
    for_each_shift<dim>(images_.period, [&](const Point<dim>& further) {
      if (!room.intersects(box.translated(further)))
        return;
      images_.others.push_back({i, further});
      for (int s = solids[i].simplex_begin; s < solids[i].simplex_end; ++s)
        simplex_of_image_.push_back(s);
    });
  }
}

template class RepeatedSolids<2>;
template class RepeatedSolids<3>;

}  // namespace lockstep
