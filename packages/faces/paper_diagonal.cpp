#include <Eigen/Core>

#include "faces/added_mass.hpp"

namespace lockstep {
namespace {

/// Velocity at a point and angular velocity of one rigid body as rows over its dofs.
template <int dim>
struct RigidRows {
  std::vector<GlobalIndex> dofs;
  Eigen::Matrix<double, dim, Eigen::Dynamic> velocity;
  Eigen::Matrix<double, n_rotations<dim>, Eigen::Dynamic> rotation;
};

template <int dim>
RigidRows<dim> rigid_rows(const SolidSystem<dim>& solids, int solid, const Point<dim>& x) {
  SurfacePoint<dim> point;
  point.simplex = solids.solids()[solid].simplex_begin;
  point.barycentric.setConstant(1. / dim);
  point.position = x;
  const auto columns_at = [&](const Point<dim>& place, std::vector<GlobalIndex>& dofs) {
    VelocityRow<dim> row;
    solids.velocity_row(point, place, row);
    dofs = row.dofs;
    Eigen::Matrix<double, dim, Eigen::Dynamic> columns(dim, row.dofs.size());
    for (std::size_t k = 0; k < row.dofs.size(); ++k)
      columns.col(static_cast<int>(k)) = row.coefficients[k];
    return columns;
  };
  RigidRows<dim> rows;
  rows.velocity = columns_at(x, rows.dofs);
  rows.rotation.resize(n_rotations<dim>, rows.velocity.cols());
  for (int r = 0; r < n_rotations<dim>; ++r) {
    // omega_r e_r x e_arm = omega_r e_along
    const int arm = dim == 2 ? 0 : (r + 1) % dim, along = dim == 2 ? 1 : (r + 2) % dim;
    std::vector<GlobalIndex> same;
    rows.rotation.row(r) =
        columns_at(x + Point<dim>::Unit(arm), same).row(along) - rows.velocity.row(along);
  }
  return rows;
}

/// Per solid: sum of w_f m_f by axis, then of w_f m_f R_{f,i} (Eq. 22), over all ranks.
template <int dim>
std::vector<double> lumped_moments(const std::vector<ControlVolume<dim>>& volumes,
                                   const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                   const SolidSystem<dim>& solids,
                                   const std::vector<double>& masses) {
  std::vector<double> sums(2 * dim * solids.solids().size(), 0);
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const int axis = volumes[f].direction;
    for (const SurfaceShare<dim>& share : shares[f]) {
      sums[2 * dim * share.solid + axis] += share.weight * masses[f];
      sums[2 * dim * share.solid + dim + axis] +=
          share.weight * masses[f] * solids.own_place(share.solid, volumes[f].center)[axis];
    }
  }
  if (!sums.empty())
    sum_all(solids.comm(), sums.data(), static_cast<int>(sums.size()));
  return sums;
}

}  // namespace

template <int dim>
std::vector<Triplet> paper_diagonal_triplets(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SolidSystem<dim>& solids,
    const std::vector<double>& masses) {
  const std::vector<double> sums = lumped_moments<dim>(volumes, shares, solids, masses);
  const std::vector<SolidState<dim>> states = solids.states();
  std::vector<Triplet> triplets;
  for (int s = 0; s < static_cast<int>(states.size()); ++s) {
    const SolidDescription& solid = solids.solids()[s];
    const bool is_seen = solid.simplex_begin < solid.simplex_end;
    if (!solid.rigid || solid.prescribed || !is_seen)
      continue;
    const double mass = states[s].mass;
    const Point<dim> center = states[s].center_of_mass;
    Point<dim> lumped_center;  // Eq. 22: each axis has its own
    for (int a = 0; a < dim; ++a) {
      lumped_center[a] =
          (mass * center[a] + sums[2 * dim * s + dim + a]) / (mass + sums[2 * dim * s + a]);
    }
    const RigidRows<dim> at_lumped = rigid_rows<dim>(solids, s, lumped_center);
    const RigidRows<dim> at_center = rigid_rows<dim>(solids, s, center);
    const auto& turn = at_lumped.rotation;
    const int n = static_cast<int>(turn.cols());
    Eigen::MatrixXd added = Eigen::MatrixXd::Zero(n, n);
    // V̄ = V + omega x (X̄ - X) is the velocity at X̄. The body's own part, once over all ranks; its
    // inertia I cancels in dM = T^T diag(M̄, Ī) T - M_S.
    if (is_root(solids.comm())) {
      added += mass * at_lumped.velocity.transpose() * at_lumped.velocity;
      added -= mass * at_center.velocity.transpose() * at_center.velocity;
      for (int a = 0; a < dim; ++a) {
        const Eigen::VectorXd arm =
            turn.transpose() * cross<dim>(center - lumped_center, Point<dim>::Unit(a));
        added += mass * arm * arm.transpose();
      }
    }
    for (std::size_t f = 0; f < volumes.size(); ++f) {
      const int axis = volumes[f].direction;
      for (const SurfaceShare<dim>& share : shares[f]) {
        if (share.solid != s)
          continue;
        const Eigen::VectorXd along = at_lumped.velocity.row(axis).transpose();
        const Eigen::VectorXd arm =
            turn.transpose() * cross<dim>(solids.own_place(s, volumes[f].center) - lumped_center,
                                          Point<dim>::Unit(axis));
        added += share.weight * masses[f] * (along * along.transpose() + arm * arm.transpose());
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (added(i, j) != 0)
          triplets.push_back({at_lumped.dofs[i], at_lumped.dofs[j], added(i, j)});
      }
    }
  }
  return triplets;
}

template std::vector<Triplet> paper_diagonal_triplets<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<std::vector<SurfaceShare<2>>>&,
    const SolidSystem<2>&, const std::vector<double>&);
template std::vector<Triplet> paper_diagonal_triplets<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<std::vector<SurfaceShare<3>>>&,
    const SolidSystem<3>&, const std::vector<double>&);

}  // namespace lockstep
