#include "contact/limit_impulses.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace lockstep {

namespace {

/// x of the rows that push, which they make zero; zero for others.
Eigen::VectorXd solved_for(const std::vector<char>& pushes, const Eigen::MatrixXd& a,
                           const Eigen::VectorXd& b) {
  std::vector<Eigen::Index> members;
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    if (pushes[k])
      members.push_back(static_cast<Eigen::Index>(k));
  }
  const auto n = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd block(n, n);
  Eigen::VectorXd rhs(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rhs[i] = -b[members[i]];
    for (Eigen::Index j = 0; j < n; ++j)
      block(i, j) = a(members[i], members[j]);
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  if (n == 0)
    return x;
  const Eigen::VectorXd solved = block.ldlt().solve(rhs);
  for (Eigen::Index i = 0; i < n; ++i)
    x[members[i]] = solved[i];
  return x;
}

}  // namespace

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  constexpr int most_blocks = 10;  // without progress, before rows go one by one
  constexpr double round_off = 1e-13;
  const auto n = static_cast<int>(b.size());
  std::vector<char> pushes(n, 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  int fewest = n + 1, blocks_left = most_blocks;
  for (int round = 0; round < 20 * (n + most_blocks); ++round) {
    x = solved_for(pushes, a, b);
    const Eigen::VectorXd rest = a * x + b;
    const double scale = b.cwiseAbs().maxCoeff();
    std::vector<int> wrong;
    for (int k = 0; k < n; ++k) {
      if (pushes[k] ? x[k] < 0 : rest[k] < -round_off * scale)
        wrong.push_back(k);
    }
    if (wrong.empty())
      break;
    const int n_wrong = static_cast<int>(wrong.size());
    if (n_wrong < fewest) {
      fewest = n_wrong;
      blocks_left = most_blocks;
    } else if (blocks_left > 0) {
      --blocks_left;
    }
    if (blocks_left == 0)
      wrong = {wrong.back()};
    for (const int k : wrong)
      pushes[k] = pushes[k] ? 0 : 1;
  }
  return x.cwiseMax(0);
}

void LimitImpulses::add(Row row) {
  rows_.push_back(std::move(row));
  const auto n = static_cast<Eigen::Index>(rows_.size());
  impulses_.conservativeResize(n);
  impulses_[n - 1] = 0;
  matrix_.conservativeResize(n, n);
  std::vector<double> response;
  for (const auto& [id, velocity] : rows_.back().response) {
    if (static_cast<std::size_t>(id) >= response.size())
      response.resize(id + 1, 0);
    response[id] += velocity;
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    double sum = 0;
    for (const auto& [id, weight] : rows_[k].weights)
      sum += static_cast<std::size_t>(id) < response.size() ? weight * response[id] : 0;
    matrix_(k, n - 1) = matrix_(n - 1, k) = sum;
  }
  // Both limits of one coordinate are the same row twice.
  matrix_(n - 1, n - 1) *= 1 + 1e-12;
}

double LimitImpulses::value(const Row& row, const std::vector<double>& velocity) const {
  double sum = 0;
  for (const auto& [id, weight] : row.weights)
    sum += weight * velocity[id];
  return sum;
}

double LimitImpulses::relax(std::vector<double>& velocity) {
  if (rows_.empty())
    return 0;
  Eigen::VectorXd lack(impulses_.size());
  for (Eigen::Index k = 0; k < lack.size(); ++k)
    lack[k] = value(rows_[k], velocity) - rows_[k].least;
  const Eigen::VectorXd wanted = solve_complementarity(matrix_, lack - matrix_ * impulses_);
  const Eigen::VectorXd change = wanted - impulses_;
  impulses_ = wanted;
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    for (const auto& [id, response] : rows_[k].response)
      velocity[id] += change[k] * response;
  }
  return (matrix_ * change).lpNorm<Eigen::Infinity>();
}

void LimitImpulses::add_to(std::vector<double>& total) const {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (const auto& [id, weight] : rows_[k].weights)
      total[id] += impulses_[static_cast<Eigen::Index>(k)] * weight;
  }
}

}  // namespace lockstep
