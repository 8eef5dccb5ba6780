#pragma once
#include <vector>

#include "cutcell/surface_flows.hpp"
#include "faces/face_coupling.hpp"

namespace lockstep {

/// Coupling by the flux of the surface through cut cells (face fractions of Ng, Min and Gibou
/// 2009): faces keep the open part of their area and of their fluid's mass, the closed part moves
/// with the solid. B_cj is what dof j pushes into cell c: int_(surface in c) N_j n dA, of rigid
/// bodies by the closed faces of the cell, which is the same, of soft ones by the surface. Closed
/// solids lump no fluid, so that C = M_S - dt D; only the normal velocity is tied. Thin shells, and
/// walls thinner than a cell, close faces and lump the fluid as mixed faces do.
template <int dim>
class FluxCoupling : public FaceCoupling<dim> {
 public:
  explicit FluxCoupling(const FluxOptions& options) : options_(options) {}

  std::string name() const override { return "flux"; }
  double open_fraction(const ControlVolume<dim>& volume, bool parted,
                       const SurfaceSnapshot<dim>& surface) const override;
  bool cuts_cells() const override { return true; }
  Point<dim> open_center(const ControlVolume<dim>& volume,
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
  double closed_area(const ControlVolume<dim>& volume) const override {
    return (1 - volume.open_fraction) * volume.area;
  }
  void find_masses(const LiquidFluid<dim>* liquid);
  void find_prescribed_velocity(const SolidSystem<dim>& solids);
  std::vector<double> effective_rows(const SolidSystem<dim>& solids) const override;
  /// True if the face moves otherwise than its row of W says: with its thin parts alone, or
  /// with soft bodies, whose surface pushes elsewhere.
  bool moves_otherwise(std::size_t f) const;
  void add_rest(HydrostaticLoads<dim>& loads) const;
  void assemble_blocks(const SolidSystem<dim>& solids);
  void add_share(const FluxShare<dim>& share, int direction, const SolidSystem<dim>& solids,
                 RowEntries& row) const;
  void add_flow(const SurfaceFlow<dim>& flow, const SolidSystem<dim>& solids,
                RowEntries& row) const;
  /// Calls `add(share, impulse)` for prescribed thin parts, with their impulse on the fluid.
  template <typename Add>
  void prescribed_thin_impulses(std::size_t f, double velocity_before, const Add& add) const;
  void add_to_row(const std::vector<FluxShare<dim>>& shares, int direction,
                  const SolidSystem<dim>& solids, EndVelocity<dim>& row) const;

  using FaceCoupling<dim>::added_mass_;
  using FaceCoupling<dim>::coupling_transposed_;
  using FaceCoupling<dim>::masses_;
  using FaceCoupling<dim>::prescribed_velocity_;
  using FaceCoupling<dim>::pressure_import_;
  using FaceCoupling<dim>::solid_import_;
  using FaceCoupling<dim>::surface_;
  using FaceCoupling<dim>::volumes_;
  using FaceCoupling<dim>::weights_;

  FluxOptions options_;
  std::vector<FaceShares<dim>> shares_;
  std::vector<SurfaceFlow<dim>> flows_;  ///< their rows of W are behind those of the faces
  CouplingWeights face_weights_;         ///< weights of the velocity of faces that move otherwise
  std::vector<double> prescribed_thin_velocity_;  ///< velocity of prescribed thin parts
  RCP<Import> face_solid_import_;                 ///< solid map -> `face_weights_.dofs`
};

}  // namespace lockstep
