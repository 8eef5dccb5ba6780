#pragma once
#include <vector>

#include "cutcell/displaced_volume.hpp"
#include "cutcell/flux_shares.hpp"
#include "interfaces/coupling_sides.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/viscosity.hpp"
#include "mixedface/weights.hpp"

namespace lockstep {

struct FluxOptions {
  /// Faces less open than this are closed: their flux then belongs to the solid in both
  /// neighbours, so that nothing is lost, and every pressure has a face of at least this size.
  double smallest_open_fraction = 1e-4;
  bool correct_buoyancy = true;  ///< see displaced_excess
  FaceWeights weights = FaceWeights::areas;
};

/// Coupling by the flux of the surface through cut cells (face fractions of Ng, Min and Gibou
/// 2009): faces keep the open part of their area and of their fluid's mass, the closed part moves
/// with the solid. B_cj is what dof j pushes out of cell c. Closed solids lump no fluid, so that
/// C = M_S - dt D; only the normal velocity is tied. Thin shells, and parts of closed solids
/// thinner than a cell, close their faces and lump the fluid as mixed faces do.
template <int dim>
class FluxCoupling : public Coupling<dim>,
                     public AuditedCoupling<dim>,
                     public UnseenBuoyancy<dim>,
                     public ViscousCoupling<dim>,
                     public SolidFluxes<dim> {
 public:
  explicit FluxCoupling(const FluxOptions& options) : options_(options) {}

  std::string name() const override { return "flux"; }
  double open_fraction(const ControlVolume<dim>& volume, bool blocked,
                       const SurfaceSnapshot<dim>& surface) const override;
  bool cuts_cells() const override { return true; }
  Point<dim> open_center(const ControlVolume<dim>& volume,
                         const SurfaceSnapshot<dim>& surface) const override;

  void assemble(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                const SurfaceSnapshot<dim>& surface) override;
  RCP<const CrsMatrix> coupling_transposed() const override { return coupling_transposed_; }
  /// Of thin parts only; null without any.
  RCP<const CrsMatrix> added_mass() const override { return added_mass_; }

  void add_prescribed_divergence(Vector& rhs) const override;
  std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const override;
  void add_lumped_momentum(const std::vector<double>& coupled_velocity, Vector& rhs) const override;
  std::vector<double> velocity(const Vector& solid_velocity) const override;
  std::vector<double> effective_velocity(const SolidSystem<dim>& solids) const override;
  void add_divergence(const std::vector<double>& coupled_velocity, Vector& rhs) const override;

  /// Zero but at thin parts.
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
  /// Closed area of a face as the lower or upper pressure sees it [m^(dim-1)].
  double push(std::size_t face, int side) const {
    const double area = (1 - volumes_[face].open_fraction) * volumes_[face].area;
    return side == 0 ? -area : area;
  }
  /// What p̂ pushes on the closed part of each face, along its axis [kg m/s].
  std::vector<double> pushes(const Vector& scaled_pressure) const;
  void find_prescribed_velocity(const SolidSystem<dim>& solids);
  void weigh_excess(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids);
  void assemble_blocks(const SolidSystem<dim>& solids);
  void add_thin_impulses(std::size_t f, double velocity_before,
                         std::vector<Momentum<dim>>& impulses) const;
  void add_to_row(const std::vector<FluxShare<dim>>& shares, int direction,
                  const SolidSystem<dim>& solids, LinkRow<dim>& row) const;

  FluxOptions options_;
  const SurfaceSnapshot<dim>* surface_ = nullptr;  ///< of the last `assemble`
  std::vector<ControlVolume<dim>> volumes_;
  std::vector<FaceShares<dim>> shares_;
  CouplingWeights weights_;       ///< of all shares
  CouplingWeights thin_weights_;  ///< of thin parts
  std::vector<double> masses_;
  std::vector<double> prescribed_velocity_;       ///< of all prescribed shares, by weight
  std::vector<double> prescribed_thin_velocity_;  ///< of the prescribed ones of thin parts
  RCP<const CrsMatrix> coupling_transposed_, added_mass_;
  RCP<Import> solid_import_;       ///< solid map -> `weights_.dofs`
  RCP<Import> thin_solid_import_;  ///< solid map -> `thin_weights_.dofs`
  RCP<Import> pressure_import_;    ///< pressure map -> unknowns beside this rank's volumes
  std::vector<AxisForce> excess_;  ///< on dynamic solids
  std::vector<DisplacedExcess<dim>> held_excess_;  ///< on prescribed ones
};

}  // namespace lockstep
