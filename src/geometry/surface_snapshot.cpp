#include "geometry/surface_snapshot.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.hpp"
#include "geometry/line_crossing.hpp"
#include "geometry/simplex_queries.hpp"

namespace lockstep {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;

namespace {

template <int dim>
using TreePoint = bg::model::point<double, dim, bg::cs::cartesian>;
template <int dim>
using TreeBox = bg::model::box<TreePoint<dim>>;
template <int dim>
using Tree = bgi::rtree<std::pair<TreeBox<dim>, int>, bgi::quadratic<16>>;

template <int dim>
TreePoint<dim> tree_point(const Point<dim>& x) {
  if constexpr (dim == 2) {
    return {x[0], x[1]};
  } else {
    return {x[0], x[1], x[2]};
  }
}

template <int dim>
TreeBox<dim> tree_box(const Box<dim>& box) {
  return {tree_point<dim>(box.min()), tree_point<dim>(box.max())};
}

template <int dim>
Tree<dim> build_tree(const std::vector<Box<dim>>& boxes) {
  std::vector<std::pair<TreeBox<dim>, int>> entries;
  entries.reserve(boxes.size());
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    if (!boxes[i].isEmpty())
      entries.emplace_back(tree_box<dim>(boxes[i]), i);
  return Tree<dim>(entries.begin(), entries.end());
}

template <int dim>
void find_touching(const Tree<dim>& tree, const Box<dim>& box, std::vector<int>& found) {
  found.clear();
  if (box.isEmpty())
    return;
  tree.query(bgi::intersects(tree_box<dim>(box)),
             boost::make_function_output_iterator(
                 [&found](const auto& entry) { found.push_back(entry.second); }));
  std::sort(found.begin(), found.end());
}

template <int dim>
Box<dim> grown(const Box<dim>& box, double distance) {
  const Point<dim> margin = Point<dim>::Constant(distance);
  return {box.min() - margin, box.max() + margin};
}

/// The lines along `axis` whose centre coordinates lie in the shadow of a box: [begin, end) per
/// transverse axis, one line of slack for round-off, cut to the wanted lines.
template <int dim>
void shadow(const Lattice<dim>& lattice, const Box<dim>& box, int axis, Index<dim>& begin,
            Index<dim>& end) {
  for (int a = 0; a < dim; ++a) {
    if (a == axis) {
      begin[a] = 0;
      end[a] = 1;
      continue;
    }
    const double first = std::floor((box.min()[a] - lattice.lower[a]) / lattice.spacing - 0.5);
    const double last = std::ceil((box.max()[a] - lattice.lower[a]) / lattice.spacing - 0.5);
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
struct SurfaceSnapshot<dim>::Implementation {
  SurfaceMesh<dim> mesh;
  std::vector<SolidDescription> solids;
  std::vector<int> solid_of;  ///< per simplex, -1: none
  std::vector<Box<dim>> bounds, solid_bounds;
  double typical_size = 0;  ///< mean diagonal of the simplices' boxes [m]
  Tree<dim> tree, solid_tree;
};

template <int dim>
SurfaceSnapshot<dim>::SurfaceSnapshot(SurfaceMesh<dim> mesh, std::vector<SolidDescription> solids)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& own = *implementation_;
  own.mesh = std::move(mesh);
  own.solids = std::move(solids);
  const int n = n_simplices();
  own.bounds.resize(n);
  for (int s = 0; s < n; ++s) {
    for (const int v : own.mesh.simplices[s])
      own.bounds[s].extend(own.mesh.vertices[v]);
    own.typical_size += own.bounds[s].diagonal().norm() / n;
  }
  own.solid_of.assign(n, -1);
  own.solid_bounds.resize(own.solids.size());
  for (int i = 0; i < static_cast<int>(own.solids.size()); ++i) {
    LOCKSTEP_ASSERT(own.solids[i].simplex_begin >= 0 && own.solids[i].simplex_end <= n);
    for (int s = own.solids[i].simplex_begin; s < own.solids[i].simplex_end; ++s) {
      own.solid_of[s] = i;
      own.solid_bounds[i].extend(own.bounds[s]);
    }
  }
  own.tree = build_tree<dim>(own.bounds);
  own.solid_tree = build_tree<dim>(own.solid_bounds);
}

template <int dim>
SurfaceSnapshot<dim>::~SurfaceSnapshot() = default;
template <int dim>
SurfaceSnapshot<dim>::SurfaceSnapshot(SurfaceSnapshot&&) noexcept = default;

template <int dim>
const SurfaceMesh<dim>& SurfaceSnapshot<dim>::mesh() const {
  return implementation_->mesh;
}

template <int dim>
const std::vector<SolidDescription>& SurfaceSnapshot<dim>::solids() const {
  return implementation_->solids;
}

template <int dim>
int SurfaceSnapshot<dim>::solid_of(int simplex) const {
  return implementation_->solid_of[simplex];
}

template <int dim>
std::array<Point<dim>, dim> SurfaceSnapshot<dim>::corners(int simplex) const {
  std::array<Point<dim>, dim> points;
  const auto& vertices = implementation_->mesh.simplices[simplex];
  for (int k = 0; k < dim; ++k)
    points[k] = implementation_->mesh.vertices[vertices[k]];
  return points;
}

template <int dim>
Box<dim> SurfaceSnapshot<dim>::bounds(int simplex) const {
  return implementation_->bounds[simplex];
}

template <int dim>
Box<dim> SurfaceSnapshot<dim>::bounds_of_solid(int solid) const {
  return implementation_->solid_bounds[solid];
}

template <int dim>
void SurfaceSnapshot<dim>::touching(const Box<dim>& box, std::vector<int>& found) const {
  find_touching<dim>(implementation_->tree, box, found);
}

template <int dim>
void SurfaceSnapshot<dim>::solids_touching(const Box<dim>& box, std::vector<int>& found) const {
  find_touching<dim>(implementation_->solid_tree, box, found);
}

template <int dim>
bool SurfaceSnapshot<dim>::touches(const Box<dim>& box) const {
  if (box.isEmpty())
    return false;
  const Tree<dim>& tree = implementation_->tree;
  return tree.qbegin(bgi::intersects(tree_box<dim>(box))) != tree.qend();
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
  const int n_pieces = static_cast<int>(std::clamp(
      std::ceil(length / (piece_length * implementation_->typical_size + tolerance)), 1.0, 100.0));
  const double margin = tolerance + 1e-12 * (length + a.cwiseAbs().maxCoeff());
  std::optional<SurfacePoint<dim>> best;
  std::vector<int> candidates;
  for (int piece = 0; piece < n_pieces; ++piece) {
    const double from = static_cast<double>(piece) / n_pieces;
    const double to = static_cast<double>(piece + 1) / n_pieces;
    Box<dim> box(a + from * (b - a));
    box.extend(a + to * (b - a));
    touching(grown<dim>(box, margin), candidates);
    for (const int s : candidates) {
      const auto hit = hit_simplex<dim>(corners(s), a, b, tolerance);
      if (hit && (!best || hit->fraction < best->fraction))
        best = SurfacePoint<dim>{s, hit->barycentric, hit->position, hit->fraction};
    }
    if (best && best->fraction <= to)
      break;
  }
  return best;
}

template <int dim>
std::optional<SurfacePoint<dim>> SurfaceSnapshot<dim>::closest(const Point<dim>& x,
                                                               double radius) const {
  // Most of what is found is near, and the box of a small radius holds much less.
  std::vector<int> candidates;
  std::optional<SurfacePoint<dim>> best;
  for (const double part : {0.25, 1.0}) {
    touching(grown<dim>(Box<dim>(x), part * radius), candidates);
    for (const int s : candidates) {
      const double reach = best ? best->fraction : part * radius;
      if (bounds(s).squaredExteriorDistance(x) > reach * reach)
        continue;
      const auto near = closest_on_simplex<dim>(corners(s), x);
      if (best ? near.distance < reach : near.distance <= reach)
        best = SurfacePoint<dim>{s, near.barycentric, near.position, near.distance};
    }
    if (best)
      break;
  }
  return best;
}

template <int dim>
SurfacePoint<dim> SurfaceSnapshot<dim>::closest_on_solid(const Point<dim>& x, int solid) const {
  const SolidDescription& description = solids()[solid];
  SurfacePoint<dim> best;
  best.fraction = std::numeric_limits<double>::infinity();
  const auto consider = [&](int s) {
    if (bounds(s).squaredExteriorDistance(x) >= best.fraction * best.fraction)
      return;
    const auto near = closest_on_simplex<dim>(corners(s), x);
    if (near.distance < best.fraction)
      best = {s, near.barycentric, near.position, near.distance};
  };
  // The simplex with the nearest box bounds the distance; the tree then finds all that are nearer.
  implementation_->tree.query(
      bgi::nearest(tree_point<dim>(x), 1) && bgi::satisfies([&](const auto& entry) {
        return entry.second >= description.simplex_begin && entry.second < description.simplex_end;
      }),
      boost::make_function_output_iterator([&](const auto& entry) { consider(entry.second); }));
  if (best.simplex < 0)
    return best;
  std::vector<int> candidates;
  touching(grown<dim>(Box<dim>(x), best.fraction), candidates);
  for (const int s : candidates)
    if (solid_of(s) == solid)
      consider(s);
  return best;
}

template <int dim>
int SurfaceSnapshot<dim>::inside(const Point<dim>& x) const {
  constexpr int axis = 0;
  std::vector<int> around, candidates;
  solids_touching(Box<dim>(x, x), around);
  for (const int solid : around) {
    if (!solids()[solid].closed)
      continue;
    // The number of crossings of the whole line is even, so either half gives the same parity.
    const Box<dim> extent = bounds_of_solid(solid);
    const bool below = x[axis] - extent.min()[axis] < extent.max()[axis] - x[axis];
    Box<dim> ray(x, x);
    (below ? ray.min() : ray.max())[axis] = (below ? extent.min() : extent.max())[axis];
    touching(ray, candidates);
    bool odd = false;
    for (const int s : candidates) {
      Crossing<dim> crossing;
      if (solid_of(s) == solid && cross_line<dim>(corners(s), axis, x, crossing) &&
          (crossing.coordinate <= x[axis]) == below)
        odd = !odd;
    }
    if (odd)
      return solid;
  }
  return -1;
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

template class SurfaceSnapshot<2>;
template class SurfaceSnapshot<3>;

}  // namespace lockstep
