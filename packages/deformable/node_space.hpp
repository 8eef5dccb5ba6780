#pragma once
#include <vector>

#include "deformable/elements/node_matrix.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// Divides nodes among ranks by METIS on the graph of nodes that share elements; the same on every
/// rank. Returns the rank of each node.
std::vector<int> partition_nodes(int n_nodes, const std::vector<ElementCorners>& elements,
                                 int n_parts);

/// The nodes of all bodies over the ranks. Each node has a number in the scene (`original`), a
/// number that counts rank by rank (`global`; dof = dim * global + axis), and on the ranks that see
/// it a local one: owned nodes first, then the ghosts, which are the other corners of elements that
/// touch owned nodes. Such elements are evaluated by every rank that owns one of their corners, in
/// the order of the scene, so that forces do not depend on the number of ranks.
template <int dim>
class NodeSpace {
 public:
  using Nodes = std::vector<Point<dim>>;
  NodeSpace() = default;
  /// `elements` in original numbers. Collective.
  NodeSpace(int n_nodes, const std::vector<ElementCorners>& elements, const Communicator& comm);

  int n_owned() const { return n_owned_; }
  int n_local() const { return static_cast<int>(originals_.size()); }
  int original(int local) const { return originals_[local]; }
  RCP<const Map> dof_map() const { return map_; }
  /// Global number of a local dof, dim * local + axis.
  GlobalIndex global_dof(int local_dof) const { return overlap_map_->getGlobalElement(local_dof); }

  /// Vectors on `dof_map` as one point a node: of the owned nodes, and (collective) of all local
  /// ones.
  Nodes owned(const Vector& values) const;
  Nodes with_ghosts(const Vector& values) const;
  RCP<Vector> vector(const Nodes& owned) const;  ///< entries beyond the owned ones are ignored

  /// The matrix of dofs of these blocks. Collective.
  RCP<const CrsMatrix> matrix(const NodeMatrix<dim>& blocks) const;

  /// Numbers of nodes by original number, for the set-up only: rank, global number, local number
  /// (-1: unseen).
  struct Numbers {
    std::vector<int> rank, global, local;
  };
  const Numbers& numbers() const { return numbers_; }
  void forget_numbers() { numbers_ = Numbers(); }

 private:
  int n_owned_ = 0;
  std::vector<int> originals_;
  RCP<const Map> map_, overlap_map_;
  RCP<const Import> import_;
  mutable RCP<const CrsMatrix> pattern_;  ///< pattern of the last matrix, reused by the next
  Numbers numbers_;
};

}  // namespace lockstep
