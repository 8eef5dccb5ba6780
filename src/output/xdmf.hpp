#pragma once
#include <string>

#include "output/frames.hpp"

/// XDMF 3 descriptions of what FrameWriter stores.
namespace lockstep::xdmf {

/// The name under which something called `name` is stored: letters, digits, '_', '-' and '.' stay,
/// the rest becomes '_'.
std::string stored_name(const std::string& name);

/// One `Grid` element; `file` is the HDF5 file relative to the XDMF file. Empty for an empty
/// surface.
std::string box_grid(const BoxFrame& box, const std::string& file, Precision precision);
std::string surface_grid(const SurfaceFrame& surface, const std::string& file, Precision precision);
/// The spatial collection of one time [s], and the document around all of them.
std::string frame(double time, const std::string& grids);
std::string document(const std::string& frames);

}  // namespace lockstep::xdmf
