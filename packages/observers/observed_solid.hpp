#pragma once
#include <string>

#include "interfaces/observer.hpp"

namespace lockstep {

/// A solid that an observer names, and the model it belongs to.
template <int dim>
struct ObservedSolid {
  const SolidModel<dim>* model = nullptr;
  const SolidDescription* solid = nullptr;
  int number = -1;        ///< in the model
  int index = -1;         ///< in `RunView::solids`
  int simplex_begin = 0;  ///< its first simplex in the surfaces of all models, one after the other
};

/// Returns the solid of this name. Throws InputError, naming the observer, if there is none. Local.
template <int dim>
ObservedSolid<dim> observed_solid(const RunView<dim>& run, const std::string& name,
                                  const std::string& observer);

}  // namespace lockstep
