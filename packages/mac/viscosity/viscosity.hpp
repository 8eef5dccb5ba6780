#pragma once
#include <memory>

#include "mac/viscosity/viscous_stencil.hpp"

namespace lockstep {

/// Implicit viscosity in the Laplacian form, component by component, but beside air: a velocity and
/// its neighbour at distance d across an area pull on each other with mu area / d. The couplings of
/// a velocity are found once per geometry, for the matrix as for the impulses.
///
/// A wall pulls from h/2 (its tangential velocities) or from the next face (its normal ones); slip
/// walls and open sides do not pull. A neighbour behind a surface, or inside a solid, is replaced
/// by the point where the link meets the surface. Beside air see StressAtAir.
template <int dim>
class Viscosity {
 public:
  /// Collective. `domain` must outlive this.
  Viscosity(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
            const ViscosityParameters& parameters, const ImplicitTension& tension = {});

  /// The system for the present velocities; matrix and links are shared with earlier ones. `time`
  /// sets the velocity of walls and inflows. Collective.
  std::unique_ptr<ViscousSystem<dim>> system(const FaceField<dim>& velocity, double time) const;
  /// velocity := solution on owned free faces.
  void store(const Vector& solution, FaceField<dim>& velocity) const;
  /// Impulse of walls and inflows over dt, acting at the centre of the velocity that they pull, and
  /// the couple of parallel forces between neighbours. The halo of `velocity` must be valid.
  /// Collective.
  Momentum<dim> impulse(const FaceField<dim>& velocity, double time, double dt) const;
  /// Impulse of implicit surface tension over dt: a couple, as it resists rotation. The halo of
  /// `velocity` must be valid. Collective.
  Momentum<dim> tension_impulse(const FaceField<dim>& velocity, double dt) const;

 private:
  Momentum<dim> sum_of(const std::vector<CrossPull>& pulls, const FaceField<dim>& velocity,
                       double dt) const;
  double side_velocity(const SideCoupling& side, double time) const;
  double inflow_velocity(const FaceId& face, double time) const;

  const MacDomain<dim>& domain_;
  RCP<const Map> map_;
  std::vector<FaceId> faces_;  ///< faces of the rows
  RCP<const CrsMatrix> stiffness_;
  RCP<Vector> mass_;
  std::vector<ViscousCouplingTerm<dim>> links_;
  std::vector<SideCoupling> sides_;
  std::vector<CoupleEnd> couples_;
  std::vector<CrossPull> cross_pulls_, tension_pulls_;
  std::vector<InflowPull> inflow_pulls_;
  double viscosity_;
};

}  // namespace lockstep
