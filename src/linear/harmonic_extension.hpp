#pragma once
#include <memory>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// A graph that hangs on unknowns at its rim: nodes, links between them, and links to unknowns or
/// to the ground, where the value is zero. The same on all ranks.
struct HangingGraph {
  struct Link {
    int node = 0, other = 0;
  };
  struct RimLink {
    int node = 0;
    GlobalIndex unknown = no_index;  ///< id in the map of the unknowns; no_index: the ground
  };
  int n_nodes = 0;
  std::vector<Link> links;  ///< each once
  std::vector<RimLink> rim;
};

/// The harmonic extension E of a vector to the nodes of such a graph: each node has the mean of
/// what it is linked with. Nodes that no rim reaches have zero. Every rank factors the whole graph,
/// so that it is for small ones.
class HarmonicExtension {
 public:
  /// `map`: that of the unknowns.
  HarmonicExtension(HangingGraph graph, RCP<const Map> map);
  ~HarmonicExtension();

  int n_nodes() const { return graph_.n_nodes; }
  /// E x, by node. Collective.
  std::vector<double> extended(const Vector& x) const;
  /// E of values that are given link by link of the rim; those of the ground count. Local.
  std::vector<double> extended(const std::vector<double>& at_rim) const;
  /// Returns E^T of values at nodes as (unknown, value), unknowns of other ranks too. Local.
  std::vector<std::pair<GlobalIndex, double>> drained(const std::vector<double>& at_nodes) const;
  /// result += E^T (sum over ranks of the values at nodes). Collective.
  void add_drained(std::vector<double> at_nodes, Vector& result) const;

 private:
  struct Factor;
  HangingGraph graph_;
  RCP<const Map> map_;
  std::unique_ptr<const Factor> factor_;
};

}  // namespace lockstep
