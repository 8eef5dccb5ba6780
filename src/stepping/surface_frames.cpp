#include "stepping/surface_frames.hpp"

namespace lockstep {

template <int dim>
std::vector<SurfaceFrame> surface_frames(const SolidSystem<dim>& solids,
                                         const SurfaceSnapshot<dim>& surface) {
  std::vector<SurfaceFrame> frames;
  for (const SolidDescription& solid : surface.solids()) {
    if (solid.simplex_begin == solid.simplex_end)
      continue;  // the fluid does not see it; its model may show it
    SurfaceFrame frame;
    frame.name = solid.name;
    frame.dimension = dim;
    frame.simplex_size = dim;
    SurfaceField velocity{"velocity", "m/s", dim, SurfaceField::Place::simplices, {}};
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
      for (int a = 0; a < dim; ++a)
        frame.vertices.push_back(surface.mesh().vertices[v][a]);
    }
    for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
      SurfacePoint<dim> middle;
      middle.simplex = s;
      middle.barycentric.setConstant(1. / dim);
      for (int vertex : surface.mesh().simplices[s]) {
        frame.simplices.push_back(vertex - solid.vertex_begin);
        middle.position += surface.mesh().vertices[vertex] / dim;
      }
      const Point<dim> v = solids.effective_velocity(middle, middle.position);
      velocity.values.insert(velocity.values.end(), v.data(), v.data() + dim);
    }
    frame.fields.push_back(std::move(velocity));
    frames.push_back(std::move(frame));
  }
  return frames;
}

template std::vector<SurfaceFrame> surface_frames(const SolidSystem<2>&, const SurfaceSnapshot<2>&);
template std::vector<SurfaceFrame> surface_frames(const SolidSystem<3>&, const SurfaceSnapshot<3>&);

}  // namespace lockstep
