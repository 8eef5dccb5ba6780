#include "deformable/reading/node_region.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

template <int dim>
std::vector<std::string> axes() {
  std::vector<std::string> names{"x", "y", "z"};
  names.resize(dim);
  return names;
}

}  // namespace

template <int dim>
void declare_node_region(ParameterList& list) {
  for (const char* corner : {"Lower", "Upper"}) {
    declare_required_vector<double>(list, corner, dim,
                                    "Corner of the box that holds the nodes meant, in coordinates "
                                    "of the body at rest [m]; its sides belong to it.");
  }
}

template <int dim>
std::vector<int> nodes_in_region(const ParameterList& list, const std::vector<Point<dim>>& nodes,
                                 const std::string& where) {
  Box<dim> box(vector_value<dim>(list, "Lower"), vector_value<dim>(list, "Upper"));
  for (int a = 0; a < dim; ++a) {
    check_input(box.min()[a] <= box.max()[a],
                "In \"{}\", \"Lower\" ({}) lies above \"Upper\" ({}) along {}.", where,
                box.min()[a], box.max()[a], axes<dim>()[a]);
  }
  Box<dim> body;
  for (const auto& x : nodes)
    body.extend(x);
  // Nodes on the sides of the box are not lost to round-off.
  const double margin = rounding::differences * body.diagonal().norm();
  box.min().array() -= margin;
  box.max().array() += margin;
  std::vector<int> found;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (box.contains(nodes[n]))
      found.push_back(static_cast<int>(n));
  }
  check_input(!found.empty(),
              "The box of \"{}\" holds no node of the body; its coordinates are those of the body "
              "at rest, before it is turned and placed.",
              where);
  return found;
}

template <int dim>
void declare_loads_and_tethers(ParameterList& body) {
  ParameterList load("load"), tether("tether");
  declare_node_region<dim>(load);
  declare_required_vector<double>(
      load, "Force", dim,
      "Constant force in all, spread over the nodes in proportion to their masses [N] (2D: per "
      "unit depth).");
  declare_named_sublists(body, "Loads", "Forces on nodes, besides gravity.", load);
  declare_node_region<dim>(tether);
  declare_required_positive(tether, "Stiffness",
                            "Stiffness of all springs together, spread over the nodes in "
                            "proportion to their masses [N/m] (2D: per unit depth).");
  declare_vector(tether, "Offset", ParameterArray<double>(dim, 0.0), dim,
                 "Offset of each anchor from the start of its node [m].");
  declare_named_sublists(body, "Tethers",
                         "Nodes tied to fixed points of space by springs without rest length.",
                         tether);
}

template <int dim>
std::vector<Point<dim>> read_loads(const ParameterList& body, const std::vector<Point<dim>>& nodes,
                                   const std::vector<double>& node_measure,
                                   const std::string& name) {
  std::vector<Point<dim>> force(nodes.size(), Point<dim>::Zero());
  const ParameterList& all = body.sublist("Loads");
  for (auto entry = all.begin(); entry != all.end(); ++entry) {
    const ParameterList& list = all.sublist(all.name(entry));
    const auto found = nodes_in_region<dim>(list, nodes, name + "/Loads/" + all.name(entry));
    double measure = 0;
    for (const int n : found)
      measure += node_measure[n];
    for (const int n : found)
      force[n] += node_measure[n] / measure * vector_value<dim>(list, "Force");
  }
  return force;
}

template <int dim>
std::vector<Tether<dim>> read_tethers(const ParameterList& body,
                                      const std::vector<Point<dim>>& nodes,
                                      const std::vector<double>& node_measure,
                                      const std::string& name) {
  std::vector<Tether<dim>> tethers;
  const ParameterList& all = body.sublist("Tethers");
  for (auto entry = all.begin(); entry != all.end(); ++entry) {
    const ParameterList& list = all.sublist(all.name(entry));
    const auto found = nodes_in_region<dim>(list, nodes, name + "/Tethers/" + all.name(entry));
    double measure = 0;
    for (const int n : found)
      measure += node_measure[n];
    for (const int n : found) {
      tethers.push_back({n, vector_value<dim>(list, "Offset"),
                         list.get<double>("Stiffness") * node_measure[n] / measure});
    }
  }
  return tethers;
}

template void declare_node_region<2>(ParameterList&);
template void declare_node_region<3>(ParameterList&);
template std::vector<int> nodes_in_region<2>(const ParameterList&, const std::vector<Point<2>>&,
                                             const std::string&);
template std::vector<int> nodes_in_region<3>(const ParameterList&, const std::vector<Point<3>>&,
                                             const std::string&);
template void declare_loads_and_tethers<2>(ParameterList&);
template void declare_loads_and_tethers<3>(ParameterList&);
template std::vector<Point<2>> read_loads<2>(const ParameterList&, const std::vector<Point<2>>&,
                                             const std::vector<double>&, const std::string&);
template std::vector<Point<3>> read_loads<3>(const ParameterList&, const std::vector<Point<3>>&,
                                             const std::vector<double>&, const std::string&);
template std::vector<Tether<2>> read_tethers<2>(const ParameterList&, const std::vector<Point<2>>&,
                                                const std::vector<double>&, const std::string&);
template std::vector<Tether<3>> read_tethers<3>(const ParameterList&, const std::vector<Point<3>>&,
                                                const std::vector<double>&, const std::string&);

}  // namespace lockstep
