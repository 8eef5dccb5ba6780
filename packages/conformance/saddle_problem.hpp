#pragma once
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <vector>

#include "interfaces/strategy.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/null_space.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

/// Parameters of the small coupled problem below.
struct SaddleOptions {
  int n = 16;                 ///< cells a side of the unit square
  bool open_top = true;       ///< p = 0 at the top
  bool elastic_wall = false;  ///< the right wall is a piston: one more solid dof
  double plate_mass = 50;     ///< kg
  bool with_solid = true;
  int n_empty_ranks = 0;  ///< the last ranks own no cell
};

/// Water (SI units) around two rigid upright plates with three dofs each (velocity, rotation about
/// z): Eq. 16 with A the 5-point operator without the faces that the plates block.
class SaddleProblem {
 public:
  SaddleProblem(const Communicator& comm, const SaddleOptions& options)
      : options_(options), h_(1.0 / options.n), comm_(comm) {
    const int n_cells = options.n * options.n;
    const int n_owners = comm->getSize() - options.n_empty_ranks, rank = comm->getRank();
    const auto first = [&](int r) { return std::min(r, n_owners) * n_cells / n_owners; };
    cells_ = make_map(first(rank + 1) - first(rank), comm);
    const int n_solid = 6 + (options.elastic_wall ? 1 : 0);
    const auto first_dof = [&](int r) { return r * n_solid / comm->getSize(); };
    dofs_ = make_map(first_dof(rank + 1) - first_dof(rank), comm);
    const auto a = as_operator(pressure_block());
    if (options.with_solid)
      system.set_blocks(a, coupling(), as_operator(solid_block()));
    else
      system.set_blocks(a);
    system.geometry_version = system.solids.version = 1;
    if (!options.open_top)
      add_null_vectors();
  }

  BlockVector zero() const {
    return {make_vector(cells_), options_.with_solid ? make_vector(dofs_) : Teuchos::null};
  }
  /// A right-hand side that is compatible with the null space.
  BlockVector random_rhs() const {
    BlockVector rhs = zero();
    pseudo_random(*rhs.pressure, 3);
    rhs.pressure->scale(1e-3);
    project_out(system.null_space, *rhs.pressure);
    if (options_.with_solid) {
      pseudo_random(*rhs.solid, 4);
      rhs.solid->scale(100);
    }
    return rhs;
  }

  const SaddleOptions& options() const { return options_; }
  const Communicator& comm() const { return comm_; }

  BlockSystem system;

 private:
  static constexpr double density = 1000;
  GlobalIndex cell(int i, int j) const { return i + static_cast<GlobalIndex>(options_.n) * j; }
  /// The plate that blocks the face between (i - 1, j) and (i, j), or -1.
  int plate(int i, int j) const {
    const int n = options_.n;
    if (!options_.with_solid || j < n / 4 || j >= 3 * n / 4)
      return -1;
    return i == n / 3 ? 0 : i == 2 * n / 3 ? 1 : -1;
  }

  RCP<CrsMatrix> pressure_block() const {
    const int n = options_.n;
    std::vector<std::vector<Entry>> rows(cells_->getNodeNumElements());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const int id = static_cast<int>(cells_->getGlobalElement(static_cast<int>(row)));
      const int i = id % n, j = id / n;
      const auto link = [&](int i2, int j2) {
        rows[row].push_back({cell(i, j), 1 / density});
        rows[row].push_back({cell(i2, j2), -1 / density});
      };
      if (i > 0 && plate(i, j) < 0)
        link(i - 1, j);
      if (i < n - 1 && plate(i + 1, j) < 0)
        link(i + 1, j);
      if (j > 0)
        link(i, j - 1);
      if (j < n - 1)
        link(i, j + 1);
      if (j == n - 1 && options_.open_top)
        rows[row].push_back({cell(i, j), 2 / density});
    }
    return matrix_from_rows(cells_, rows);
  }

  /// Rows of B^T: V G^T W with V = h^2 and W the velocity of the plate at the face.
  RCP<CrsMatrix> coupling() const {
    const int n = options_.n;
    std::vector<std::vector<Entry>> rows(dofs_->getNodeNumElements());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const int dof = static_cast<int>(dofs_->getGlobalElement(static_cast<int>(row)));
      for (int j = 0; j < n; ++j) {
        if (dof == 6)
          rows[row].push_back({cell(n - 1, j), -h_});
        for (int i = 1; i < n; ++i) {
          const double arm = (j + 0.5) * h_ - 0.5;
          const double weight = dof % 3 == 0 ? 1 : dof % 3 == 1 ? 0 : -arm;
          if (dof == 6 || plate(i, j) != dof / 3 || weight == 0)
            continue;
          rows[row].push_back({cell(i - 1, j), -h_ * weight});
          rows[row].push_back({cell(i, j), h_ * weight});
        }
      }
    }
    return matrix_from_rows(dofs_, rows, cells_);
  }

  /// Dense 3 x 3 blocks, weakly coupled inside.
  RCP<CrsMatrix> solid_block() const {
    std::vector<std::vector<Entry>> rows(dofs_->getNodeNumElements());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const GlobalIndex dof = dofs_->getGlobalElement(static_cast<int>(row));
      const double mass = options_.plate_mass * static_cast<double>(1 + dof / 3);
      rows[row].push_back({dof, dof % 3 == 2 ? mass / 12 : mass});
      for (GlobalIndex other = dof / 3 * 3; dof < 6 && other < dof / 3 * 3 + 3; ++other) {
        if (other != dof)
          rows[row].push_back({other, 0.05 * mass});
      }
    }
    return matrix_from_rows(dofs_, rows);
  }

  void add_null_vectors() {
    const auto constant = make_vector(cells_);
    constant->putScalar(h_);
    system.pressure_null_space = null_space_of({constant});
    if (!options_.elastic_wall || !options_.with_solid)
      system.null_space = system.pressure_null_space;
  }

  SaddleOptions options_;
  double h_;
  Communicator comm_;
  RCP<const Map> cells_, dofs_;
};

/// max |a - b| over max |a|.
inline double relative_difference(const Vector& a, const Vector& b) {
  Vector difference(a, Teuchos::Copy);
  difference.update(-1, b, 1);
  return difference.normInf() / a.normInf();
}

}  // namespace lockstep
