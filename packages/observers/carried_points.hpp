#pragma once
#include <string>
#include <vector>

#include "observers/observed_solid.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Name of an observer with this list, for messages: "Observers/NAME".
std::string observer_path(const ParameterList& list);

/// A point that moves with a solid: its place [m] and its velocity [m/s].
template <int dim>
struct CarriedPoint {
  Point<dim> position = Point<dim>::Zero();  ///< [m]
  Point<dim> velocity = Point<dim>::Zero();  ///< [m/s]
};

/// Points that a solid carries from where they are at the first look: with all of a rigid solid,
/// with the nearest piece of the surface of another.
template <int dim>
class CarriedPoints {
 public:
  /// `observer`: for messages. `farthest`: how far from the surface of a solid that is not rigid
  /// they may be, in units of the fluid's h.
  CarriedPoints(std::string observer, std::string solid, std::vector<Point<dim>> at_start,
                double farthest);

  /// The points now. Throws InputError if there is no such solid, or it is too far away.
  /// Collective.
  std::vector<CarriedPoint<dim>> look(const RunView<dim>& run);
  const std::vector<Point<dim>>& at_start() const { return at_start_; }
  void save(CheckpointWriter& writer) const;
  void load(const CheckpointReader& reader);

 private:
  /// Place on the solid: `offset` in axes that turn with it, from its reference point (rigid) or
  /// from a point of a simplex of its surface.
  struct Hold {
    int simplex = -1;  ///< -1: rigid
    Barycentric<dim> barycentric = Barycentric<dim>::Zero();
    Point<dim> offset = Point<dim>::Zero();
  };
  ObservedSolid<dim> find_carrier(const RunView<dim>& run) const;
  void attach(const RunView<dim>& run, const ObservedSolid<dim>& carrier);
  CarriedPoint<dim> of_rigid(const ObservedSolid<dim>& carrier, const Hold& hold) const;
  CarriedPoint<dim> of_surface(const ObservedSolid<dim>& carrier, const Hold& hold) const;

  std::string observer_, solid_;
  std::vector<Point<dim>> at_start_;
  double farthest_;
  std::vector<Hold> holds_;  ///< empty: not attached yet
};

}  // namespace lockstep
