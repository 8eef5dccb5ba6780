#pragma once
#include <algorithm>
#include <array>
#include <memory>

#include "contact/bodies/inverse_mass.hpp"

namespace lockstep {

/// Numbers that are appended to many lists in turn: in pieces of one size, which leave no holes in
/// the memory as vectors do that grow side by side.
class GrowingColumn {
 public:
  double operator[](int place) const { return (*pieces_[place / n_each])[place % n_each]; }
  void push_back(double value) {
    if (size_ % n_each == 0)
      pieces_.push_back(std::make_unique<std::array<double, n_each>>());
    (*pieces_.back())[size_++ % n_each] = value;
  }
  /// result[k] += factor * [k]; for as many as there are.
  void add_to(std::vector<double>& result, double factor) const {
    for (int begin = 0; begin < size_; begin += n_each) {
      const double* piece = pieces_[begin / n_each]->data();
      const int n = std::min(n_each, size_ - begin);
      for (int k = 0; k < n; ++k)
        result[begin + k] += factor * piece[k];
    }
  }

 private:
  static constexpr int n_each = 256;
  std::vector<std::unique_ptr<std::array<double, n_each>>> pieces_;
  int size_ = 0;
};

/// The velocities that unit impulses on dofs make: M_S^-1, or the response of solids whose inner
/// forces are implicit. An impulse on the latter moves the whole body. Responses are kept only
/// between the dofs that contacts have asked for, which become *active* in the order of asking: all
/// other velocities take one solve for all impulses together. Replicated; every rank must ask for
/// the same dofs in the same order.
template <int dim>
class Mobility {
 public:
  using Row = std::vector<std::pair<int, double>>;

  explicit Mobility(const InverseMass& inverse_mass) : inverse_mass_(inverse_mass) {}
  /// `response` on the free dofs; `inverse_mass` tells which dofs are free.
  Mobility(const InverseMass& inverse_mass, const SolidSystem<dim>& system,
           RCP<const LinearOperator> response);

  bool is_held(int dof) const { return inverse_mass_.rows[dof].empty(); }
  /// The operator, or null.
  const RCP<const LinearOperator>& response() const { return response_; }

  /// Without a response: a row of M_S^-1, dofs and velocities; empty for held dofs. Local.
  const Row& row(int dof) const { return inverse_mass_.rows[dof]; }

  /// With a response: the number of a dof, which is not held, among the active ones. Collective if
  /// it is a new one: one solve.
  int activate(int dof);
  int n_active() const { return static_cast<int>(active_.size()); }
  int active_dof(int number) const { return active_[number]; }
  /// Velocities of all active dofs that a unit impulse on one of them makes.
  const GrowingColumn& column(int number) const { return columns_[number]; }
  /// Returns the velocities of all dofs for impulses on all dofs, of which held ones take none.
  /// Collective.
  std::vector<double> velocities(std::vector<double> impulses) const;

 private:
  const InverseMass& inverse_mass_;
  const SolidSystem<dim>* system_ = nullptr;
  RCP<const LinearOperator> response_;
  std::vector<int> number_;  ///< number of each dof; -1: not active
  std::vector<int> active_;
  std::vector<GrowingColumn> columns_;
};

}  // namespace lockstep
