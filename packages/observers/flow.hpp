#pragma once
#include <string>

#include "interfaces/observer.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "flow".
template <int dim>
ParameterList flow_parameters();

/// A line in the plane, a parallelogram in space.
template <int dim>
struct Window {
  Point<dim> corner = Point<dim>::Zero();
  std::array<Point<dim>, dim - 1> edges{};  ///< from the corner [m]

  /// Vector at right angles to it, as long as it is large: to the right of a line, along the cross
  /// product of the two edges.
  Point<dim> area_vector() const;
};

/// Volume that flows through a window, by the midpoint rule over pieces of at most the fluid's h;
/// what solids cover lets nothing through, a face that they cover in part the open part, and of a
/// piece that the surface of a liquid crosses the wet part counts, unless there is a gas above.
template <int dim>
class Flow : public Observer<dim> {
 public:
  explicit Flow(const ParameterList& list);
  std::string name() const override { return "flow"; }
  std::vector<ObservedColumn> columns() const override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;

 private:
  /// Takes a window along two corners of a box that is flat along one axis.
  void read_box(const ParameterList& list);
  /// The window in the fluid. Throws InputError if it is not there.
  Window<dim> part_in(const FluidDiscretization<dim>& fluid) const;
  Window<dim> part_of_box(const Box<dim>& bounds) const;
  void check_inside(const Box<dim>& bounds) const;

  std::string path_;  ///< for messages
  Window<dim> window_;
  int axis_ = -1;  ///< axis of the flow through a box; -1: the window is given by points
};

}  // namespace lockstep
