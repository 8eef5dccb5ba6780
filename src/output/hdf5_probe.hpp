#pragma once
#include <string>

namespace lockstep {

/// Reason why HDF5 cannot read all of a file, or "". HDF5 itself crashes on some damaged files, so
/// a child process reads the file first, whatever happens to it. Meant for files without a
/// checksum. Not collective.
std::string refusal_of_hdf5(const std::string& path);

}  // namespace lockstep
