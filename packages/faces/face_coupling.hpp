#pragma once
#include <array>
#include <vector>

#include "faces/hydrostatic_force.hpp"
#include "faces/surface_shares.hpp"
#include "interfaces/coupling.hpp"
#include "interfaces/coupling_sides.hpp"
#include "interfaces/gas.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

/// The flow of a row of W into one pressure: its velocity times an area. Negative: out of it.
struct RowPush {
  int row = 0;
  double area = 0;  ///< [m^(dim-1)]; 1 if it is in the row
  GlobalIndex unknown = no_index;
  int bubble = -1, patch = -1;  ///< see PressureSide

  template <int dim>
  static RowPush into(const PressureSide<dim>& side, int row, double area) {
    return {row, area, side.unknown, side.bubble, side.patch};
  }
  bool has_receiver() const { return unknown != no_index || bubble >= 0 || patch >= 0; }
};

/// A coupling in which the closed part of a face moves with the solids at W V_S + W_k V_k, and
/// pushes fluid out of one cell and into the next: B^T, divergences and pressure forces follow from
/// W and the closed areas, which derived classes define. Rows of W beyond those of the coupled
/// volumes push into one pressure each.
template <int dim>
class FaceCoupling : public Coupling<dim>,
                     public AuditedCoupling<dim>,
                     public GasCoupling<dim>,
                     public ViscousCoupling<dim> {
 public:
  const AuditedCoupling<dim>* audit() const override { return this; }
  const GasCoupling<dim>* gas() const override { return this; }
  const HydrostaticCoupling<dim>* hydrostatics() const override { return &hydrostatics_; }
  const ViscousCoupling<dim>* viscosity() const override { return this; }
  RCP<const CrsMatrix> coupling_transposed() const override { return coupling_transposed_; }
  RCP<const CrsMatrix> added_mass() const override { return added_mass_; }
  const std::vector<double>& fluid_mass() const override { return masses_; }
  void add_prescribed_divergence(Vector& rhs) const override;
  void add_effective_divergence(const SolidSystem<dim>& solids, Vector& rhs) const override;
  void add_gas_push(const std::vector<double>& scaled_pressure, Vector& momentum) const override;
  std::vector<double> gas_push_size(int n_bubbles) const override;
  std::vector<double> gas_rates(const Vector& solid_velocity, bool with_prescribed,
                                int n_bubbles) const override;
  std::vector<double> effective_gas_rates(const SolidSystem<dim>& solids,
                                          int n_bubbles) const override;

 protected:
  /// Starts anew with the fluid's coupled volumes and with pushes of further rows, behind those of
  /// the volumes: no solids, masses, velocities and hydrostatic loads zero. Collective.
  void take_volumes(const FluidDiscretization<dim>& fluid, const SurfaceSnapshot<dim>& surface,
                    const std::vector<RowPush>& further = {});
  /// Area of the part of a face that moves with solids [m^(dim-1)].
  virtual double closed_area(const ControlVolume<dim>& volume) const = 0;
  /// Signed closed area as the lower or upper pressure sees it: outflow counts negative on the
  /// lower cell, positive above, for B = V G_c^T W with G^T = -div.
  double push(std::size_t face, int side) const {
    return side == 0 ? -closed_area_[face] : closed_area_[face];
  }
  /// Returns W V_S + W_k V_k with the effective velocities of all solids, by rows of W [m/s].
  /// Default: those of the coupled volumes. Local.
  virtual std::vector<double> effective_rows(const SolidSystem<dim>& solids) const {
    return this->effective_velocity(solids);
  }
  /// B^T from `weights_`. Collective.
  void assemble_coupling(const SolidSystem<dim>& solids);
  /// Impulse of p̂, and of the bubbles' p̂, on the closed part of each face, along its axis [kg
  /// m/s]. Collective.
  std::vector<double> pushes(const Vector& scaled_pressure,
                             const std::vector<double>& gas_pressure) const;
  /// Impulses as in `pushes`, apart for the pressure on the lower and the upper side of each
  /// coupled volume. Collective.
  std::vector<std::array<double, 2>> pushes_of_sides(const Vector& scaled_pressure,
                                                     const std::vector<double>& gas_pressure) const;
  /// The point of a solid's surface at which an impulse counts: of a rigid solid, whose shares name
  /// any point, the nearest to x. Local.
  SurfacePoint<dim> point_near(const SurfacePoint<dim>& of_share, int solid,
                               const Point<dim>& x) const {
    return surface_->solids()[solid].rigid
               ? surface_->closest_on_solid(surface_->beside(solid, x), solid)
               : of_share;
  }
  /// Momentum that the dynamic solids took in a solve: from the fluid lumped on them before, less
  /// the part lumped after it, and from pressures. Collective.
  Momentum<dim> taken_by_solids(const SolidSystem<dim>& solids,
                                const std::vector<double>& velocity_before,
                                const BlockVector& solution,
                                const std::vector<double>& gas_pressure) const;
  /// Computes the hydrostatic loads. `add` gives the closed parts of faces, and the fluid lumped on
  /// solids. Collective.
  void find_hydrostatic_loads(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                              const std::function<void(HydrostaticLoads<dim>&)>& add);

  const SurfaceSnapshot<dim>* surface_ =
      nullptr;  ///< snapshot of the last `assemble`; the caller keeps it alive
  std::vector<ControlVolume<dim>> volumes_;
  std::shared_ptr<const HarmonicExtension> patches_;  ///< contact patches; null: none
  CouplingWeights weights_;                           ///< W
  std::vector<double> masses_;                        ///< M_F
  std::vector<double> prescribed_velocity_;           ///< W_k V_k, by rows of W
  RCP<const CrsMatrix> coupling_transposed_, added_mass_;
  RCP<Import> solid_import_;     ///< solid map -> this rank's `weights_.dofs`
  RCP<Import> pressure_import_;  ///< pressure map -> unknowns that this rank's rows of W push into

 private:
  /// rhs += what rows of these velocities push. Collective.
  void add_pushed(const std::vector<double>& row_velocity, Vector& rhs) const;
  std::vector<double> gas_rates_of_rows(const std::vector<double>& row_velocity,
                                        int n_bubbles) const;
  /// The impulse of each of `pushes_` [kg m/s]. Collective.
  std::vector<double> sizes_of_pushes(const Vector& scaled_pressure,
                                      const std::vector<double>& gas_pressure) const;
  /// result[f] += push of gas bubbles with these p̂, with the sign of `pushes`; empty: nothing.
  void add_pushes_of_gas(const std::vector<double>& scaled_pressure,
                         std::vector<double>& result) const;
  void add_drained_rows(const std::vector<GlobalIndex>& dofs,
                        const std::vector<double>& nodes_and_values,
                        std::vector<Triplet>& coupling) const;

  std::vector<double> closed_area_;
  std::vector<RowPush> pushes_;  ///< in ascending order of rows
  HydrostaticForce<dim> hydrostatics_;
};

/// rhs += weights^T momentum, one value a row; `import` brings the dofs of the weights. Collective.
void add_transposed(const CouplingWeights& weights, const Import& import,
                    const std::vector<double>& momentum, Vector& rhs);
/// result += weights times the dofs they touch. Collective.
void add_product(const CouplingWeights& weights, const Import& import, const Vector& dofs,
                 std::vector<double>& result);

}  // namespace lockstep
