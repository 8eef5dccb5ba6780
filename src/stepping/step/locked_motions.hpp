#pragma once
#include <Eigen/Core>
#include <vector>

#include "interfaces/contact.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

/// Motions that closed fluid does not let solids make, d.V = given for every direction d = P^T B^T
/// n with a pressure n that is constant on closed fluid and zero elsewhere, beside contacts that
/// block the same motions.
///
/// Rows J of contacts that a coupled solve holds stiffly would hide from it what such a pressure
/// does: the solve could not tell which of both bears what, and would stand still. So it holds
///
///   J' = J - (J C^-1 D) (D^T C^-1 D)^+ D^T,    which leaves the motions C^-1 D free,
///
/// at the velocity that J' V has where J V is the contact's and D^T V what the fluid demands. An
/// impulse J'^T l is the contact's J^T l, and in closed fluid the pressure `n_k levels_k . l` more.
/// All solids must be rigid: of soft ones D has every node.
class LockedMotions {
 public:
  /// Nothing is locked.
  LockedMotions() = default;
  /// `pressures`: n; `directions`: d [m^(dim-1)]; `given`: d.V [m^dim/s]; `inverse`: C^-1 of the
  /// unknowns. Collective.
  LockedMotions(NullSpace pressures, const std::vector<RCP<const Vector>>& directions,
                std::vector<double> given, const RCP<const LinearOperator>& inverse);

  bool empty() const { return directions_.empty(); }
  /// Replaces rows by J' and its velocities, and returns `levels`, one row a held row, one column a
  /// direction [1/m^(dim-1)]. Collective.
  Eigen::MatrixXd take_out(std::vector<HeldRow>& rows) const;
  /// p̂ += n_k levels_k . impulses. Local.
  void add_pressure(const Eigen::MatrixXd& levels, const std::vector<double>& impulses,
                    Vector& pressure) const;

 private:
  using Weights = std::vector<std::pair<GlobalIndex, double>>;

  Eigen::MatrixXd along(const std::vector<HeldRow>& rows) const;

  NullSpace pressures_;
  std::vector<Weights> directions_;         ///< by dof, the same on all ranks
  std::vector<RCP<const Vector>> answers_;  ///< C^-1 d
  std::vector<double> given_;
  Eigen::MatrixXd inverse_;  ///< (D^T C^-1 D)^+
};

}  // namespace lockstep
