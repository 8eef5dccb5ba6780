#pragma once
#include <vector>

#include "faces/surface_shares.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

/// Lumping of the fluid of mixed dual cells onto the solids.
enum class Lumping {
  diagonal,       ///< node dofs: row sums of W^T M_F; rigid bodies: their full block (the default)
  consistent,     ///< W^T M_F W (Section 5)
  paper_diagonal  ///< as `diagonal`, but rigid bodies by Eqs. 22-24: loses momentum, for comparison
};

/// W^T M_F W as triplets over the solid map, one an entry. Memory: what it holds. Local.
std::vector<Triplet> consistent_mass_triplets(const CouplingWeights& weights,
                                              const std::vector<double>& masses);

/// dM as triplets over the solid map. Nodes take diagonal masses by weights that are positive:
/// those of the shares without their local rotations. Collective.
template <int dim>
std::vector<Triplet> added_mass_triplets(const std::vector<ControlVolume<dim>>& volumes,
                                         const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                         const SolidSystem<dim>& solids,
                                         const std::vector<double>& masses, Lumping lumping);

/// The rigid bodies' part of dM after Eqs. 22-24 taken literally: dM = T^T diag(M̄, Ī) T - M_S with
/// the lumped mass M̄_i of each axis, the lumped centre X̄, whose component i comes from the faces of
/// axis i alone, and T: (V, omega) -> (V + omega x (X̄ - X), omega) of Section 8. The cross terms
/// that it leaves out make the momentum of fluid and body differ from what is conserved.
/// Collective.
template <int dim>
std::vector<Triplet> paper_diagonal_triplets(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SolidSystem<dim>& solids,
    const std::vector<double>& masses);

}  // namespace lockstep
