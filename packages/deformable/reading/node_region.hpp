#pragma once
#include <string>
#include <vector>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Declares a box that picks nodes: "Lower" and "Upper", in coordinates of the body.
template <int dim>
void declare_node_region(ParameterList& list);

/// The nodes (numbers) in the box of a validated list. Throws InputError if there are none; `where`
/// names the list.
template <int dim>
std::vector<int> nodes_in_region(const ParameterList& list, const std::vector<Point<dim>>& nodes,
                                 const std::string& where);

/// Declares the named sublists "Loads" and "Tethers".
template <int dim>
void declare_loads_and_tethers(ParameterList& body);

/// Reads loads for nodes at these rest positions; `name` is the body's, for messages. Loads are
/// spread over the nodes in proportion to `node_measure`.
template <int dim>
std::vector<Point<dim>> read_loads(const ParameterList& body, const std::vector<Point<dim>>& nodes,
                                   const std::vector<double>& node_measure,
                                   const std::string& name);

/// A linear spring from a node to a fixed anchor.
template <int dim>
struct Tether {
  int node = -1;
  Point<dim> offset = Point<dim>::Zero();  ///< offset of the anchor from where the node starts [m]
  double stiffness = 0;                    ///< [N/m]
};
/// Reads the tethers of a body, whose stiffness is spread over the nodes in proportion to
/// `node_measure`.
template <int dim>
std::vector<Tether<dim>> read_tethers(const ParameterList& body,
                                      const std::vector<Point<dim>>& nodes,
                                      const std::vector<double>& node_measure,
                                      const std::string& name);

}  // namespace lockstep
