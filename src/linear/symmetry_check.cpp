#include "linear/symmetry_check.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>
#include <random>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

struct Probe {
  Vector u, v, m_u, m_v;

  explicit Probe(const LinearOperator& op)
      : u(domain_map(op)), v(u.getMap()), m_u(u.getMap()), m_v(u.getMap()) {
    pseudo_random(u, 1);
    pseudo_random(v, 2);
    apply(op, u, m_u);
    apply(op, v, m_v);
  }
  double defect() const { return std::abs(u.dot(m_v) - v.dot(m_u)) / (u.norm2() * m_v.norm2()); }
};

}  // namespace

void pseudo_random(Vector& x, int seed) {
  const auto values = x.getDataNonConst();
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const auto id = static_cast<std::uint64_t>(x.getMap()->getGlobalElement(i));
    std::minstd_rand generator(static_cast<unsigned>(1 + (id * 7919 + seed * 104729) % 2147483000));
    generator.discard(3);
    values[i] = 2 * static_cast<double>(generator()) / std::minstd_rand::max() - 1;
  }
}

double symmetry_defect(const LinearOperator& op) {
  return Probe(op).defect();
}

void check_symmetric_positive(const LinearOperator& op, const std::string& name, double tolerance) {
  const Probe probe(op);
  const double defect = probe.defect();
  check_solve(defect < tolerance,
              "The preconditioner of the {} is not symmetric: |u.Mv - v.Mu| / (|u||Mv|) = {:.1e}. "
              "Choose a symmetric smoother (Chebyshev, symmetric Gauss-Seidel) and a coarse solver "
              "that is right on several ranks.",
              name, defect);
  const double energy = std::min(probe.u.dot(probe.m_u), probe.v.dot(probe.m_v));
  check_solve(energy > 0, "The preconditioner of the {} is not positive definite: v.Mv = {:.1e}.",
              name, energy);
}

}  // namespace lockstep
