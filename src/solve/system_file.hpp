#pragma once
#include <string>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// A system with its right-hand side, as read from a file.
struct StoredSystem {
  BlockSystem system;
  BlockVector rhs;
};

/// Writes A, B^T, C, the null spaces and the right-hand side to an HDF5 file that any number of
/// ranks can read: entries (row, column, value) with global numbers, where A is a stencil its
/// lattice and coefficients, and of soft solids their nodes. Throws InputError if A or C is not
/// assembled, OutputError if the file cannot be written. Collective.
void write_system(const std::string& path, const BlockSystem& system, const BlockVector& rhs);

/// Reads it, rows spread evenly over the ranks, those of A by blocks of the lattice if there is
/// one: A is then a stencil, as in a run. Without soft solids, where there are fewer solid unknowns
/// than ranks, unknowns that no other sees are added, so that every rank owns one. Throws
/// InputError for files that cannot be read, are of another kind, damaged, or hold anything but a
/// complete system of finite numbers. Collective.
StoredSystem read_system(const std::string& path, const Communicator& comm);

}  // namespace lockstep
