#pragma once
#include "linear/types.hpp"

namespace lockstep {

/// The response of solids in contact, velocities from impulses, which learns from what coupled
/// solves have answered: a BFGS update of the inverse makes it exact for the last such pair, and
/// keeps it symmetric and positive definite. It matters where the fluid is most of the mass, as
/// around light bodies.
class SecantResponse {
 public:
  /// `first`: symmetric positive definite, with an assembled matrix behind.
  explicit SecantResponse(RCP<const LinearOperator> first) : current_(std::move(first)) {}

  const RCP<const LinearOperator>& current() const { return current_; }
  /// More `impulse` on the solids has changed their velocities by `change`. Only dofs that the
  /// present response ties to the impulse take part, and not more than 96. Collective.
  void learn(const Vector& impulse, const Vector& change);

 private:
  RCP<const LinearOperator> current_;
};

}  // namespace lockstep
