#pragma once
#include <optional>

#include "linear/stencil_operator.hpp"

namespace lockstep {

class Hdf5File;

/// Writes the lattice that a pressure block lives on, with its coefficients, as the group
/// "/lattice": the cell of each unknown, its faces' coefficients, and the size, periodicity and
/// block width of the lattice. Collective.
void write_lattice(Hdf5File& file, const FaceCoefficients& stencil);

/// The coefficients of the group "/lattice" of a file of `n` unknowns, on a map of their own:
/// blocks are dealt out evenly, in lexicographic order, and each rank owns the unknowns of its
/// blocks, cell by cell. None if the file has no such group, or one without coefficients. Throws
/// InputError for a damaged one. Every rank reads all of the group. Collective.
std::optional<FaceCoefficients> read_lattice(const Hdf5File& file, GlobalIndex n);

/// A pressure block that is applied as this matrix, and shows its coefficients to whoever asks.
RCP<const StencilOperator> stored_stencil(const RCP<const CrsMatrix>& matrix,
                                          const FaceCoefficients& coefficients);

}  // namespace lockstep
