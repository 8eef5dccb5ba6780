#include "stepping/step/locked_motions.hpp"

#include <Tpetra_Vector.hpp>
#include <limits>
#include <map>

#include "base/communicator.hpp"
#include "linear/least_squares.hpp"

namespace lockstep {

namespace {

/// The entries of a vector that are not zero, by id, on all ranks. Collective.
std::vector<std::pair<GlobalIndex, double>> gathered(const Vector& vector) {
  const auto values = vector.getData();
  std::vector<GlobalIndex> ids;
  std::vector<double> own;
  for (int row = 0; row < values.size(); ++row) {
    if (values[row] == 0)
      continue;
    ids.push_back(vector.getMap()->getGlobalElement(row));
    own.push_back(values[row]);
  }
  ids = gather_all(vector.getMap()->getComm(), ids);
  own = gather_all(vector.getMap()->getComm(), own);
  std::vector<std::pair<GlobalIndex, double>> all;
  for (std::size_t k = 0; k < ids.size(); ++k)
    all.emplace_back(ids[k], own[k]);
  return all;
}

/// The sum of weights times this rank's entries of a vector.
double own_part(const std::vector<std::pair<GlobalIndex, double>>& weights, const Vector& vector) {
  const auto values = vector.getData();
  double sum = 0;
  for (const auto& [dof, weight] : weights)
    if (const int local = vector.getMap()->getLocalElement(dof); local >= 0)
      sum += weight * values[local];
  return sum;
}

}  // namespace

LockedMotions::LockedMotions(const NullSpace& pressures, std::vector<RCP<const Vector>> directions,
                             std::vector<double> given, RCP<const LinearOperator> inverse)
    : solid_inverse_(std::move(inverse)) {
  for (std::size_t k = 0; k < directions.size(); ++k) {
    Weights direction = gathered(*directions[k]);
    if (direction.empty())
      continue;
    directions_.push_back(std::move(direction));
    pressures_.push_back(pressures.vector(k));
    given_.push_back(given[k]);
    const RCP<Vector> answer = make_vector(directions[k]->getMap());
    apply(*solid_inverse_, *directions[k], *answer);
    answers_.push_back(answer);
  }
  if (empty())
    return;
  const auto n = static_cast<Eigen::Index>(directions_.size());
  Eigen::MatrixXd products(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      products(i, j) = own_part(directions_[i], *answers_[j]);
  sum_all(answers_.front()->getMap()->getComm(), products.data(), static_cast<int>(n * n));
  inverse_ = pseudo_inverse(0.5 * (products + products.transpose()));
}

/// J C^-1 D. Collective.
Eigen::MatrixXd LockedMotions::along(const std::vector<HeldRow>& rows) const {
  const auto n = static_cast<Eigen::Index>(directions_.size());
  Eigen::MatrixXd products(static_cast<Eigen::Index>(rows.size()), n);
  if (products.size() == 0)
    return products;
  for (Eigen::Index i = 0; i < products.rows(); ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      products(i, k) = own_part(rows[i].weights, *answers_[k]);
  sum_all(answers_.front()->getMap()->getComm(), products.data(),
          static_cast<int>(products.size()));
  return products;
}

std::vector<char> LockedMotions::bears(const std::vector<HeldRow>& rows) const {
  constexpr double least_free = 0.01;  // a part of J C^-1 J^T; chosen, not varied by a page
  std::vector<char> borne(rows.size(), 0);
  if (empty() || rows.empty())
    return borne;
  Vector impulse(answers_.front()->getMap()), velocity(impulse.getMap());
  std::vector<double> whole(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    impulse.putScalar(0);
    for (const auto& [dof, weight] : rows[i].weights)
      if (impulse.getMap()->isNodeGlobalElement(dof))
        impulse.sumIntoGlobalValue(dof, weight);
    apply(*solid_inverse_, impulse, velocity);
    whole[i] = own_part(rows[i].weights, velocity);
  }
  sum_over_ranks(impulse.getMap()->getComm(), whole);
  const Eigen::MatrixXd products = along(rows), levels = products * inverse_;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    borne[i] = whole[i] - products.row(row).dot(levels.row(row)) < least_free * whole[i];
  }
  return borne;
}

Eigen::MatrixXd LockedMotions::take_out(std::vector<HeldRow>& rows) const {
  const Eigen::MatrixXd products = along(rows);
  if (products.size() == 0)
    return products;
  const Eigen::MatrixXd levels = products * inverse_;
  const std::vector<char> borne = bears(rows);
  for (Eigen::Index i = 0; i < levels.rows(); ++i) {
    std::map<GlobalIndex, double> weights(rows[i].weights.begin(), rows[i].weights.end());
    for (Eigen::Index k = 0; k < levels.cols(); ++k) {
      if (levels(i, k) == 0)
        continue;
      for (const auto& [dof, area] : directions_[k])
        weights[dof] -= levels(i, k) * area;
      rows[i].velocity -= levels(i, k) * given_[k];
    }
    rows[i].weights.assign(weights.begin(), weights.end());
    if (borne[i])
      rows[i].response = std::numeric_limits<double>::infinity();
  }
  return levels;
}

void LockedMotions::add_pressure(const Eigen::MatrixXd& levels, const std::vector<double>& impulses,
                                 Vector& pressure) const {
  for (Eigen::Index k = 0; k < levels.cols(); ++k) {
    double level = 0;
    for (Eigen::Index i = 0; i < levels.rows(); ++i)
      level += levels(i, k) * impulses[i];
    if (level != 0)
      pressure.update(level, *pressures_[k], 1);
  }
}

}  // namespace lockstep
