#include "contact/bodies/contact_images.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
template <int dim>
using Image = typename SolidImages<dim>::Image;

template <int dim>
std::vector<Box<dim>> reached_boxes(const SolidSystem<dim>& system, const SurfaceMesh<dim>& mesh) {
  const Point<dim> margin = Point<dim>::Constant(0.5 * system.repeated().margin());
  std::vector<Box<dim>> boxes;
  for (const SolidDescription& solid : system.solids()) {
    Box<dim> box;
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
      box.extend(mesh.vertices[v]);
    boxes.push_back(box.isEmpty() ? box : Box<dim>(box.min() - margin, box.max() + margin));
  }
  return boxes;
}

/// Adds the images of a solid, itself apart, that meet a box.
template <int dim>
void add_images(int solid, const Box<dim>& own, const Box<dim>& box, const Point<dim>& period,
                std::vector<Image<dim>>& images) {
  Index<dim> first{}, count{};
  int n = 1;
  for (int a = 0; a < dim; ++a) {
    int last = 0;
    if (period[a] > 0) {
      first[a] = static_cast<int>(std::ceil((box.min()[a] - own.max()[a]) / period[a]));
      last = static_cast<int>(std::floor((box.max()[a] - own.min()[a]) / period[a]));
    } else if (own.min()[a] > box.max()[a] || own.max()[a] < box.min()[a]) {
      return;
    }
    count[a] = std::max(last - first[a] + 1, 0);
    n *= count[a];
  }
  for (int i = 0; i < n; ++i) {
    Image<dim> image{solid, Point<dim>::Zero()};
    for (int a = 0, rest = i; a < dim; rest /= count[a], ++a)
      image.shift[a] = (first[a] + rest % count[a]) * period[a];
    if (!image.shift.isZero(0) && std::find(images.begin(), images.end(), image) == images.end())
      images.push_back(image);
  }
}
}  // namespace

template <int dim>
std::vector<typename SolidImages<dim>::Image> contact_images(const SolidSystem<dim>& system,
                                                             const SurfaceMesh<dim>& mesh) {
  const auto& solids = system.solids();
  const auto deforms = [](const SolidDescription& solid) { return !solid.rigid; };
  std::vector<Image<dim>> images;
  if (system.repeated().empty() || std::any_of(solids.begin(), solids.end(), deforms))
    return images;
  const std::vector<Box<dim>> boxes = reached_boxes(system, mesh);
  for (int j = 0; j < static_cast<int>(solids.size()); ++j) {
    if (!system.repeated().includes(j))
      continue;
    std::vector<Image<dim>> of_solid;
    for (int i = 0; i < static_cast<int>(solids.size()); ++i)
      if (!boxes[i].isEmpty() && (i < j || !system.repeated().includes(i)) && i != j)
        add_images<dim>(j, boxes[j], boxes[i], system.repeated().images().period, of_solid);
    images.insert(images.end(), of_solid.begin(), of_solid.end());
  }
  return images;
}

template std::vector<SolidImages<2>::Image> contact_images<2>(const SolidSystem<2>&,
                                                              const SurfaceMesh<2>&);
template std::vector<SolidImages<3>::Image> contact_images<3>(const SolidSystem<3>&,
                                                              const SurfaceMesh<3>&);

}  // namespace lockstep
