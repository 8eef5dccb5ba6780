// Where conjugate gradients end: at the target, at round-off, or with an error.
#include <gtest/gtest.h>

#include <limits>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/vector_sums.hpp"

namespace lockstep::test {

namespace {

constexpr int n_rows = 32;

/// All rows on rank 0: the others own none.
RCP<const Map> ring() {
  const Communicator comm = Tpetra::getDefaultComm();
  return make_map(is_root(comm) ? n_rows : 0, comm);
}

/// Second differences round a ring, with the constants as null vectors, times `sign`.
Action ring_laplacian(double sign) {
  return [sign](const Vector& x, Vector& y) {
    const auto from = x.getData();
    const auto to = y.getDataNonConst();
    const int n = static_cast<int>(from.size());
    for (int i = 0; i < n; ++i)
      to[i] = sign * (2 * from[i] - from[(i + 1) % n] - from[(i + n - 1) % n]);
  };
}

/// The identity, but of the mean 10^8 times as much: what an inverse of a singular operator may do.
void amplify_mean(const Vector& r, Vector& z) {
  double mean = 0;
  for (const double value : r.getData())
    mean += value / n_rows;
  const auto from = r.getData();
  const auto to = z.getDataNonConst();
  for (int i = 0; i < from.size(); ++i)
    to[i] = from[i] + 1e8 * mean;
}

RCP<Vector> wave(const RCP<const Map>& map) {
  const auto rhs = make_vector(map);
  const auto values = rhs->getDataNonConst();
  for (int i = 0; i < values.size(); ++i)
    values[i] = std::sin(0.3 + i * i) - std::sin(0.3 + (i + 1) % n_rows * ((i + 1) % n_rows));
  return rhs;
}

}  // namespace

TEST(ConjugateGradients, RefuseARightHandSideThatIsNoNumber) {
  const auto map = ring();
  Vector x(map), rhs(map);
  rhs.putScalar(std::numeric_limits<double>::quiet_NaN());
  const Action plain = [](const Vector& r, Vector& z) { z.assign(r); };
  EXPECT_THROW(conjugate_gradients(ring_laplacian(1), plain, rhs, x, {}), SolveError);
}

TEST(ConjugateGradients, EndAtRoundOffWhereTheTargetIsBelowIt) {
  const auto map = ring();
  const auto rhs = wave(map);
  Vector x(map), residual(*rhs, Teuchos::Copy), image(map);
  // Round-off has left a mean in the right-hand side, which no x can make.
  if (map->getNodeNumElements() > 0)
    rhs->sumIntoLocalValue(3, 1e-15);
  const Action op = ring_laplacian(1);
  const int iterations = conjugate_gradients(op, amplify_mean, *rhs, x, {"ring", 1e-30, 500, {}});
  EXPECT_LT(iterations, 100);
  op(x, image);
  residual.update(-1, image, 1);
  EXPECT_LT(norm(residual), 1e-8 * norm(*rhs));
}

TEST(ConjugateGradients, RefuseAnOperatorThatIsNotPositive) {
  const auto map = ring();
  const auto rhs = wave(map);
  Vector x(map);
  EXPECT_THROW(
      conjugate_gradients(ring_laplacian(-1), amplify_mean, *rhs, x, {"ring", 1e-10, 500, {}}),
      SolveError);
}

}  // namespace lockstep::test
