#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/reduction.hpp"
#include "interfaces/solid.hpp"

namespace lockstep {

/// Place at which a model begins in the stack of all solids.
struct ModelBegin {
  int simplex = 0;     ///< in the surface of all
  GlobalIndex id = 0;  ///< in the map of all unknowns
  int local = 0;       ///< among this rank's rows
};

/// A node of this rank that a rigid solid of another model carries, in ids of the stacked map and
/// numbers of all solids.
template <int dim>
struct AttachedNode {
  std::array<GlobalIndex, dim> dofs;
  int model = -1;       ///< model of the node
  int solid = -1;       ///< solid that carries it
  Point<dim> position;  ///< present [m]
};

/// Sentence about an end of `line`, or about nodes if that is empty, that is attached to a `solid`
/// which cannot carry it. `carriers`: names of those that can.
std::string no_carrier(const std::string& solid, const std::string& line,
                       const std::vector<std::string>& carriers);

/// Returns the attached nodes of this rank at their present positions; `failure` gets a sentence if
/// one names a solid that is not rigid and dynamic. Local.
template <int dim>
std::vector<AttachedNode<dim>> find_attached_nodes(
    const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
    const std::vector<ModelBegin>& begin, const std::vector<SolidDescription>& solids,
    std::string& failure);

/// Makes the row of a point of a rigid solid that is not prescribed, whether it has a surface or
/// not, in ids of the stacked map. Replaces `row`. Local.
template <int dim>
void rigid_row(const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
               const std::vector<ModelBegin>& begin, const SolidDescription& solid,
               const Point<dim>& x, VelocityRow<dim>& row);

/// The velocities of nodes as those of their solids where they are. Local.
template <int dim>
std::vector<Combination> combinations_of(
    const std::vector<AttachedNode<dim>>& nodes,
    const std::vector<std::unique_ptr<SolidModel<dim>>>& models,
    const std::vector<ModelBegin>& begin, const std::vector<SolidDescription>& solids);

}  // namespace lockstep
