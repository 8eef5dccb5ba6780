#pragma once
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A shape of a "Geometry" and the parameters that only some shapes have.
struct ShapeSizes {
  std::string shape;
  std::vector<std::string> needed;
  std::vector<std::string> optional = {};
  int least_dimension = 2;
};

/// Returns the names of the shapes that exist in this dimension.
std::vector<std::string> shape_names(const std::vector<ShapeSizes>& shapes, int dimension);

/// Throws InputError if `geometry` lacks a size that its "Shape" needs, or has one that only others
/// take. `name`: of the body, for the sentence.
void check_shape_sizes(const ParameterList& geometry, const std::vector<ShapeSizes>& shapes,
                       const std::string& name);

/// Throws InputError if a mesh of that spacing [m] would have so many elements, above 1e7, that a
/// typing error is likelier. `dimension`: of the elements. Of mesh files it knows nothing.
void check_mesh_size(const ParameterList& geometry, double spacing, int dimension,
                     const std::string& name);

/// Throws InputError if a body is a thousand times as long as its domain, whose longest edge is
/// given [m], or if its surface at the grid's spacing [m] is too large. `dimension`: of space.
void check_body_size(const ParameterList& geometry, double grid_spacing, double domain_length,
                     int dimension, const std::string& name);

}  // namespace lockstep
