#pragma once
#include <vector>

#include "linear/triplet_matrix.hpp"
#include "mixedface/weights.hpp"

namespace lockstep {

/// How the fluid of mixed dual cells is lumped onto the solids.
enum class Lumping {
  diagonal,       ///< node dofs: row sums of W^T M_F; rigid bodies: their full block (the default)
  consistent,     ///< W^T M_F W (Section 5)
  paper_diagonal  ///< as `diagonal`, but rigid bodies by Eqs. 22-24: loses momentum, for comparison
};

/// M_F [kg] of each coupled control volume: density times the dual cell minus the solids in it,
/// never negative; with `whole_cell` density times the dual cell.
template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell);

/// What the balanced lumping could not repair of one solid, per axis a: the grid displaces too much
/// or too little fluid by `mass` [kg], with first moments `moment` [kg m] about `center`.
template <int dim>
struct UnseenMass {
  int solid = -1;
  Point<dim> center = Point<dim>::Zero();
  Point<dim> mass = Point<dim>::Zero();  ///< entry a: lumped minus wanted mass, axis a
  Eigen::Matrix<double, dim, dim> moment = Eigen::Matrix<double, dim, dim>::Zero();  ///< (a, b)
};

/// Corrects the masses of the mixed faces of every closed solid, axis by axis, by factors linear in
/// the transverse position, so that lumped fluid + solid displace exactly what the discrete
/// pressure lifts: sum m_f = rho (V_disc - V_solid), and its first moments across the axis. Then a
/// neutrally buoyant body rests (A1) and drifts (A9) exactly. V_solid is that of the part in
/// `domain`, where the fluid can be. Returns the solids where a mass would have turned negative or
/// that the grid does not see; their masses are left alone. Collective.
template <int dim>
std::vector<UnseenMass<dim>> balance_masses(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SurfaceSnapshot<dim>& surface,
    double density, const Box<dim>& domain, const Communicator& comm, std::vector<double>& masses);

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
