#include "deformable/mesh/hollow_generators.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "geometry/generators.hpp"
#include "geometry/surface_builder.hpp"

namespace lockstep {

namespace {

/// Prisms between copies of a surface, layer k of n scaled by `factor(k)` along the first `n_axes`
/// axes; each is cut into dim simplices, neighbours alike on their common side.
template <int dim, typename Factor>
VolumeMesh<dim> layered(const SurfaceMesh<dim>& surface, int n_layers, int n_axes,
                        const Factor& factor) {
  VolumeMesh<dim> mesh;
  const int n = static_cast<int>(surface.vertices.size());
  for (int layer = 0; layer <= n_layers; ++layer) {
    for (Point<dim> x : surface.vertices) {
      for (int a = 0; a < n_axes; ++a)
        x[a] *= factor(layer);
      mesh.vertices.push_back(x);
    }
  }
  for (int layer = 0; layer < n_layers; ++layer) {
    for (auto side : surface.simplices) {
      std::sort(side.begin(), side.end());
      for (int first_above = 0; first_above < dim; ++first_above) {
        typename VolumeMesh<dim>::Element element;
        for (int k = 0; k <= dim; ++k) {
          // Corners below up to first_above, then those above from it on.
          const bool above = k > first_above;
          element[k] = (layer + (above ? 1 : 0)) * n + side[above ? k - 1 : k];
        }
        mesh.elements.push_back(element);
      }
    }
  }
  orient_elements(mesh);
  return mesh;
}

void check_thickness(const char* shape, double radius, double thickness) {
  check_input(thickness > 0 && thickness < radius,
              "{}: the thickness of the wall must lie between 0 and the radius ({}), but is {}.",
              shape, radius, thickness);
}

}  // namespace

template <int dim>
VolumeMesh<dim> hollow_ball_volume(double radius, double thickness, double spacing) {
  check_thickness("Hollow ball", radius, thickness);
  const int n = n_steps(thickness, spacing);
  return layered<dim>(ball_surface<dim>(radius, spacing), n, dim,
                      [&](int layer) { return 1 - thickness / radius * (n - layer) / n; });
}

template <int dim>
VolumeMesh<dim> tube_volume(double radius, double thickness, double length, double spacing) {
  if constexpr (dim == 2) {
    throw InputError("A tube exists in 3D only; in 2D use \"hollow ball\" or a mesh file.");
  } else {
    check_thickness("Tube", radius, thickness);
    const int n = n_steps(thickness, spacing);
    return layered<dim>(tube_surface<dim>(radius, length, spacing), n, 2,
                        [&](int layer) { return 1 - thickness / radius * (n - layer) / n; });
  }
}

template VolumeMesh<2> hollow_ball_volume<2>(double, double, double);
template VolumeMesh<3> hollow_ball_volume<3>(double, double, double);
template VolumeMesh<2> tube_volume<2>(double, double, double, double);
template VolumeMesh<3> tube_volume<3>(double, double, double, double);

}  // namespace lockstep
