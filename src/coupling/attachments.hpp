#pragma once
#include <map>
#include <memory>
#include <vector>

#include "interfaces/solid.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

/// Nodes that rigid solids carry: their dofs are no unknowns but combinations of the solids',
/// V = P V_reduced. Forces go the other way, q_reduced = P^T q, so that linear and angular momentum
/// are kept exactly. Reduced vectors are zero on the dofs of attached nodes, reduced matrices have
/// a row of the identity there. The nodes are replicated on all ranks.
template <int dim>
class Attachments {
 public:
  /// An attached node, in ids of the stacked map and numbers of all solids.
  struct Node {
    std::array<GlobalIndex, dim> dofs;
    int solid = -1;       ///< that carries it
    int model = -1;       ///< that it belongs to
    Point<dim> position;  ///< [m]
  };

  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Does any node belong to this model?
  bool holds_model(int model) const;
  /// `rows`: of each node, the velocity of its solid at its position.
  void set(std::vector<Node> nodes, const std::vector<VelocityRow<dim>>& rows);

  /// True if the velocity of some node is a combination with this dof. Local.
  bool is_carrier(GlobalIndex dof) const { return carriers_.count(dof) > 0; }
  /// Local.
  void reduce(VelocityRow<dim>& row) const;
  /// P^T K P + identity on the attached dofs of `map`. Local.
  void reduce(std::vector<Triplet>& triplets, const Map& map) const;
  /// q := P^T q. Collective.
  void reduce_momentum(Vector& momentum) const;
  /// V := P V. Collective.
  void expand_velocity(Vector& velocity) const;
  /// Zero on the attached dofs. Local.
  void mask(Vector& values) const;

 private:
  using Combination = std::vector<std::pair<GlobalIndex, double>>;
  /// The combination of a dof: itself, if it is not attached.
  Combination combination(GlobalIndex dof) const;

  std::vector<Node> nodes_;
  std::map<GlobalIndex, Combination> rows_;      ///< of each attached dof
  std::map<GlobalIndex, std::size_t> carriers_;  ///< the dofs they are combinations of, counted
};

/// Where a model begins in the stack of all solids.
struct ModelBegin {
  int simplex = 0;     ///< in the surface of all
  GlobalIndex id = 0;  ///< in the map of all unknowns
  int local = 0;       ///< among this rank's rows
};

/// The attached nodes of all models and ranks at their present positions. Throws InputError if one
/// names a solid that is not rigid and dynamic. Collective.
template <int dim>
Attachments<dim> find_attachments(const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
                                  const std::vector<ModelBegin>& begin,
                                  const std::vector<SolidDescription>& solids,
                                  const Communicator& comm);

}  // namespace lockstep
