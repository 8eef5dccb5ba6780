#pragma once
#include <cstdint>
#include <string>

#include "base/communicator.hpp"

/// A file whose last line holds the CRC-32 and the number of the bytes before it, so that damage of
/// any byte shows before another library reads the file. HDF5 does not look behind its own end.
namespace lockstep {

enum class ChecksumState {
  intact,
  broken,  ///< the file differs from what was written
  absent   ///< there is no such line at its end
};

/// Appends the line to the file, of which every rank reads a part. Throws OutputError. Collective.
void append_checksum(const Communicator& comm, const std::string& path);

/// Compares. Throws OutputError if the file cannot be read. Collective.
ChecksumState check_checksum(const Communicator& comm, const std::string& path);

/// CRC-32 of some text.
std::uint32_t checksum_of(const std::string& text);

}  // namespace lockstep
