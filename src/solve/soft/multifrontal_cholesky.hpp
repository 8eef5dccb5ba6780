#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

namespace lockstep {

/// L L^T = A of a sparse symmetric positive definite matrix, by fronts: the columns of a supernode
/// are eliminated at once in a dense matrix, and what they change in the rows below is handed to
/// the supernode that these rows meet first (Duff and Reid 1983; Liu 1992). Nested dissection.
class MultifrontalCholesky {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Orders the rows. Of A only the lower triangle is looked at.
  void analyze(const Matrix& lower);
  /// Multiplications of `factorize`, known after `analyze`.
  double n_operations() const;
  /// Factorises A as it was analysed, with other values; returns false if a pivot is not positive.
  bool factorize(const Matrix& lower);
  /// x := A^-1 x.
  void solve(Eigen::VectorXd& x) const;
  /// Numbers that the factors store.
  double n_stored() const;

 private:
  /// Columns [begin, end) of the ordered matrix, and the rows below them that they reach.
  struct Supernode {
    int begin = 0, end = 0, parent = -1;
    std::vector<int> below;
    Eigen::MatrixXd factor;  ///< columns x (columns and rows below)
    int n_columns() const { return end - begin; }
    int n_rows() const { return n_columns() + static_cast<int>(below.size()); }
  };

  std::vector<int> place_of_;  ///< row of A -> row of the ordered matrix
  std::vector<Supernode> nodes_;
};

}  // namespace lockstep
