#include "stepping/step/locked_motions.hpp"

#include <Tpetra_Vector.hpp>
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

LockedMotions::LockedMotions(NullSpace pressures, const std::vector<RCP<const Vector>>& directions,
                             std::vector<double> given, const RCP<const LinearOperator>& inverse)
    : pressures_(std::move(pressures)), given_(std::move(given)) {
  for (const RCP<const Vector>& direction : directions) {
    directions_.push_back(gathered(*direction));
    const RCP<Vector> answer = make_vector(direction->getMap());
    apply(*inverse, *direction, *answer);
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

Eigen::MatrixXd LockedMotions::take_out(std::vector<HeldRow>& rows) const {
  const Eigen::MatrixXd levels = along(rows) * inverse_;
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
  }
  return levels;
}

void LockedMotions::add_pressure(const Eigen::MatrixXd& levels, const std::vector<double>& impulses,
                                 Vector& pressure) const {
  const Eigen::Map<const Eigen::VectorXd> pushes(impulses.data(), levels.rows());
  const Eigen::VectorXd factors = levels.transpose() * pushes;
  add_vectors(pressures_, {factors.begin(), factors.end()}, pressure);
}

}  // namespace lockstep
