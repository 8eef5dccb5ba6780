#include "contact/impulses/limit_impulses.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/round_off.hpp"

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

/// Solves the complementarity problem by exchange of all wrong rows at once; returns false if that
/// makes no progress.
bool exchange_blocks(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  constexpr int most_idle = 10;  // rounds without progress
  constexpr double round_off = 1e-13;
  constexpr double solved = 1e-9;  // error of a block that is nearly singular [1]
  const auto n = static_cast<int>(b.size());
  const double scale = b.cwiseAbs().maxCoeff();
  std::vector<char> pushes(n, 0);
  int fewest = n + 1, idle = 0;
  while (idle <= most_idle) {
    x = solved_for(pushes, a, b);
    const Eigen::VectorXd rest = a * x + b;
    std::vector<int> wrong;
    for (int k = 0; k < n; ++k) {
      if (pushes[k] ? x[k] < 0 : rest[k] < -round_off * scale)
        wrong.push_back(k);
    }
    if (wrong.empty())
      return rest.minCoeff() >= -solved * scale;
    const int n_wrong = static_cast<int>(wrong.size());
    idle = n_wrong < fewest ? 0 : idle + 1;
    fewest = std::min(fewest, n_wrong);
    for (const int k : wrong)
      pushes[k] = pushes[k] ? 0 : 1;
  }
  return false;
}

/// Minimises 1/2 x.A x + b.x over x >= 0 by the active sets of Lawson and Hanson: one row after the
/// other joins those that push, and rows that would pull leave, so that the sum falls in every
/// round.
Eigen::VectorXd descend(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  constexpr double round_off = rounding::sums;
  const auto n = static_cast<int>(b.size());
  const double scale = b.cwiseAbs().maxCoeff();
  std::vector<char> pushes(n, 0), idle(n, 0);  // idle: joined last without an effect
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int round = 0; round < 10 * n + 100; ++round) {
    const Eigen::VectorXd rest = a * x + b;
    int next = -1;
    for (int k = 0; k < n; ++k) {
      if (!pushes[k] && !idle[k] && (next < 0 || rest[k] < rest[next]))
        next = k;
    }
    if (next < 0 || rest[next] >= -round_off * scale)
      break;
    pushes[next] = 1;
    for (bool pulls = true; pulls;) {
      const Eigen::VectorXd whole = solved_for(pushes, a, b);
      double part = 1;
      for (int k = 0; k < n; ++k) {
        if (pushes[k] && whole[k] <= 0)
          part = std::min(part, x[k] > 0 ? x[k] / (x[k] - whole[k]) : 0);
      }
      x += part * (whole - x);
      pulls = false;
      for (int k = 0; k < n; ++k) {
        if (!pushes[k] || whole[k] > 0 || x[k] > rounding::few * x.maxCoeff())
          continue;
        pushes[k] = 0;
        x[k] = 0;
        pulls = true;
      }
    }
    if (pushes[next])
      std::fill(idle.begin(), idle.end(), 0);
    else
      idle[next] = 1;
  }
  return x;
}

}  // namespace

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                      double negligible) {
  constexpr double acceptable = 1e-6;
  const double scale = b.cwiseAbs().maxCoeff();
  const double allowed = std::max(acceptable * scale, negligible);
  // Lifted, rows that depend on one another have a solution, but one that need not solve A itself.
  Eigen::MatrixXd lifted = a;
  lifted.diagonal() *= 1 + 1e-12;
  const auto broken_by = [&](const Eigen::VectorXd& x) { return -(a * x + b).minCoeff(); };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  if (exchange_blocks(lifted, b, x)) {
    x = x.cwiseMax(0);
    if (broken_by(x) <= allowed)
      return x;
  }
  x = descend(lifted, b);
  const double broken = broken_by(x);
  check_solve(broken <= allowed,
              "The limits of joints contradict one another: of {} that act together one is left "
              "{:.2g} m/s beyond, where {:.2g} m/s were to be stopped. Look at the limits of "
              "joints that a loop ties together, or take shorter steps.",
              b.size(), broken, scale);
  return x;
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
}

double LimitImpulses::value(const Row& row, const std::vector<double>& velocity) const {
  double sum = 0;
  for (const auto& [id, weight] : row.weights)
    sum += weight * velocity[id];
  return sum;
}

double LimitImpulses::relax(std::vector<double>& velocity, double negligible) {
  if (rows_.empty())
    return 0;
  Eigen::VectorXd lack(impulses_.size());
  for (Eigen::Index k = 0; k < lack.size(); ++k)
    lack[k] = value(rows_[k], velocity) - rows_[k].least;
  const Eigen::VectorXd wanted =
      solve_complementarity(matrix_, lack - matrix_ * impulses_, negligible);
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
