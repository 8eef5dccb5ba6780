#pragma once
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <vector>

#include "linear/matrix_rows.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/preconditioner.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/soft/inverse_by_cost.hpp"

namespace lockstep::test {

/// n x n nodes of unit mass and distance, tied to their eight neighbours by springs of stiffness k,
/// linear about rest; the nodes are dealt to the ranks row by row. A rigid dof of mass 3 follows on
/// the last rank.
struct Lattice {
  Lattice(int n, double k) {
    const Communicator comm = Tpetra::getDefaultComm();
    const int n_nodes = n * n, rank = comm->getRank(), n_ranks = comm->getSize();
    const int begin = n_nodes * rank / n_ranks, end = n_nodes * (rank + 1) / n_ranks;
    const bool is_last = rank == n_ranks - 1;
    const RCP<const Map> map = make_map(2 * (end - begin) + (is_last ? 1 : 0), comm);
    std::vector<std::vector<Entry>> rows(map->getNodeNumElements());
    const auto motions = rcp(new MultiVector(map, 3));
    for (int node = begin; node < end; ++node) {
      const int i = node % n, j = node / n, row = 2 * (node - begin);
      for (int a = 0; a < 2; ++a) {
        rows[row + a].push_back({2 * node + a, 1});
        motions->replaceLocalValue(row + a, a, 1);
        motions->replaceLocalValue(row + a, 2, a == 0 ? -j : i);
        space.body_of_row.push_back(0);
      }
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const bool inside = i + di >= 0 && i + di < n && j + dj >= 0 && j + dj < n;
          if (inside && (di != 0 || dj != 0))
            add_spring(node, node + di + n * dj, Point<2>(di, dj).normalized(), k, rows, row);
        }
      }
    }
    if (is_last) {
      rows.back().push_back({2 * n_nodes, 3});
      space.body_of_row.push_back(-1);
    }
    space.motions = motions;
    space.n_bodies = 1;
    std::vector<std::vector<Entry>> mass(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row)
      mass[row] = {{map->getGlobalElement(row), 1}};
    space.mass =
        lumped_mass(*as_operator(RCP<const CrsMatrix>(matrix_from_rows(map, mass))), space);
    c = matrix_from_rows(map, rows);
  }

  static void add_spring(int node, int other, const Point<2>& e, double k,
                         std::vector<std::vector<Entry>>& rows, int row) {
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        rows[row + a].push_back({2 * node + b, k * e[a] * e[b]});
        rows[row + a].push_back({2 * other + b, -k * e[a] * e[b]});
      }
    }
  }

  RCP<const CrsMatrix> c;
  NearNullSpace space;
};

inline Teuchos::ParameterList type(const std::string& name) {
  Teuchos::ParameterList list;
  list.set("Type", name);
  return list;
}

/// Iterations of conjugate gradients to 1e-10 with this inverse.
inline long iterations(const Lattice& solid, const std::string& name) {
  const auto op = as_operator(solid.c);
  const auto inverse = preconditioner_from_list(op, type(name), "solid", solid.space);
  EXPECT_NO_THROW(check_symmetric_positive(*inverse, "solid"));
  const auto count = std::make_shared<long>(0);
  const auto solver =
      conjugate_gradient_inverse(op, {inverse, Teuchos::null, 1e-10, 5000, "solid", count});
  Vector rhs(solid.c->getRowMap()), x(solid.c->getRowMap()), residual(solid.c->getRowMap());
  pseudo_random(rhs, 7);
  apply(*solver, rhs, x);
  solid.c->apply(x, residual);
  residual.update(1, rhs, -1);
  EXPECT_LT(residual.norm2(), 1e-6 * rhs.norm2());
  return *count;
}

/// |C x - b| / |b| for this inverse.
inline double error_of(const LinearOperator& inverse, const CrsMatrix& c) {
  Vector rhs(c.getRowMap()), x(c.getRowMap()), residual(c.getRowMap());
  pseudo_random(rhs, 5);
  apply(inverse, rhs, x);
  c.apply(x, residual);
  residual.update(1, rhs, -1);
  return residual.norm2() / rhs.norm2();
}

}  // namespace lockstep::test
