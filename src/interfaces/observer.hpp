#pragma once
#include <string>
#include <vector>

#include "interfaces/energy.hpp"
#include "interfaces/fluid.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/surface_forces.hpp"

namespace lockstep {

/// State of the run that an observer may look at after a step; valid during the call only.
template <int dim>
struct RunView {
  double time = 0, dt = 0;  ///< [s]; the end of the step, and its length (0 at the start of a run)
  const FluidDiscretization<dim>& fluid;
  const std::vector<SolidState<dim>>& solids;  ///< in the order of bodies.csv
  const EnergyBudget* energy =
      nullptr;  ///< budget of the step; null: there was none, or no observer wants it
  std::vector<const SolidModel<dim>*> models = {};  ///< models of the solids, one after the other
  const SurfaceForces<dim>* forces =
      nullptr;  ///< forces of the step; null: there was none, or no observer wants them
};

/// A column of an observer's table.
struct ObservedColumn {
  std::string name;
  std::string unit;  ///< "1" if it has none
  std::string description;
};

/// Sees the run at its start and after every step and makes rows of a table of its own,
/// OUTPUT/NAME.csv, behind the columns `step` and `time`. It changes nothing. State that must
/// survive a restart goes through `save` and `load`.
template <int dim>
class Observer : public PlugIn {
 public:
  virtual std::vector<ObservedColumn> columns() const = 0;
  /// Returns any number of rows, each as long as `columns`; those of rank 0 count. Throws
  /// InputError, at the start of the run, if the fluid cannot answer. A run that is continued after
  /// its end forgets the look there unless it was due: what adds up must do so in `follow`.
  /// Collective.
  virtual std::vector<std::vector<double>> observe(const RunView<dim>& run) = 0;
  /// After every step, before `observe` if that is due: for what adds up. Collective.
  virtual void follow(const RunView<dim>&) {}
  /// True if runs are to keep `RunView::energy`, which costs some percent of a step. Local.
  virtual bool wants_energy() const { return false; }
  /// True if runs are to keep `RunView::forces`. Local.
  virtual bool wants_forces() const { return false; }
};

}  // namespace lockstep
