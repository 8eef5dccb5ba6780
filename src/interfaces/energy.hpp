#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

// Works that the parts of a step do on the energy, measured only if an observer asks for it. An
// impulse works on the mean of the velocities before and after it, so that the works of all
// impulses of a step add up, to round-off, to the change of the kinetic energy.

/// A side of fluids: the works of what acts on u* one after another, on free faces.
template <int dim>
class EnergyFluid {
 public:
  virtual ~EnergyFluid() = default;
  /// The present u* is that on which the forces of a step begin to act. Local.
  virtual void begin_works() = 0;
  /// Closes one work: all that changed u* since the last call, or since `begin_works`. Local.
  virtual void end_work() = 0;
  /// Returns each work, at the mean of the first u* and the last [J], and clears them. Global,
  /// collective.
  virtual std::vector<double> works() = 0;
};

/// Work of the solids' own forces on their motion over a step [J].
struct SolidWork {
  double elastic = 0;
  double damping = 0;  ///< hardly ever above 0
  double control = 0;  ///< work of springs and dampers of joints
  double loads = 0;    ///< work of gravity and loads
};

/// Budget of the energy of a step [J]: sources, change, sinks. Each term is measured where it
/// arises, none is the remainder of the others; `left` is their imbalance.
struct EnergyBudget {
  // Sources.
  double joints = 0;  ///< work of their control, as joints.csv has it
  double loads = 0;   ///< work of gravity, loads, contact and drops
  // Change of what is stored.
  double kinetic_change = 0;  ///< change for fluid and solids
  double elastic_change = 0;
  // Sinks, friction first.
  double fluid_friction = 0;  ///< by viscosity, from fluid and solids
  double solid_friction = 0;  ///< by the damping of soft solids
  double transport = 0;   ///< kinetic energy of the fluid, by advection and all that goes with it
  double pressure = 0;    ///< where u* has a divergence; less what moving sides give
  double lumping = 0;     ///< where fluid takes the velocity of the solid it is lumped on
  double elasticity = 0;  ///< elastic forces' work is not the change of the elastic energy
  double ties = 0;        ///< joints and attachments hold velocities that they did not let before

  double left() const {
    return joints + loads - kinetic_change - elastic_change - fluid_friction - solid_friction -
           transport - pressure - lumping - elasticity - ties;
  }
  EnergyBudget& operator+=(const EnergyBudget& other);
};

inline EnergyBudget& EnergyBudget::operator+=(const EnergyBudget& other) {
  joints += other.joints;
  loads += other.loads;
  kinetic_change += other.kinetic_change;
  elastic_change += other.elastic_change;
  fluid_friction += other.fluid_friction;
  solid_friction += other.solid_friction;
  transport += other.transport;
  pressure += other.pressure;
  lumping += other.lumping;
  elasticity += other.elasticity;
  ties += other.ties;
  return *this;
}

}  // namespace lockstep
