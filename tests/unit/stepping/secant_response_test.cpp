// A response that learns: exact for the last pair of impulse and answer, symmetric and positive.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/triplet_matrix.hpp"
#include "stepping/step/secant_response.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

constexpr int n_secant_dofs = 6;

/// A vector of these values, and zeros, wherever their rows are.
RCP<Vector> spread(const RCP<const Map>& map, const Eigen::VectorXd& values) {
  const auto result = make_vector(map);
  for (int i = 0; i < values.size(); ++i)
    if (map->isNodeGlobalElement(i))
      result->replaceGlobalValue(i, values[i]);
  return result;
}

/// Mobility of bodies in fluid: dense, far from the diagonal that one begins with.
Eigen::MatrixXd true_response() {
  Eigen::MatrixXd root(n_secant_dofs, n_secant_dofs);
  for (int i = 0; i < n_secant_dofs; ++i)
    for (int j = 0; j < n_secant_dofs; ++j)
      root(i, j) = std::sin(1. + 3 * i + 5 * j) + (i == j ? 1 : 0);
  return 0.01 * root * root.transpose();
}

TEST(SecantResponse, AnswersTheLastPushAsTheSolveDid) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = make_map(n_secant_dofs, comm);  // the group on rank 0, others beside
  std::vector<Triplet> first;
  for (const GlobalIndex id : map->getNodeElementList())
    for (int j = 0; j < n_secant_dofs; ++j)  // ties all dofs of the group a little
      if (id < n_secant_dofs)
        first.push_back({id, j, id == j ? 3. : 1e-3});
      else if (j == 0)
        first.push_back({id, id, 2});
  SecantResponse response(as_operator(assemble_triplets(std::move(first), map, map)));
  const Eigen::MatrixXd expected = true_response();
  for (int k = 0; k < n_secant_dofs; ++k) {
    const Eigen::VectorXd push = Eigen::VectorXd::Unit(n_secant_dofs, k) +
                                 0.3 * Eigen::VectorXd::Unit(n_secant_dofs, (k + 2) % 6);
    const auto impulse = spread(map, push), change = spread(map, expected * push);
    response.learn(*impulse, *change);
    Vector answer(map);
    apply(*response.current(), *impulse, answer);
    answer.update(-1, *change, 1);
    EXPECT_LT(answer.normInf(), 1e-13) << k;
  }
  const Eigen::MatrixXd learned =
      dense(assembled(response.current())).topLeftCorner(n_secant_dofs, n_secant_dofs);
  EXPECT_LT((learned - learned.transpose()).norm(), 1e-14);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(learned);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
}

// An answer against the impulse, as solves to a tolerance give where nothing moves, is not taken.
TEST(SecantResponse, StaysPositive) {
  const auto map = make_map(3, Tpetra::getDefaultComm());
  std::vector<Triplet> first;
  for (const GlobalIndex id : map->getNodeElementList())
    first.push_back({id, id, 2});
  SecantResponse response(as_operator(assemble_triplets(std::move(first), map, map)));
  const auto before = response.current();
  const Eigen::VectorXd push = Eigen::VectorXd::Unit(3, 1);
  response.learn(*spread(map, push), *spread(map, -push));
  EXPECT_EQ(response.current(), before);
}

}  // namespace
}  // namespace lockstep::test
