#pragma once
#include <memory>

#include "interfaces/coupling_sides.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/viscosity.hpp"
#include "mixedface/lumping.hpp"
#include "mixedface/weights.hpp"

namespace lockstep {

/// Which control volumes the coupling takes (design: it decides the accuracy).
enum class MixedRule {
  voxel,  ///< the segment between the two cell centres is blocked, or one centre alone is inside
  every_cut_cell  ///< any dual cell that the surface cuts
};

struct MixedFaceOptions {
  MixedRule rule = MixedRule::voxel;
  Lumping lumping = Lumping::diagonal;
  bool carry_rotations = false;  ///< W of soft solids reproduces rigid motions (LocalRotation)
  bool whole_cell_mass = false;  ///< lump rho V instead of the fluid part
  bool balance = true;           ///< balanced masses (see balance_masses)
};

/// The coupling of the paper: every mixed dual cell moves with the solid, W V_S, and its fluid is
/// lumped on the solid (Eqs. 12, 13, 15).
template <int dim>
class MixedFaceCoupling : public Coupling<dim>,
                          public AuditedCoupling<dim>,
                          public UnseenBuoyancy<dim>,
                          public ViscousCoupling<dim>,
                          public SolidFluxes<dim> {
 public:
  explicit MixedFaceCoupling(const MixedFaceOptions& options) : options_(options) {}

  std::string name() const override { return "mixed face"; }
  double open_fraction(const ControlVolume<dim>& volume, bool blocked,
                       const SurfaceSnapshot<dim>& surface) const override;

  void assemble(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                const SurfaceSnapshot<dim>& surface) override;
  RCP<const CrsMatrix> coupling_transposed() const override { return coupling_transposed_; }
  RCP<const CrsMatrix> added_mass() const override { return added_mass_; }

  void add_prescribed_divergence(Vector& rhs) const override;
  std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const override;
  void add_lumped_momentum(const std::vector<double>& coupled_velocity, Vector& rhs) const override;
  std::vector<double> velocity(const Vector& solid_velocity) const override;
  std::vector<double> effective_velocity(const SolidSystem<dim>& solids) const override;
  void add_divergence(const std::vector<double>& coupled_velocity, Vector& rhs) const override;

  const std::vector<double>& fluid_mass() const override { return masses_; }
  std::vector<Momentum<dim>> prescribed_impulses(const std::vector<double>& velocity_before,
                                                 const std::vector<double>& velocity_after,
                                                 const Vector& scaled_pressure) const override;
  AngularVector<dim> lever_impulse(const SolidSystem<dim>& solids,
                                   const std::vector<double>& velocity_before,
                                   const std::vector<double>& velocity_after,
                                   const BlockVector& solution) const override;
  std::vector<Momentum<dim>> add_unseen_buoyancy(const Point<dim>& gravity, double dt,
                                                 Vector& rhs) const override;
  void link_row(const ViscousLink<dim>& link, const SolidSystem<dim>& solids,
                LinkRow<dim>& row) const override;

 private:
  /// Adds the rows of the shares, taken at x along one axis.
  void share_row(const std::vector<SurfaceShare<dim>>& shares, const Point<dim>& x, int direction,
                 const SolidSystem<dim>& solids, LinkRow<dim>& row) const;
  /// p̂ above minus below each coupled volume; 0 where there is no unknown.
  std::vector<double> pressure_jumps(const Vector& scaled_pressure) const;
  /// Diagonal masses need positive rows: W without rotations. Then momentum goes by those as well,
  /// from the mixed faces to the nodes and back; volume and pressure go by W.
  bool masses_are_plain() const {
    return options_.carry_rotations && options_.lumping != Lumping::consistent;
  }
  const CouplingWeights& mass_weights() const {
    return masses_are_plain() ? plain_weights_ : weights_;
  }
  void find_prescribed(const SolidSystem<dim>& solids);
  void assemble_weights(const SolidSystem<dim>& solids);
  void assemble_blocks(const SolidSystem<dim>& solids);
  void assemble_unseen(const SolidSystem<dim>& solids, const SurfaceSnapshot<dim>& surface);

  MixedFaceOptions options_;
  const SurfaceSnapshot<dim>* surface_ =
      nullptr;  ///< of the last `assemble`; the caller keeps it alive
  std::vector<ControlVolume<dim>> volumes_;
  std::vector<std::vector<SurfaceShare<dim>>> shares_;
  CouplingWeights weights_;
  CouplingWeights plain_weights_;  ///< without rotations, if `masses_are_plain`; the same columns
  std::vector<double> masses_;     ///< M_F
  std::vector<double> prescribed_share_;
  std::vector<double> prescribed_velocity_;  ///< W_k V_k
  RCP<const CrsMatrix> coupling_transposed_, added_mass_;
  RCP<Import> solid_import_;     ///< solid map -> this rank's `weights_.dofs`
  RCP<Import> pressure_import_;  ///< pressure map -> unknowns beside this rank's coupled volumes
  std::vector<UnseenMass<dim>> unseen_;
  std::vector<VelocityRow<dim>> unseen_rows_;  ///< per unseen solid and axis
};

}  // namespace lockstep
