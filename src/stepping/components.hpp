#pragma once
#include <memory>

#include "coupling/solid_system.hpp"
#include "interfaces/contact.hpp"
#include "interfaces/coupling.hpp"
#include "interfaces/fluid.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

/// The plug-ins of a scene.
template <int dim>
struct Components {
  std::unique_ptr<FluidDiscretization<dim>> fluid;
  std::unique_ptr<SolidSystem<dim>> solids;
  std::unique_ptr<Coupling<dim>> coupling;
  std::unique_ptr<SolverStrategy> strategy;
  std::unique_ptr<ContactModel<dim>> contact;  ///< null: solids do not touch
};

}  // namespace lockstep
