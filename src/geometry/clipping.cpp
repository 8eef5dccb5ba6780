#include "geometry/clipping.hpp"

#include <algorithm>

#include "geometry/convex_part.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

template <int dim>
ClippedSimplex<dim> clip_to_box(const std::array<Point<dim>, dim>& corners, const Box<dim>& box) {
  ClippedSimplex<dim> clipped;
  // Most simplices of a fine mesh.
  if (std::all_of(corners.begin(), corners.end(),
                  [&](const Point<dim>& corner) { return box.contains(corner); })) {
    clipped.measure = area_vector<dim>(corners).norm();
    clipped.barycentric.setConstant(1.0 / dim);
    for (const Point<dim>& corner : corners)
      clipped.centroid += corner / dim;
    return clipped;
  }
  ConvexPart<dim, true> part(corners);
  for (int a = 0; a < dim; ++a) {
    part.keep(a, box.min()[a], +1);
    part.keep(a, box.max()[a], -1);
    if (part.n_vertices() < dim)
      return clipped;
  }
  // A fan of simplices from vertex 0.
  for (int i = 1; i + dim - 2 < part.n_vertices(); ++i) {
    std::array<int, dim> fan{};
    for (int k = 1; k < dim; ++k)
      fan[k] = i + k - 1;
    std::array<Point<dim>, dim> points;
    Barycentric<dim> sum = Barycentric<dim>::Zero();
    for (int k = 0; k < dim; ++k) {
      points[k] = part.position(fan[k]);
      sum += part.barycentric(fan[k]);
    }
    const double measure = area_vector<dim>(points).norm();
    clipped.measure += measure;
    clipped.barycentric += measure / dim * sum;
  }
  if (clipped.measure <= 0)
    return {};
  clipped.barycentric /= clipped.barycentric.sum();
  for (int k = 0; k < dim; ++k)
    clipped.centroid += clipped.barycentric[k] * corners[k];
  return clipped;
}

template ClippedSimplex<2> clip_to_box<2>(const std::array<Point<2>, 2>&, const Box<2>&);
template ClippedSimplex<3> clip_to_box<3>(const std::array<Point<3>, 3>&, const Box<3>&);

}  // namespace lockstep
