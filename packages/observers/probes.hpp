#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/fluid_sides.hpp"
#include "observers/carried_points.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Returns the fluid's sampler. Throws InputError, naming `observer`, if the fluid has none.
template <int dim>
const FluidOutput<dim>& output_of(const FluidDiscretization<dim>& fluid,
                                  const std::string& observer);

/// Evenly spaced points of the box between two corners [m], `count` along each axis, ends included;
/// one alone lies in the middle. x runs fastest.
template <int dim>
std::vector<Point<dim>> lattice_points(const Box<dim>& box, const Index<dim>& count);

/// Schemas of the observers "points" and "box", and the points [m] they ask for.
template <int dim>
ParameterList points_parameters();
template <int dim>
std::vector<Point<dim>> listed_points(const ParameterList& list);
template <int dim>
ParameterList box_parameters();
template <int dim>
std::vector<Point<dim>> box_points(const ParameterList& list);

/// Declares the "Solid" that points may move with.
void declare_carrier(ParameterList& list);

/// Pressure and velocity at points that stay or move with a solid, a row a point.
template <int dim>
class Probes : public Observer<dim> {
 public:
  Probes(std::string name, std::vector<Point<dim>> points)
      : name_(std::move(name)), points_(std::move(points)) {}
  /// Points that move with the "Solid" of the list, if it has one.
  Probes(std::string name, std::vector<Point<dim>> points, const ParameterList& list);
  std::string name() const override { return name_; }
  std::vector<ObservedColumn> columns() const override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

 private:
  std::string name_;
  std::vector<Point<dim>> points_;
  std::optional<CarriedPoints<dim>> carried_;  ///< points of a solid; none: they stay
};

}  // namespace lockstep
