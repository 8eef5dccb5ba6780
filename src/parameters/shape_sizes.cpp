#include "parameters/shape_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/types.hpp"
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

namespace {

constexpr double most_elements = 1e7;

/// Edges of a box about the body, of a wall the third one its thickness [m]; none of a mesh file.
std::vector<double> edges_of(const ParameterList& geometry) {
  if (geometry.isParameter("Size")) {
    const auto& size = geometry.get<ParameterArray<double>>("Size");
    return {size.begin(), size.end()};
  }
  if (!geometry.isParameter("Radius"))
    return {};
  const double across = 2 * geometry.get<double>("Radius");
  const auto third = [&](const char* name, double otherwise) {
    return geometry.isParameter(name) ? geometry.get<double>(name) : otherwise;
  };
  const double length = third("Length", across);
  if (geometry.isParameter("Tube Radius"))
    return {pi * across, 2 * geometry.get<double>("Tube Radius"),
            2 * geometry.get<double>("Tube Radius")};
  return {across, length, third("Thickness", across)};
}

/// About the number of elements of a mesh of that dimension over a box.
double n_elements_of(std::vector<double> edges, double spacing, int dimension) {
  constexpr double in_a_cube = 6;
  std::sort(edges.rbegin(), edges.rend());
  double n = in_a_cube;
  for (int k = 0; k < std::min<int>(dimension, edges.size()); ++k)
    n *= std::max(1.0, edges[k] / spacing);
  return n;
}

}  // namespace

void check_mesh_size(const ParameterList& geometry, double spacing, int dimension,
                     const std::string& name) {
  const std::vector<double> edges = edges_of(geometry);
  if (edges.empty())
    return;
  const double n_elements = n_elements_of(edges, spacing, dimension);
  check_input(n_elements <= most_elements,
              "In \"{}/Geometry\", a body {:g} m long with a mesh of {:g} m would have some {:.0e} "
              "elements; make it smaller, or the mesh coarser.",
              name, *std::max_element(edges.begin(), edges.end()), spacing, n_elements);
}

void check_body_size(const ParameterList& geometry, double grid_spacing, double domain_length,
                     int dimension, const std::string& name) {
  constexpr double most_domains = 1000;
  const std::vector<double> edges = edges_of(geometry);
  if (edges.empty())
    return;
  const double length = *std::max_element(edges.begin(), edges.end());
  const double n_elements = geometry.isParameter("Mesh Spacing")
                                ? 0
                                : n_elements_of(edges, 0.7 * grid_spacing, dimension - 1);
  check_input(
      length <= most_domains * domain_length && n_elements <= most_elements,
      "In \"{}/Geometry\", the body is {:g} m long, in a domain of {:g} m{}; lengths are in "
      "metres: make it smaller.",
      name, length, domain_length,
      n_elements <= most_elements
          ? ""
          : fmt::format(", and its surface as fine as the grid would have some {:.0e} "
                        "elements",
                        n_elements));
}

}  // namespace lockstep
