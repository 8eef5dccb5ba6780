// Our MINRES-QLP against hand, against Eigen's pseudo-inverse, and against Belos' MINRES.
#include <gtest/gtest.h>

#include <BelosSolverManager.hpp>
#include <BelosThyraAdapter.hpp>
#include <Eigen/Dense>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Tpetra_Core.hpp>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "solve/belos_solvers.hpp"
#include "solve/minres.hpp"
#include "solve/preconditioner.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/thyra_vectors.hpp"

namespace lockstep::test {
namespace {

/// A dense symmetric operator on a vector spread over the ranks.
struct DenseProblem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, inverse_preconditioner;
  RCP<const Map> map;

  explicit DenseProblem(Eigen::MatrixXd matrix, Eigen::VectorXd rhs)
      : a(std::move(matrix)), b(std::move(rhs)) {
    const Communicator comm = Tpetra::getDefaultComm();
    const int n = static_cast<int>(b.size()), rank = comm->getRank(), ranks = comm->getSize();
    map = make_map((rank + 1) * n / ranks - rank * n / ranks, comm);
    inverse_preconditioner = Eigen::VectorXd::Ones(n);
  }
  Eigen::VectorXd gathered(const Vector& x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(b.size());
    const auto mine = x.getData();
    for (int i = 0; i < static_cast<int>(mine.size()); ++i)
      all[map->getGlobalElement(i)] = mine[i];
    sum_all(map->getComm(), all.data(), static_cast<int>(all.size()));
    return all;
  }
  void scatter(const Eigen::VectorXd& all, Vector& x) const {
    const auto mine = x.getDataNonConst();
    for (int i = 0; i < static_cast<int>(mine.size()); ++i)
      mine[i] = all[map->getGlobalElement(i)];
  }
  MinresReport solve(Eigen::VectorXd& x, double target, double transition = 1e7) const {
    Blocks rhs{make_vector(map)}, solution{make_vector(map)};
    scatter(b, *rhs[0]);
    scatter(x, *solution[0]);
    MinresRequest request;
    request.name = "test";
    request.targets = {target};
    request.maximum_iterations = 40 * static_cast<int>(b.size());
    request.transition_condition = transition;
    const auto report =
        minres([this](const Blocks& u, Blocks& v) { scatter(a * gathered(*u[0]), *v[0]); },
               [this](const Blocks& u, Blocks& v) {
                 scatter(inverse_preconditioner.cwiseProduct(gathered(*u[0])), *v[0]);
               },
               rhs, solution, request);
    x = gathered(*solution[0]);
    return report;
  }
};

/// Eigenvalues in a fixed random basis.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values) {
  const auto n = values.size();
  Eigen::MatrixXd seed(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      seed(i, j) = std::sin(1.0 + 7.3 * static_cast<double>(i) + 3.1 * static_cast<double>(j * j));
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(seed).householderQ();
  return q * values.asDiagonal() * q.transpose();
}

TEST(Minres, TwoByTwoByHand) {
  // [2 1; 1 -1] x = (3, 0): x = (1, 1).
  DenseProblem problem((Eigen::MatrixXd(2, 2) << 2, 1, 1, -1).finished(), Eigen::Vector2d(3, 0));
  for (const double transition : {1e7, 1.0}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
    const auto report = problem.solve(x, 1e-13, transition);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.n_iterations, 2);
    EXPECT_NEAR(x[0], 1, 1e-14);
    EXPECT_NEAR(x[1], 1, 1e-14);
  }
}

TEST(Minres, AnExactGuessTakesNoIteration) {
  DenseProblem problem((Eigen::MatrixXd(2, 2) << 2, 1, 1, -1).finished(), Eigen::Vector2d(3, 0));
  Eigen::VectorXd x = Eigen::Vector2d(1, 1);
  const auto report = problem.solve(x, 1e-15);
  EXPECT_EQ(report.n_iterations, 0);
  EXPECT_TRUE(report.converged);
}

TEST(Minres, IndefiniteWithBothUpdates) {
  const int n = 24;
  const Eigen::VectorXd values =
      Eigen::VectorXd::LinSpaced(n, -3, 5).unaryExpr([](double v) { return v + 0.1; });
  const Eigen::MatrixXd a = with_eigenvalues(values);
  const Eigen::VectorXd exact = Eigen::VectorXd::LinSpaced(n, 1, 2);
  DenseProblem problem(a, a * exact);
  for (const double transition : {1e15, 5.0, 1.0}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const auto report = problem.solve(x, 1e-11 * problem.b.norm(), transition);
    EXPECT_TRUE(report.converged) << transition;
    EXPECT_LE(report.n_iterations, n + 2);
    EXPECT_LT((x - exact).norm(), 1e-9 * exact.norm()) << transition;
    EXPECT_EQ(report.n_qlp_iterations > 0, transition < 1e15);
  }
}

TEST(Minres, TheLeastOfASingularSystemsSolutions) {
  const int n = 20;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(n, -2, 3);
  values[3] = values[11] = 0;
  const Eigen::MatrixXd a = with_eigenvalues(values);
  const Eigen::VectorXd b = a * Eigen::VectorXd::LinSpaced(n, 1, 2);
  DenseProblem problem(a, b);
  const Eigen::VectorXd least = a.completeOrthogonalDecomposition().solve(b);
  for (const double transition : {1e7, 1.0}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    EXPECT_TRUE(problem.solve(x, 1e-11 * b.norm(), transition).converged);
    EXPECT_LT((x - least).norm(), 1e-8 * least.norm());
  }
}

TEST(Minres, LeastSquaresOfAnIncompatibleSystem) {
  const int n = 16;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(n, -1.5, 2);
  values[5] = 0;
  const Eigen::MatrixXd a = with_eigenvalues(values);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 3);
  DenseProblem problem(a, b);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  const auto report = problem.solve(x, 1e-11 * b.norm(), 1.0);
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.is_least_squares);
  const Eigen::MatrixXd pseudo = a.completeOrthogonalDecomposition().pseudoInverse();
  EXPECT_LT((a * (b - a * x)).norm(), 1e-7 * b.norm());
  EXPECT_LT((x - pseudo * b).norm(), 1e-5 * (pseudo * b).norm());
}

TEST(Minres, QlpKeepsDigitsThatMinresLoses) {
  const int n = 30;
  const Eigen::VectorXd exponents = Eigen::VectorXd::LinSpaced(n, -9, 0);
  Eigen::VectorXd values = exponents.unaryExpr([](double e) { return std::pow(10.0, e); });
  for (int i = 0; i < n; i += 2)
    values[i] = -values[i];
  const Eigen::MatrixXd a = with_eigenvalues(values);
  DenseProblem problem(a, a * Eigen::VectorXd::Ones(n));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  // The residual is down before the least eigenvalue, 1e-9, is seen; by how much round-off decides.
  const auto report = problem.solve(x, 1e-12 * problem.b.norm(), 1e5);
  EXPECT_GT(report.condition, 1e6);
  EXPECT_GT(report.n_qlp_iterations, 0);
  EXPECT_LT(report.residuals[0], 1e-8 * problem.b.norm());
}

TEST(Minres, AnIndefinitePreconditionerIsAnError) {
  DenseProblem problem(with_eigenvalues(Eigen::VectorXd::LinSpaced(6, -1, 2)),
                       Eigen::VectorXd::Ones(6));
  problem.inverse_preconditioner = -Eigen::VectorXd::Ones(6);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
  EXPECT_THROW(problem.solve(x, 1e-10), SolveError);
}

/// Eq. 16 by the named Belos solver; returns iterations and the solution.
std::pair<int, BlockVector> solve_by(const std::string& name, const SaddleProblem& problem,
                                     const BlockVector& rhs) {
  const auto op = block_operator(problem.system);
  Teuchos::ParameterList jacobi;
  jacobi.set("Type", "Jacobi");
  const auto preconditioner = Thyra::block2x2<double>(
      preconditioner_from_list(problem.system.pressure.op, jacobi, "A"), Teuchos::null,
      Teuchos::null, exact_inverse(problem.system.solids.op, "C"));
  BlockVector x = problem.zero();
  const BlockVector b = signed_rhs(rhs);
  using Vectors = Thyra::MultiVectorBase<double>;
  const auto linear = Teuchos::rcp(new Belos::LinearProblem<double, Vectors, LinearOperator>(
      op, Teuchos::rcp_implicit_cast<Vectors>(as_thyra(x, *op)),
      Teuchos::rcp_implicit_cast<const Vectors>(as_thyra(b, *op))));
  linear->setLeftPrec(preconditioner);
  linear->setProblem();
  const auto list = Teuchos::parameterList();
  list->set("Convergence Tolerance", 1e-9);
  list->set("Maximum Iterations", 500);
  const auto solver = belos_solver(name, list);
  solver->setProblem(linear);
  solver->solve();
  return {solver->getNumIters(), x};
}

TEST(Minres, AgreesWithBelos) {
  for (const bool open_top : {true, false}) {
    SaddleOptions options;
    options.open_top = open_top;
    const SaddleProblem problem(Tpetra::getDefaultComm(), options);
    const BlockVector rhs = problem.random_rhs();
    auto [ours, mine] = solve_by("Lockstep MINRES", problem, rhs);
    auto [theirs, reference] = solve_by("MINRES", problem, rhs);
    project_out(problem.system.null_space, *mine.pressure);
    project_out(problem.system.null_space, *reference.pressure);
    // They stop by different norms; this close the one goes on where the other stops.
    EXPECT_NEAR(ours, theirs, 0.15 * theirs);
    mine.pressure->update(-1, *reference.pressure, 1);
    mine.solid->update(-1, *reference.solid, 1);
    EXPECT_LT(mine.pressure->norm2(), 1e-5 * reference.pressure->norm2());
    EXPECT_LT(mine.solid->norm2(), 1e-5 * reference.solid->norm2());
  }
}

TEST(Minres, BadParametersOfTheManager) {
  const auto list = Teuchos::parameterList();
  list->set("Convergence Tolerence", 1e-9);
  EXPECT_THROW(belos_solver("Lockstep MINRES", list), InputError);
  EXPECT_THROW(belos_solver("MINRESS", Teuchos::null), InputError);
}

}  // namespace
}  // namespace lockstep::test
