#pragma once
#include <vector>

#include "faces/added_mass.hpp"
#include "faces/face_coupling.hpp"
#include "mixedface/lumping.hpp"

namespace lockstep {

/// Rule by which the coupling takes control volumes (docs/method.md: it decides the accuracy).
enum class MixedRule {
  voxel,  ///< the segment between the two cell centres is occluded, or one centre alone is inside
  every_cut_cell  ///< any dual cell that the surface cuts
};

/// Velocity that a mixed face takes from the simplices of soft solids in its dual cell (W).
enum class SoftWeights {
  barycentric,   ///< the velocity at the centroid of each clipped part
  area,          ///< the mean of its nodes, whichever part is clipped (Section 5)
  rigid_motions  ///< carried to the centre of the face by LocalRotation
};

struct MixedFaceOptions {
  MixedRule rule = MixedRule::voxel;
  Lumping lumping = Lumping::diagonal;
  SoftWeights soft_weights = SoftWeights::barycentric;
  bool whole_cell_mass = false;  ///< lump rho V instead of the fluid part
  bool correct_buoyancy = true;  ///< see HydrostaticLoads
};

/// The coupling of the paper: every mixed dual cell moves with the solid, W V_S, and its fluid is
/// lumped on the solid (Eqs. 12, 13, 15).
template <int dim>
class MixedFaceCoupling : public FaceCoupling<dim> {
 public:
  explicit MixedFaceCoupling(const MixedFaceOptions& options) : options_(options) {}

  std::string name() const override { return "mixed face"; }
  double open_fraction(const ControlVolume<dim>& volume, bool occluded,
                       const SurfaceSnapshot<dim>& surface) const override;

  void assemble(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                const SurfaceSnapshot<dim>& surface) override;

  std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const override;
  void add_lumped_momentum(const std::vector<double>& coupled_velocity, Vector& rhs) const override;
  std::vector<double> velocity(const Vector& solid_velocity) const override;
  std::vector<double> effective_velocity(const SolidSystem<dim>& solids) const override;

  std::vector<Momentum<dim>> prescribed_impulses(
      const std::vector<double>& velocity_before, const std::vector<double>& velocity_after,
      const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const override;
  std::vector<SurfaceImpulse<dim>> impulses_on_solids(
      const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
      const BlockVector& solution, const std::vector<double>& gas_pressure) const override;
  AngularVector<dim> lumping_torque_error(const SolidSystem<dim>& solids,
                                          const std::vector<double>& velocity_before,
                                          const std::vector<double>& velocity_after,
                                          const BlockVector& solution,
                                          const std::vector<double>& gas_pressure) const override;
  void link_row(const ViscousCouplingTerm<dim>& link, const SolidSystem<dim>& solids,
                EndVelocity<dim>& row) const override;

 private:
  double closed_area(const ControlVolume<dim>& volume) const override { return volume.area; }
  /// The shares of these volumes, for soft solids as the option `soft_weights` says.
  std::vector<std::vector<SurfaceShare<dim>>> shares_of(
      const std::vector<ControlVolume<dim>>& volumes, const SurfaceSnapshot<dim>& surface) const;
  /// Adds the rows of the shares, taken at x along one axis.
  void share_row(const std::vector<SurfaceShare<dim>>& shares, const Point<dim>& x, int direction,
                 const SolidSystem<dim>& solids, EndVelocity<dim>& row) const;
  /// Diagonal masses need positive rows: W without rotations. Then momentum goes by those as well,
  /// from the mixed faces to the nodes and back; volume and pressure go by W.
  bool masses_without_rotations() const {
    return options_.soft_weights == SoftWeights::rigid_motions &&
           options_.lumping != Lumping::consistent;
  }
  const CouplingWeights& mass_weights() const {
    return masses_without_rotations() ? weights_without_rotations_ : weights_;
  }
  void add_rest(HydrostaticLoads<dim>& loads) const;
  void find_prescribed(const SolidSystem<dim>& solids);
  double impulse_of_prescribed(std::size_t face, double before, double after, double push) const;
  void assemble_weights(const SolidSystem<dim>& solids);

  using FaceCoupling<dim>::added_mass_;
  using FaceCoupling<dim>::coupling_transposed_;
  using FaceCoupling<dim>::masses_;
  using FaceCoupling<dim>::patches_;
  using FaceCoupling<dim>::prescribed_velocity_;
  using FaceCoupling<dim>::pressure_import_;
  using FaceCoupling<dim>::solid_import_;
  using FaceCoupling<dim>::surface_;
  using FaceCoupling<dim>::volumes_;
  using FaceCoupling<dim>::weights_;

  MixedFaceOptions options_;
  std::vector<std::vector<SurfaceShare<dim>>> shares_;
  CouplingWeights weights_without_rotations_;  ///< without rotations, if
                                               ///< `masses_without_rotations`; the same columns
  std::vector<double> prescribed_share_;
};

}  // namespace lockstep
