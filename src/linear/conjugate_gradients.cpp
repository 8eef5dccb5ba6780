#include "linear/conjugate_gradients.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

namespace {

/// x += step d, r -= step q; returns r.r of this rank: one pass over the four vectors.
double advance(double step, const Vector& d, const Vector& q, Vector& x, Vector& r) {
  const auto d_values = d.getData(), q_values = q.getData();
  const auto x_values = x.getDataNonConst(), r_values = r.getDataNonConst();
  const double* d_data = d_values.getRawPtr();
  const double* q_data = q_values.getRawPtr();
  double* x_data = x_values.getRawPtr();
  double* r_data = r_values.getRawPtr();
  double sum = 0;
  for (std::ptrdiff_t i = 0; i < d_values.size(); ++i) {
    x_data[i] += step * d_data[i];
    r_data[i] -= step * q_data[i];
    sum += r_data[i] * r_data[i];
  }
  return sum;
}

}  // namespace

int conjugate_gradients(const Action& op, const Action& preconditioner, const Vector& rhs,
                        Vector& x, const ConjugateGradientsRequest& request) {
  const auto map = rhs.getMap();
  const Communicator comm = map->getComm();
  Vector r(rhs, Teuchos::Copy), z(map), d(map), q(map);
  x.putScalar(0);
  double r_norm = r.norm2();
  double r_dot_z = 0;
  int iteration = 0;
  double target = request.target;
  while (r_norm > target && iteration < request.maximum_iterations) {
    preconditioner(r, z);
    project_out(request.null_space, z);
    const double previous = r_dot_z;
    r_dot_z = r.dot(z);
    check_solve(
        std::isfinite(r_dot_z) && r_dot_z > 0,
        "{}: the preconditioner is not positive definite (r . M r = {:.3e} in iteration {}, "
        "|r| = {:.3e}). Choose another sub-block inverse.",
        request.name, r_dot_z, iteration, r_norm);
    d.update(1, z, iteration == 0 ? 0 : r_dot_z / previous);
    op(d, q);
    const double curvature = d.dot(q);
    check_solve(
        std::isfinite(curvature) && curvature > 0,
        "{}: the operator is not positive definite (d . S d = {:.3e} in iteration {}, |r| = "
        "{:.3e}). A singular system needs its null vectors.",
        request.name, curvature, iteration, r_norm);
    r_norm = std::sqrt(sum_all(comm, advance(r_dot_z / curvature, d, q, x, r)));
    ++iteration;
    if (r_norm <= target && request.update_target)
      target = std::min(target, request.update_target(x));
  }
  return iteration;
}

}  // namespace lockstep
