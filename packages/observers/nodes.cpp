#include "observers/nodes.hpp"

#include "observers/probes.hpp"

namespace lockstep {

namespace {
/// Half a cell: so far a point that is meant to be on a surface may be off it.
constexpr double farthest = 0.5;
}  // namespace

template <int dim>
ParameterList nodes_parameters() {
  ParameterList list = points_parameters<dim>();
  declare_required<std::string>(
      list, "Solid",
      "The solid that they are points of. They may be anywhere in or beside one that is rigid; of "
      "others within half a cell of the surface.");
  return list;
}

template <int dim>
Nodes<dim>::Nodes(const ParameterList& list)
    : points_(observer_path(list), list.get<std::string>("Solid"), listed_points<dim>(list),
              farthest) {}

template <int dim>
std::vector<ObservedColumn> Nodes<dim>::columns() const {
  std::vector<ObservedColumn> columns = {{"point", "1", "its number, from 1"}};
  const auto add = [&](const std::string& prefix, const char* unit, const char* description) {
    for (int a = 0; a < dim; ++a)
      columns.push_back({prefix + axis_names[a], unit, description});
  };
  add("", "m", "where it is");
  add("displacement_", "m", "from where it was");
  add("v", "m/s", "its velocity");
  return columns;
}

template <int dim>
std::vector<std::vector<double>> Nodes<dim>::observe(const RunView<dim>& run) {
  std::vector<std::vector<double>> rows;
  for (const CarriedPoint<dim>& point : points_.look(run)) {
    const Point<dim> displacement = point.position - points_.at_start()[rows.size()];
    std::vector<double> row{static_cast<double>(rows.size() + 1)};
    for (const Point<dim>& vector : {point.position, displacement, point.velocity})
      row.insert(row.end(), vector.data(), vector.data() + dim);
    rows.push_back(std::move(row));
  }
  return rows;
}

template ParameterList nodes_parameters<2>();
template ParameterList nodes_parameters<3>();
template class Nodes<2>;
template class Nodes<3>;

}  // namespace lockstep
