#include "geometry/surface_snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.hpp"
#include "geometry/line_crossing.hpp"
#include "geometry/simplex_queries.hpp"

namespace lockstep {

namespace {

template <int dim>
Box<dim> grown(const Box<dim>& box, double distance) {
  const Point<dim> margin = Point<dim>::Constant(distance);
  return {box.min() - margin, box.max() + margin};
}

/// True if this place comes before another one; of two places as near, that of the first simplex
/// counts.
template <int dim>
bool comes_before(double fraction, int simplex, const SurfacePoint<dim>& other) {
  return fraction < other.fraction || (fraction == other.fraction && simplex < other.simplex);
}

/// Takes the closest point of a simplex if it is closer than the one found, or no farther than the
/// limit if none is.
template <int dim>
void take_closer(int simplex, const std::array<Point<dim>, dim>& corners, const Point<dim>& x,
                 SurfacePoint<dim>& best) {
  const auto near = closest_on_simplex<dim>(corners, x);
  if (best.simplex < 0 ? near.distance <= best.fraction
                       : comes_before<dim>(near.distance, simplex, best))
    best = {simplex, near.barycentric, near.position, near.distance};
}

/// The lines along `axis` whose centre coordinates lie in the shadow of a box: [begin, end) per
/// transverse axis, with some slack for round-off, cut to the wanted lines.
template <int dim>
void shadow(const Lattice<dim>& lattice, const Box<dim>& box, int axis, Index<dim>& begin,
            Index<dim>& end) {
  for (int a = 0; a < dim; ++a) {
    if (a == axis) {
      begin[a] = 0;
      end[a] = 1;
      continue;
    }
    constexpr double slack = 1e-3;
    const double low = (box.min()[a] - lattice.lower[a]) / lattice.spacing - 0.5;
    const double high = (box.max()[a] - lattice.lower[a]) / lattice.spacing - 0.5;
    const double first = std::ceil(low - slack), last = std::floor(high + slack);
    begin[a] = static_cast<int>(std::clamp<double>(first, begin[a], end[a]));
    end[a] = static_cast<int>(std::clamp<double>(last + 1, begin[a], end[a]));
  }
}

/// Calls f for every cell of [begin, end).
template <int dim, typename Function>
void for_each_cell(const Index<dim>& begin, const Index<dim>& end, Function f) {
  for (int a = 0; a < dim; ++a)
    if (begin[a] >= end[a])
      return;
  Index<dim> cell = begin;
  while (true) {
    f(cell);
    int a = dim - 1;
    while (a >= 0 && ++cell[a] == end[a]) {
      cell[a] = begin[a];
      --a;
    }
    if (a < 0)
      return;
  }
}

}  // namespace

template <int dim>
SolidDescription append_copy(const SolidDescription& solid, const Point<dim>& shift,
                             SurfaceMesh<dim>& mesh) {
  SolidDescription copy = solid;
  copy.vertex_begin = static_cast<int>(mesh.vertices.size());
  copy.simplex_begin = static_cast<int>(mesh.simplices.size());
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
    mesh.vertices.push_back(mesh.vertices[v] + shift);
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    auto simplex = mesh.simplices[s];
    for (int& vertex : simplex)
      vertex += copy.vertex_begin - solid.vertex_begin;
    mesh.simplices.push_back(simplex);
  }
  copy.vertex_end = static_cast<int>(mesh.vertices.size());
  copy.simplex_end = static_cast<int>(mesh.simplices.size());
  return copy;
}

template <int dim>
SurfaceSnapshot<dim>::SurfaceSnapshot(SurfaceMesh<dim> mesh, std::vector<SolidDescription> solids,
                                      BoxOrder order, SolidImages<dim> images)
    : mesh_(std::move(mesh)), solids_(std::move(solids)), images_(std::move(images)) {
  const int n_own = n_simplices();
  add_images();
  const int n = n_simplices();
  std::vector<Box<dim>> bounds(n), solid_bounds(solids_.size());
  for (int s = 0; s < n; ++s) {
    for (const int v : mesh_.simplices[s])
      bounds[s].extend(mesh_.vertices[v]);
    typical_size_ += bounds[s].diagonal().norm() / n;
  }
  solid_of_.resize(n, -1);
  for (int i = 0; i < static_cast<int>(solids_.size()); ++i) {
    LOCKSTEP_ASSERT(solids_[i].simplex_begin >= 0 && solids_[i].simplex_end <= n_own);
    for (int s = solids_[i].simplex_begin; s < solids_[i].simplex_end; ++s) {
      solid_of_[s] = i;
      solid_bounds[i].extend(bounds[s]);
    }
  }
  if (n > n_own)
    own_bounds_ = solid_bounds;
  for (int s = n_own; s < n; ++s)
    solid_bounds[solid_of_[s]].extend(bounds[s]);
  tree_ = BoxTree<dim>(std::move(bounds), std::move(order));
  solid_tree_ = BoxTree<dim>(std::move(solid_bounds));
}

template <int dim>
void SurfaceSnapshot<dim>::add_images() {
  solid_of_.assign(n_simplices(), -1);
  for (const auto& image : images_.others) {
    const SolidDescription copy = append_copy<dim>(solids_[image.solid], image.shift, mesh_);
    solid_of_.resize(copy.simplex_end, image.solid);
  }
}

template <int dim>
bool SurfaceSnapshot<dim>::is_shown_at(int simplex, const Point<dim>& shift) const {
  const int solid = solid_of_[simplex];
  if (solid < 0 || !images_.repeats(solid))
    return false;
  Point<dim> place = shift;  // from the first image
  int end = solids_.back().simplex_end;
  for (auto image = images_.others.begin(); simplex >= end; ++image) {
    end += solids_[image->solid].simplex_end - solids_[image->solid].simplex_begin;
    if (simplex < end)
      place += image->shift;
  }
  const double slack = 1e-9 * images_.period.maxCoeff();
  return place.isZero(slack) ||
         std::any_of(images_.others.begin(), images_.others.end(), [&](const auto& image) {
           return image.solid == solid && (place - image.shift).isZero(slack);
         });
}

template <int dim>
std::vector<Box<dim>> SurfaceSnapshot<dim>::bounds_of_images(int solid) const {
  std::vector<Box<dim>> all{own_bounds(solid)};
  for (const auto& image : images_.others)
    if (image.solid == solid)
      all.push_back(own_bounds(solid).translated(image.shift));
  return all;
}

template <int dim>
Box<dim> SurfaceSnapshot<dim>::room_of(int solid, Box<dim> box) const {
  for (int a = 0; a < dim; ++a)
    if (images_.repeats(solid) && images_.period[a] > 0) {
      box.min()[a] = std::min(box.min()[a], own_bounds(solid).min()[a]);
      box.max()[a] = std::max(box.max()[a], own_bounds(solid).max()[a]);
    }
  return box;
}

template <int dim>
void SurfaceSnapshot<dim>::touching(const Box<dim>& box, std::vector<int>& found) const {
  tree_.touching(box, found);
}

template <int dim>
void SurfaceSnapshot<dim>::solids_touching(const Box<dim>& box, std::vector<int>& found) const {
  solid_tree_.touching(box, found);
}

template <int dim>
bool SurfaceSnapshot<dim>::touches(const Box<dim>& box) const {
  return tree_.any_touching(box, [](int) { return true; });
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceSnapshot<dim>::first_hit(const Point<dim>& a,
                                                                 const Point<dim>& b,
                                                                 double tolerance) const {
  if (empty())
    return std::nullopt;
  if (a == b) {
    auto point = closest(a, tolerance);
    if (point)
      point->fraction = 0;
    return point;
  }
  // Long segments are searched piece by piece: the box of the whole would hold too much.
  constexpr double piece_length = 8;  // in typical simplices
  const double length = (b - a).norm();
  const int n_pieces = static_cast<int>(
      std::clamp(std::ceil(length / (piece_length * typical_size_ + tolerance)), 1.0, 100.0));
  const double margin = tolerance + 1e-12 * (length + a.cwiseAbs().maxCoeff());
  std::optional<SurfacePoint<dim>> best;
  for (int piece = 0; piece < n_pieces; ++piece) {
    const double from = static_cast<double>(piece) / n_pieces;
    const double to = static_cast<double>(piece + 1) / n_pieces;
    Box<dim> box(a + from * (b - a));
    box.extend(a + to * (b - a));
    tree_.any_touching(grown<dim>(box, margin), [&](int s) {
      const auto hit = hit_simplex<dim>(corners(s), a, b, tolerance);
      if (hit && (!best || comes_before<dim>(hit->fraction, s, *best)))
        best = SurfacePoint<dim>{s, hit->barycentric, hit->position, hit->fraction};
      return false;
    });
    if (best && best->fraction <= to)
      break;
  }
  return best;
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceSnapshot<dim>::closest(const Point<dim>& x,
                                                               double radius) const {
  SurfacePoint<dim> best;
  best.fraction = radius;
  const auto reach = [&] { return best.fraction * best.fraction; };
  tree_.near(x, reach, [&](int s) { take_closer<dim>(s, corners(s), x, best); });
  return best.simplex < 0 ? std::nullopt : std::make_optional(best);
}

template <int dim>
SurfacePoint<dim> SurfaceSnapshot<dim>::closest_on_solid(const Point<dim>& x, int solid) const {
  SurfacePoint<dim> best;
  best.fraction = std::numeric_limits<double>::infinity();
  const auto reach = [&] { return best.fraction * best.fraction; };
  tree_.near(x, reach, [&](int s) {
    if (solid_of(s) == solid)
      take_closer<dim>(s, corners(s), x, best);
  });
  return best;
}

template <int dim>
int SurfaceSnapshot<dim>::inside(const Point<dim>& x) const {
  constexpr int axis = 0;
  int first = -1;
  solid_tree_.any_touching(Box<dim>(x, x), [&](int solid) {
    if (!solids_[solid].closed || (first >= 0 && first < solid))
      return false;
    // The number of crossings of the whole line is even, so either half gives the same parity.
    const Box<dim> extent = bounds_of_solid(solid);
    const bool below = x[axis] - extent.min()[axis] < extent.max()[axis] - x[axis];
    Box<dim> ray(x, x);
    (below ? ray.min() : ray.max())[axis] = (below ? extent.min() : extent.max())[axis];
    bool odd = false;
    tree_.any_touching(ray, [&](int s) {
      Crossing<dim> crossing;
      if (solid_of(s) == solid && cross_line<dim>(corners(s), axis, x, crossing) &&
          (crossing.coordinate <= x[axis]) == below)
        odd = !odd;
      return false;
    });
    if (odd)
      first = solid;
    return false;
  });
  return first;
}

template <int dim>
LatticeCrossings<dim> SurfaceSnapshot<dim>::cross_lattice(const Lattice<dim>& lattice,
                                                          const Index<dim>& begin,
                                                          const Index<dim>& end) const {
  LatticeCrossings<dim> result;
  for (int a = 0; a < dim; ++a)
    if (begin[a] >= end[a])
      return result;
  std::vector<std::pair<Index<dim>, Crossing<dim>>> found;
  for (int axis = 0; axis < dim; ++axis) {
    Index<dim> last = end;
    for (int a = 0; a < dim; ++a)
      --last[a];
    Box<dim> column(lattice.center(begin));
    column.extend(lattice.center(last));
    column.min()[axis] = -std::numeric_limits<double>::infinity();
    column.max()[axis] = std::numeric_limits<double>::infinity();

    found.clear();
    for (int s = 0; s < n_simplices(); ++s) {
      // The column holds most of a surface, or all: the tree would only sort it.
      if (!column.intersects(bounds(s)))
        continue;
      const auto points = corners(s);
      Index<dim> first_line = begin, end_line = end;
      shadow<dim>(lattice, bounds(s), axis, first_line, end_line);
      for_each_cell<dim>(first_line, end_line, [&](const Index<dim>& cell) {
        Crossing<dim> crossing;
        if (!cross_line<dim>(points, axis, lattice.center(cell), crossing))
          return;
        crossing.simplex = s;
        found.emplace_back(cell, crossing);
      });
    }
    std::sort(found.begin(), found.end(), [](const auto& l, const auto& r) {
      return std::tie(l.first, l.second.coordinate, l.second.simplex) <
             std::tie(r.first, r.second.coordinate, r.second.simplex);
    });
    auto& lines = result.lines[axis];
    for (const auto& [cell, crossing] : found) {
      if (lines.empty() || lines.back().cell != cell)
        lines.push_back({cell, {}});
      lines.back().crossings.push_back(crossing);
    }
  }
  return result;
}

template <int dim>
SurfaceMesh<dim> SurfaceSnapshot<dim>::mesh_of_solid(int solid) const {
  const SolidDescription& range = solids()[solid];
  SurfaceMesh<dim> part;
  part.vertices.assign(mesh().vertices.begin() + range.vertex_begin,
                       mesh().vertices.begin() + range.vertex_end);
  part.simplices.assign(mesh().simplices.begin() + range.simplex_begin,
                        mesh().simplices.begin() + range.simplex_end);
  for (auto& simplex : part.simplices) {
    for (int& vertex : simplex)
      vertex -= range.vertex_begin;
  }
  return part;
}

template SolidDescription append_copy(const SolidDescription&, const Point<2>&, SurfaceMesh<2>&);
template SolidDescription append_copy(const SolidDescription&, const Point<3>&, SurfaceMesh<3>&);
template class SurfaceSnapshot<2>;
template class SurfaceSnapshot<3>;

}  // namespace lockstep
