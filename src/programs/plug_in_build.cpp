// Part of every library of plug-ins, and of no program: see lockstep_add_plug_in.
#include "programs/plug_in_build.hpp"

extern "C" const lockstep::PlugInBuild lockstep_plug_in_build = lockstep::this_build;
