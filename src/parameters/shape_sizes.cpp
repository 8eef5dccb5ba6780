#include "parameters/shape_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

std::vector<std::string> shape_names(const std::vector<ShapeSizes>& shapes, int dimension) {
  std::vector<std::string> names;
  for (const ShapeSizes& shape : shapes) {
    if (dimension >= shape.least_dimension)
      names.push_back(shape.shape);
  }
  return names;
}

void check_shape_sizes(const ParameterList& geometry, const std::vector<ShapeSizes>& shapes,
                       const std::string& name) {
  const auto& shape = geometry.get<std::string>("Shape");
  const auto own = std::find_if(shapes.begin(), shapes.end(),
                                [&](const ShapeSizes& sizes) { return sizes.shape == shape; });
  check_input(own != shapes.end(), "In \"{}/Geometry\", there is no shape \"{}\".", name, shape);
  for (const std::string& size : own->needed) {
    check_input(geometry.isParameter(size), "In \"{}/Geometry\", the shape \"{}\" needs \"{}\".",
                name, shape, size);
  }
  const auto refuse = [&](const std::string& size) {
    check_input(
        !geometry.isParameter(size) || contains(own->needed, size) || contains(own->optional, size),
        "In \"{}/Geometry\", the shape \"{}\" has no \"{}\"; leave it out.", name, shape, size);
  };
  for (const ShapeSizes& other : shapes) {
    std::for_each(other.needed.begin(), other.needed.end(), refuse);
    std::for_each(other.optional.begin(), other.optional.end(), refuse);
  }
}

void check_mesh_size(const ParameterList& geometry, double spacing, int dimension,
                     const std::string& name) {
  constexpr double most_elements = 1e8;
  double extent = 0;
  for (const char* size : {"Radius", "Length"}) {
    if (geometry.isParameter(size))
      extent = std::max(extent, geometry.get<double>(size));
  }
  if (geometry.isParameter("Size")) {
    for (const double edge : geometry.get<ParameterArray<double>>("Size"))
      extent = std::max(extent, edge);
  }
  const double n_elements = std::pow(extent / spacing, dimension);
  check_input(n_elements <= most_elements,
              "In \"{}/Geometry\", a body {:g} m long with a mesh of {:g} m would have some {:.0e} "
              "elements; make it smaller, or the mesh coarser.",
              name, extent, spacing, n_elements);
}

}  // namespace lockstep
