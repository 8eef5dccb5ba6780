#pragma once
#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "linear/conjugate_gradients.hpp"
#include "multigrid/pressure_layout.hpp"

namespace lockstep {

/// A coarse space W for the Schur complement S = A + B C^-1 B^T of light solids.
///
/// A solid lighter than the fluid that it displaces makes S stiff in its few rigid motions, which
/// an inverse of A alone does not know. Each such degree of freedom j gets one function w_j: the
/// inverse of A applied to its column of B, cut off smoothly a radius away from the solid, so that
/// the functions of different solids do not overlap. Projecting W out (Nicolaides 1987; Tang,
/// Nabben, Vuik and Erlangga 2009, variant A-DEF2) leaves iterations that depend neither on the
/// density nor on the number of solids: on the rest, B^T x is nearly 0 and S is nearly A. Unlike a
/// Woodbury update, nothing here must be exact for the preconditioner to stay positive definite.
class Deflation {
 public:
  /// For a system in `layout`; null if no solid is light, or if one closes a region of fluid.
  /// Solids are the small components of C (which must be assembled). Collective.
  static std::unique_ptr<Deflation> make(const BlockSystem& system, PressureLayout& layout);

  int size() const { return static_cast<int>(coarse_inverse_.rows()); }

  /// x := W E^-1 W^T r with E = W^T S W, r -= S x: afterwards W^T r = 0. Collective.
  void start(Vector& r, Vector& x) const;
  /// z += W E^-1 (W^T r - W^T S z), on the kernels' z; returns the change of r.z. Collective.
  double correct(const Vector& r);
  /// The same with any vectors, and its transpose: M = P M_A P^T + W E^-1 W^T with
  /// P = I - W E^-1 W^T S is symmetric positive definite if M_A is. Collective.
  void apply_balanced(const LinearOperator& pressure_inverse, const Vector& r, Vector& z) const;

 private:
  /// An unknown in the support of some function, w != 0 or (A w) != 0.
  struct Cell {
    int entry = 0;
    int first = 0;  ///< coarse number of its solid's first function
    int n = 0;      ///< how many the solid has
    std::array<float, 6> w{};
    std::array<double, 6> aw{};
  };

  Deflation(const BlockSystem& system, PressureLayout& layout) : system_(system), layout_(layout) {}
  bool build();
  void keep_functions(int j, const std::vector<PressureLayout::Grown>& grown, int n_layers,
                      Vector& w);
  Eigen::MatrixXd energy(int n_functions) const;

  template <typename Get>
  Eigen::VectorXd restrict(const Get& get, bool with_operator) const;
  Eigen::VectorXd restricted_operator(const Vector& z) const;
  void add(const Eigen::VectorXd& coarse, Vector& x) const;
  void add_operator(const Eigen::VectorXd& coarse, double factor, Vector& r) const;

  BlockSystem system_;
  PressureLayout& layout_;
  std::vector<Cell> cells_;
  std::vector<int> touched_;        ///< entries of this rank where B has values
  Eigen::MatrixXd coarse_inverse_;  ///< E^-1
  Eigen::MatrixXd motion_;          ///< H = C^-1 B^T W, solid dofs x functions
};

}  // namespace lockstep
