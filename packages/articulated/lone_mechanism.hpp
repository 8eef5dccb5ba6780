#pragma once
#include <vector>

#include "articulated/mechanism.hpp"

namespace lockstep {

/// A mechanism under numbers of its own, so that work on one of many copies its bodies and joints
/// alone.
template <int dim>
struct LoneMechanism {
  Mechanism mechanism;             ///< in its own numbers
  std::vector<Joint<dim>> joints;  ///< by own number, in the order of `Mechanism::joints`
  /// By own number: those among all. Dynamic ones in the order of `Mechanism::bodies`, then
  /// prescribed ones.
  std::vector<int> bodies;

  /// Returns the values of this mechanism's bodies, from the values of all bodies.
  template <typename Value>
  std::vector<Value> of_bodies(const std::vector<Value>& all) const {
    std::vector<Value> own;
    own.reserve(bodies.size());
    for (const int body : bodies)
      own.push_back(all[body]);
    return own;
  }
};

/// Copies the bodies and joints of a mechanism as they are at present. Local.
template <int dim>
LoneMechanism<dim> alone(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints);

}  // namespace lockstep
