#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// All plug-ins that a program offers, to scenes in the plane and in space.
struct PlugIns {
  Registries<2> plane;
  Registries<3> space;

  /// The registries of scenes in `dim` dimensions.
  template <int dim>
  const Registries<dim>& of() const {
    if constexpr (dim == 2)
      return plane;
    else
      return space;
  }
};

}  // namespace lockstep

/// Adds plug-ins to those of a program. A library that is named by `--plug-in`, or by "Plug-ins" in
/// a scene, defines this function; programs call it once, on every rank, before they check a scene.
extern "C" void lockstep_register_plug_ins(lockstep::PlugIns& plug_ins);
