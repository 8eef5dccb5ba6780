#pragma once
#include <Eigen/Core>

#include "programs/headers_digest.hpp"

namespace lockstep {

/// A library of plug-ins and the program that loads it exchange objects, so both must have been
/// compiled from the same headers by compilers that lay objects out alike. The order of these
/// members never changes: libraries of other versions have them, too.
struct PlugInBuild {
  const char* headers;   ///< version of Lockstep, with a checksum of all of its headers
  const char* compiler;  ///< its version
  int alignment;         ///< alignment of Eigen's vectors [bytes]; depends on the processor
};

/// The one that includes this. In each file of its own: a program must not see its own in the place
/// of a library's.
constexpr PlugInBuild this_build{headers_digest, __VERSION__, EIGEN_MAX_ALIGN_BYTES};

}  // namespace lockstep

/// The build of a library of plug-ins; `lockstep_add_plug_in` compiles it into each.
extern "C" const lockstep::PlugInBuild lockstep_plug_in_build;
