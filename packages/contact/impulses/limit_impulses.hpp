#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>

namespace lockstep {

/// Impulses that keep rates from going below their bounds: of all limits at once and exactly, since
/// those of a chain answer one another too strongly for sweeps. Local.
class LimitImpulses {
 public:
  /// Row k: sum of weights times velocities, by id; `response`: velocities that a unit impulse
  /// along it makes, by id; `least`: its bound.
  struct Row {
    std::vector<std::pair<int, double>> weights, response;
    double least = 0;
  };
  void add(Row row);
  /// The response of a row at an id that it does not have yet.
  void extend(int row, int id, double velocity) { rows_[row].response.emplace_back(id, velocity); }
  const Row& row(int number) const { return rows_[number]; }
  int size() const { return static_cast<int>(rows_.size()); }
  double impulse(int row) const { return impulses_[row]; }
  /// Its value for a unit impulse along itself.
  double response(int row) const { return matrix_(row, row); }

  /// Changes the velocities, and the impulses given so far, to those that meet all bounds: impulses
  /// only push, and only at bounds that are reached. Where bounds contradict one another, they may
  /// be missed by `negligible` [m/s]. Returns the largest change of a row's value.
  double relax(std::vector<double>& velocity, double negligible = 0);
  /// Adds J^T impulses, by id.
  void add_to(std::vector<double>& total) const;

 private:
  double value(const Row& row, const std::vector<double>& velocity) const;

  std::vector<Row> rows_;
  Eigen::MatrixXd matrix_;  ///< values of rows for unit impulses along rows
  Eigen::VectorXd impulses_;
};

/// x >= 0 with A x + b >= 0 and one of both zero in every row, for a symmetric positive definite A
/// or semidefinite: by exchange of blocks of rows, which takes a few solves; where
/// that does not end, by descent of 1/2 x.A x + b.x, which does. Throws SolveError if rows are left
/// that no x meets, by more than `negligible` and than round-off.
Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                      double negligible = 0);

}  // namespace lockstep
