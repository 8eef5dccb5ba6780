#include "observers/probes.hpp"

#include <limits>

#include "base/errors.hpp"

namespace lockstep {
namespace {

/// Largest number of points of a probe; more are a frame.
constexpr double most_points = 1e6;

template <int dim>
Point<dim> point(const ParameterList& list, const std::string& name) {
  const auto& values = list.get<ParameterArray<double>>(name);
  Point<dim> result;
  for (int a = 0; a < dim; ++a)
    result[a] = values[a];
  return result;
}

}  // namespace

template <int dim>
const FluidOutput<dim>& output_of(const FluidDiscretization<dim>& fluid,
                                  const std::string& observer) {
  const auto* output = fluid.output();
  check_input(output != nullptr,
              "The fluid \"{}\" cannot be asked at single points, which the observer \"{}\" wants; "
              "leave that observer out.",
              fluid.name(), observer);
  return *output;
}

template <int dim>
std::vector<Point<dim>> lattice_points(const Box<dim>& box, const Index<dim>& count) {
  std::vector<Point<dim>> points{box.center()};
  for (int a = 0; a < dim; ++a) {
    std::vector<Point<dim>> next;
    for (int i = 0; i < count[a]; ++i) {
      for (Point<dim> x : points) {
        if (count[a] > 1)
          x[a] = box.min()[a] + box.sizes()[a] * i / (count[a] - 1);
        next.push_back(x);
      }
    }
    points = std::move(next);
  }
  return points;
}

template <int dim>
ParameterList points_parameters() {
  ParameterList list;
  declare_required<ParameterArray<double>>(list, "Points",
                                           "Points, a component an axis, one after the other [m].");
  return list;
}

template <int dim>
std::vector<Point<dim>> listed_points(const ParameterList& list) {
  const auto& numbers = list.get<ParameterArray<double>>("Points");
  check_input(!numbers.empty() && numbers.size() % dim == 0,
              "In \"{}\", \"Points\" has {} numbers; it takes {} a point.", observer_path(list),
              numbers.size(), dim);
  std::vector<Point<dim>> points(numbers.size() / dim);
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int a = 0; a < dim; ++a)
      points[p][a] = numbers[p * dim + a];
  return points;
}

template <int dim>
ParameterList box_parameters() {
  ParameterList list;
  declare_required_vector<double>(list, "Lower", dim, "One corner [m].");
  declare_required_vector<double>(list, "Upper", dim, "The opposite corner [m].");
  declare_required_vector<int>(
      list, "Count", dim,
      "Points along each axis, corners included; 1: in the middle, so that "
      "a line or a plane of points remains.");
  set_at_least(list, "Count", 1);
  return list;
}

template <int dim>
std::vector<Point<dim>> box_points(const ParameterList& list) {
  const auto& count = list.get<ParameterArray<int>>("Count");
  Index<dim> counts;
  double total = 1;
  for (int a = 0; a < dim; ++a) {
    counts[a] = count[a];
    total *= count[a];
  }
  check_input(total <= most_points, "In \"{}\", \"Count\" asks for {:g} points, more than {:g}.",
              observer_path(list), total, most_points);
  return lattice_points<dim>({point<dim>(list, "Lower"), point<dim>(list, "Upper")}, counts);
}

void declare_carrier(ParameterList& list) {
  declare_optional<std::string>(
      list, "Solid",
      "The solid that the points move with from where they are at the start, as a gauge on a hull: "
      "with all of one that is rigid, else with the nearest piece of its surface. Left out: they "
      "stay.");
}

template <int dim>
Probes<dim>::Probes(std::string name, std::vector<Point<dim>> points, const ParameterList& list)
    : name_(std::move(name)), points_(std::move(points)) {
  if (list.isParameter("Solid"))
    carried_.emplace(observer_path(list), list.get<std::string>("Solid"), points_,
                     std::numeric_limits<double>::infinity());
}

template <int dim>
std::vector<ObservedColumn> Probes<dim>::columns() const {
  std::vector<ObservedColumn> columns = {{"point", "1", "its number, from 1"}};
  for (int a = 0; a < dim; ++a)
    columns.push_back({axis_names[a], "m", "where"});
  columns.push_back({"in_fluid", "1", "1: in a cell with fluid and in no solid; 0: else"});
  columns.push_back({"pressure", "Pa", "0 where there is no fluid"});
  for (int a = 0; a < dim; ++a)
    columns.push_back({std::string("v") + axis_names[a], "m/s", "velocity of the fluid"});
  return columns;
}

template <int dim>
std::vector<std::vector<double>> Probes<dim>::observe(const RunView<dim>& run) {
  if (carried_) {
    points_.clear();
    for (const CarriedPoint<dim>& point : carried_->look(run))
      points_.push_back(point.position);
  }
  const std::vector<FluidSample<dim>> samples = output_of(run.fluid, name_).sample(points_);
  std::vector<std::vector<double>> rows;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    std::vector<double> row{static_cast<double>(p + 1)};
    for (int a = 0; a < dim; ++a)
      row.push_back(points_[p][a]);
    row.push_back(samples[p].in_fluid ? 1 : 0);
    row.push_back(samples[p].pressure);
    for (int a = 0; a < dim; ++a)
      row.push_back(samples[p].velocity[a]);
    rows.push_back(std::move(row));
  }
  return rows;
}

template <int dim>
void Probes<dim>::save(CheckpointWriter& writer) const {
  if (carried_)
    carried_->save(writer);
}

template <int dim>
void Probes<dim>::load(const CheckpointReader& reader) {
  if (carried_)
    carried_->load(reader);
}

template const FluidOutput<2>& output_of(const FluidDiscretization<2>&, const std::string&);
template const FluidOutput<3>& output_of(const FluidDiscretization<3>&, const std::string&);
template std::vector<Point<2>> lattice_points<2>(const Box<2>&, const Index<2>&);
template std::vector<Point<3>> lattice_points<3>(const Box<3>&, const Index<3>&);
template ParameterList points_parameters<2>();
template ParameterList points_parameters<3>();
template std::vector<Point<2>> listed_points<2>(const ParameterList&);
template std::vector<Point<3>> listed_points<3>(const ParameterList&);
template ParameterList box_parameters<2>();
template ParameterList box_parameters<3>();
template std::vector<Point<2>> box_points<2>(const ParameterList&);
template std::vector<Point<3>> box_points<3>(const ParameterList&);
template class Probes<2>;
template class Probes<3>;

}  // namespace lockstep
