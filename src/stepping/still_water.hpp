#pragma once
#include <functional>
#include <vector>

#include "stepping/scene.hpp"
#include "stepping/step/components.hpp"

namespace lockstep {

/// Motions of all solids from where the scene has them, one after the other: ways of the stack's
/// dofs [m, rad], prescribed solids stay.
using Ways = std::vector<RCP<const Vector>>;

/// The scene of a run without what would stir its water, at its start again and again, with the
/// solids elsewhere. All collective.
template <int dim>
class StillWater {
 public:
  using Build = std::function<Components<dim>(const ParameterList&)>;

  /// `build` must outlive it.
  StillWater(const Build& build, const ParameterList& scene, const SceneOptions& options);

  /// The plug-ins at the start of the scene, their solids moved and at rest.
  Components<dim> with(const Ways& ways) const;
  /// Moves solids further, and lets them rest there.
  void displace(const Vector& way, SolidSystem<dim>& solids) const;
  /// Returns the way on which only joints' own rates and bodies that hang on none are given [rad,
  /// m]: bodies on joints go along, as far as joints that are whole at its end let them.
  RCP<Vector> way_of(const Vector& unknowns, SolidSystem<dim>& solids) const;
  /// Returns accelerations of all dofs from rest [m/s^2, rad/s^2]: those of a step.
  RCP<Vector> acceleration(Components<dim>& components) const;
  /// Returns the way of all dofs over dt from rest by forces at its end, as far as these are
  /// implicit: it goes down in their energy, however long it takes.
  RCP<Vector> way_down(Components<dim>& components, double dt) const;

 private:
  const Build& build_;
  ParameterList scene_;
  SceneOptions options_;
};

}  // namespace lockstep
