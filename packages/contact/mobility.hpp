#pragma once
#include <optional>

#include "contact/contact_shapes.hpp"
#include "contact/inverse_mass.hpp"

namespace lockstep {

/// The velocities that unit impulses on dofs make: M_S^-1, or the response of solids whose inner
/// forces are implicit. Of those an impulse moves the whole body, so their rows are found when a
/// contact asks for them. Replicated; every rank must ask for the same rows in the same order.
template <int dim>
class Mobility {
 public:
  using Row = std::vector<std::pair<int, double>>;

  explicit Mobility(const InverseMass& inverse_mass) : inverse_mass_(inverse_mass) {}
  /// `response` on the free dofs; rows hold only dofs that surfaces move with. `inverse_mass` tells
  /// which dofs are free.
  Mobility(const InverseMass& inverse_mass, const SolidSystem<dim>& system,
           const ContactShapes<dim>& shapes, RCP<const LinearOperator> response);

  /// Ids and velocities; empty for held dofs. Collective if there is a response.
  const Row& row(int dof);
  /// The operator, or null.
  const RCP<const LinearOperator>& response() const { return response_; }

 private:
  const InverseMass& inverse_mass_;
  const SolidSystem<dim>* system_ = nullptr;
  RCP<const LinearOperator> response_;
  std::vector<int> surface_dofs_;
  std::vector<std::optional<Row>> rows_;
};

}  // namespace lockstep
