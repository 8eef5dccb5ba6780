#include "contact/impacts/rigid_member.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "base/round_off.hpp"
#include "linear/least_squares.hpp"

namespace lockstep {

namespace {

/// Velocities at `center` and at `arm` beside it along each axis, one below the other, of a twist
/// of `about`.
template <int dim>
Eigen::VectorXd at_points(const MemberMotion<dim>& twist, const Point<dim>& about,
                          const Point<dim>& center, double arm) {
  const Point<dim> velocity = twist.template head<dim>();
  const AngularVector<dim> spin = twist.template tail<n_rotations<dim>>();
  Eigen::VectorXd values(dim * (dim + 1));
  for (int p = 0; p <= dim; ++p) {
    const Point<dim> x = p < dim ? Point<dim>(center + arm * Point<dim>::Unit(p)) : center;
    values.template segment<dim>(dim * p) = velocity + rotate<dim>(spin, x - about);
  }
  return values;
}

}  // namespace

template <int dim>
RigidMember<dim>::RigidMember(const ContactShapes<dim>& shapes, const InverseMass& inverse_mass,
                              int solid, const Point<dim>& center)
    : shapes_(shapes), solid_(solid), center_(center) {
  const Box<dim>& box = shapes.bounds_of_solid(solid);
  arm_ = box.isEmpty() ? 1 : box.diagonal().norm();
  for (const GlobalIndex dof : shapes.rigid_dofs(solid)) {
    if (!inverse_mass.rows[dof].empty() &&
        std::find(dofs_.begin(), dofs_.end(), dof) == dofs_.end())
      dofs_.push_back(dof);
  }
  const int n = static_cast<int>(dofs_.size());
  rows_ = Eigen::MatrixXd::Zero(dim * (dim + 1), n);
  const auto number = [this](GlobalIndex dof) {
    return static_cast<int>(std::find(dofs_.begin(), dofs_.end(), dof) - dofs_.begin());
  };
  for (int p = 0; p <= dim; ++p) {
    const Point<dim> x = p < dim ? Point<dim>(center + arm_ * Point<dim>::Unit(p)) : center;
    VelocityRow<dim> row;
    shapes.rigid_row(solid, x, row);
    for (std::size_t k = 0; k < row.dofs.size(); ++k) {
      if (const int column = number(row.dofs[k]); column < n)
        rows_.col(column).template segment<dim>(dim * p) += row.coefficients[k];
    }
  }
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (const auto& [dof, value] : inverse_mass.rows[dofs_[i]]) {
      if (const int j = number(dof); j < n)
        inverse(i, j) = value;
    }
  }
  if (n > 0) {
    inverse_ = pseudo_inverse(rows_);
    mass_ = inverse.inverse();
  } else {
    inverse_ = Eigen::MatrixXd::Zero(0, rows_.rows());
    mass_ = inverse;
  }
}

template <int dim>
Eigen::MatrixXd RigidMember<dim>::dofs_of_twists(const Point<dim>& about) const {
  const int n_twists = dim + n_rotations<dim>;
  Eigen::MatrixXd all(dofs_.size(), n_twists);
  for (int k = 0; k < n_twists; ++k)
    all.col(k) = inverse_ * at_points<dim>(MemberMotion<dim>::Unit(k), about, center_, arm_);
  return all;
}

template <int dim>
MemberMass<dim> RigidMember<dim>::mass(const Point<dim>& about) const {
  const Eigen::MatrixXd dofs = dofs_of_twists(about);
  return dofs.transpose() * mass_ * dofs;
}

template <int dim>
MemberMotion<dim> RigidMember<dim>::momentum(const Point<dim>& about,
                                             const std::vector<double>& velocity) const {
  Eigen::VectorXd present(dofs_.size());
  for (std::size_t k = 0; k < dofs_.size(); ++k)
    present[k] = velocity[dofs_[k]];
  return dofs_of_twists(about).transpose() * (mass_ * present);
}

template <int dim>
bool RigidMember<dim>::move(const MemberMotion<dim>& twist, std::vector<double>& velocity) const {
  constexpr double round_off = rounding::differences;
  const Eigen::VectorXd wanted = at_points<dim>(twist, center_, center_, arm_);
  Eigen::VectorXd present(wanted.size());
  for (int p = 0; p <= dim; ++p) {
    const Point<dim> x = p < dim ? Point<dim>(center_ + arm_ * Point<dim>::Unit(p)) : center_;
    present.template segment<dim>(dim * p) = shapes_.rigid_velocity(solid_, x, velocity);
  }
  const Eigen::VectorXd change = inverse_ * (wanted - present);
  for (std::size_t k = 0; k < dofs_.size(); ++k)
    velocity[dofs_[k]] += change[k];
  return (present + rows_ * change - wanted).norm() <= round_off * (wanted.norm() + present.norm());
}

template class RigidMember<2>;
template class RigidMember<3>;

}  // namespace lockstep
