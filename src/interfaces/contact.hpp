#pragma once
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "linear/types.hpp"

namespace lockstep {

template <int dim>
class SolidSystem;

/// What one contact resolution did.
template <int dim>
struct ContactReport {
  int n_contacts = 0;
  int iterations = 0;
  int n_crossings = 0;             ///< of surfaces that are not rigid, which could not be prevented
  double deepest_overlap = 0;      ///< before resolution [m]
  Momentum<dim> external_impulse;  ///< from walls and prescribed solids on the dynamic ones, global
};

/// In which part of the step contacts are resolved.
enum class ContactPhase {
  position,  ///< S1: V^{n+1/2} moves the positions; existing overlap is pushed out
  velocity   ///< S2: V_S* before the coupled solve; only approach is stopped
};

/// Collisions, resting contact and friction across all solids and with the walls of the domain.
template <int dim>
class ContactModel : public PlugIn {
 public:
  /// Changes the stacked generalized velocities by contact impulses (equal and opposite between
  /// dynamic solids, through the solids' own mass M_S) so that moving by dt from the present
  /// positions leaves no overlap. Collective.
  virtual ContactReport<dim> resolve(const SolidSystem<dim>& solids, ContactPhase phase, double dt,
                                     Vector& velocity) = 0;
};

}  // namespace lockstep
