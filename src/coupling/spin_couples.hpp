#pragma once
#include <vector>

#include "interfaces/viscosity.hpp"

namespace lockstep {

/// Couple that the Laplacian form of viscosity lacks at solids: the transposed gradient mu (grad
/// u)^T n of the symmetric stress. Inside a fluid free of divergence it exerts no force, and where
/// the fluid sticks to a surface it depends on the motion of that surface alone: on a closed solid
/// its sum is the couple -2 mu V Omega, V the volume and Omega the mean angular velocity. The
/// viscous couplings of the Laplacian produce the opposite couple: mu area times the velocity of
/// the surface at either end of a strip of velocities. So V is the volume between the ends of the
/// couplings, and Omega fits the velocities there best, and is exact for a rigid solid: a fluid
/// that turns with its solids pulls none of them, and angular momentum is conserved. Shells have no
/// V; that of a container is negative.
template <int dim>
class SpinCouples {
 public:
  /// `ends`: of the links. Collective.
  SpinCouples(const std::vector<ViscousCouplingTerm<dim>>& links,
              const std::vector<EndVelocity<dim>>& ends,
              const std::vector<SolidDescription>& solids, const Communicator& comm);
  /// True if no solid is turned by them. The same on all ranks.
  bool empty() const { return empty_; }
  /// pull += the couples as forces on the solids at the ends of the links [N], for these velocities
  /// of the ends [m/s]. They are linear and symmetric: pull -= S^T strength S velocity. Collective.
  void add_pull(const double* end_velocity, double* pull) const;

 private:
  struct Fit;
  void keep_turning(const std::vector<Fit>& fits,
                    const std::vector<ViscousCouplingTerm<dim>>& links,
                    const std::vector<EndVelocity<dim>>& ends,
                    const std::vector<AngularVector<dim>>& strength);
  void place_centers(const std::vector<ViscousCouplingTerm<dim>>& links,
                     const std::vector<EndVelocity<dim>>& ends);
  std::vector<Fit> fit(const std::vector<ViscousCouplingTerm<dim>>& links,
                       const std::vector<EndVelocity<dim>>& ends) const;

  Communicator comm_;
  bool empty_ = true;
  std::vector<int> solid_;  ///< solid of each coupling, among those that turn; -1: none
  std::vector<AngularVector<dim>> spin_;      ///< column of S of each link [1/m]
  std::vector<AngularVector<dim>> strength_;  ///< 2 mu V about each axis [kg m^2/s], of these
  std::vector<Point<dim>> center_;            ///< centre of the ends of each solid's couplings [m]
  mutable std::vector<double> rates_;         ///< Omega of each of these
};

}  // namespace lockstep
