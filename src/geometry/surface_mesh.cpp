#include "geometry/surface_mesh.hpp"

namespace lockstep {

template <int dim>
Point<dim> area_vector(const std::array<Point<dim>, dim>& corners) {
  const Point<dim> edge = corners[1] - corners[0];
  if constexpr (dim == 2) {
    return Point<2>(edge.y(), -edge.x());
  } else {
    return 0.5 * edge.cross(corners[2] - corners[0]);
  }
}

template Point<2> area_vector<2>(const std::array<Point<2>, 2>&);
template Point<3> area_vector<3>(const std::array<Point<3>, 3>&);

}  // namespace lockstep
