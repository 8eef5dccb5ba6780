#pragma once
#include <utility>
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// (P^T M_S P)^-1 on the unknowns, replicated: rows of small blocks. Where the blocks of M_S are
/// larger than those of rigid bodies, alone or tied together by joints (consistent mass matrices),
/// lumped masses of nodes, the sums of its rows, replace them.
struct InverseMass {
  bool exact = true;
  std::vector<std::vector<std::pair<int, double>>> rows;  ///< by id, without padding
};

/// Throws SolveError if M_S is not positive definite. Collective.
template <int dim>
InverseMass replicated_inverse_mass(const SolidSystem<dim>& system);

/// Rows, as above, of another inverse on the unknowns than that of M_S. Collective.
template <int dim>
InverseMass replicated_inverse(const SolidSystem<dim>& system, const CrsMatrix& inverse);

/// A stacked vector on every rank, by id, without padding; all unknowns are held, so solids of many
/// dofs cost memory here. Collective.
template <int dim>
std::vector<double> replicated(const SolidSystem<dim>& system, const Vector& stacked);

/// This rank's part of a replicated vector. Collective.
template <int dim>
RCP<Vector> distributed(const SolidSystem<dim>& system, const std::vector<double>& values);

}  // namespace lockstep
