#include "linear/harmonic_extension.hpp"

#include <Eigen/SparseLU>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include "base/communicator.hpp"
#include "base/disjoint_sets.hpp"

namespace lockstep {

struct HarmonicExtension::Factor {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> laplacian;
};

namespace {
/// By node: does a link lead it, through other nodes or at once, to the rim?
std::vector<char> reached_from_rim(const HangingGraph& graph) {
  DisjointSets parts(graph.n_nodes);
  for (const auto& [node, other] : graph.links)
    parts.join(node, other);
  std::vector<char> has_rim(graph.n_nodes, 0);
  for (const auto& link : graph.rim)
    has_rim[parts.root(link.node)] = 1;
  std::vector<char> reached(graph.n_nodes);
  for (int node = 0; node < graph.n_nodes; ++node)
    reached[node] = has_rim[parts.root(node)];
  return reached;
}
}  // namespace

HarmonicExtension::HarmonicExtension(HangingGraph graph, RCP<const Map> map)
    : graph_(std::move(graph)), map_(std::move(map)) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [node, other] : graph_.links) {
    entries.emplace_back(node, node, 1);
    entries.emplace_back(other, other, 1);
    entries.emplace_back(node, other, -1);
    entries.emplace_back(other, node, -1);
  }
  for (const auto& link : graph_.rim)
    entries.emplace_back(link.node, link.node, 1);
  const std::vector<char> reached = reached_from_rim(graph_);
  for (int node = 0; node < graph_.n_nodes; ++node)
    if (!reached[node])
      entries.emplace_back(node, node, 1);  // regular, and zero: nothing is given there
  Eigen::SparseMatrix<double> laplacian(graph_.n_nodes, graph_.n_nodes);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  auto factor = std::make_unique<Factor>();
  factor->laplacian.compute(laplacian);
  factor_ = std::move(factor);
}

HarmonicExtension::~HarmonicExtension() = default;

std::vector<double> HarmonicExtension::extended(const std::vector<double>& at_rim) const {
  Eigen::VectorXd given = Eigen::VectorXd::Zero(graph_.n_nodes);
  for (std::size_t k = 0; k < graph_.rim.size(); ++k)
    given[graph_.rim[k].node] += at_rim[k];
  const Eigen::VectorXd values = factor_->laplacian.solve(given);
  return {values.begin(), values.end()};
}

std::vector<double> HarmonicExtension::extended(const Vector& x) const {
  std::vector<double> at_rim(graph_.rim.size(), 0);
  const auto values = x.getData();
  for (std::size_t k = 0; k < graph_.rim.size(); ++k)
    if (const GlobalIndex unknown = graph_.rim[k].unknown;
        unknown != no_index && map_->isNodeGlobalElement(unknown))
      at_rim[k] = values[map_->getLocalElement(unknown)];
  sum_over_ranks(map_->getComm(), at_rim);
  return extended(at_rim);
}

std::vector<std::pair<GlobalIndex, double>> HarmonicExtension::drained(
    const std::vector<double>& at_nodes) const {
  const Eigen::Map<const Eigen::VectorXd> given(at_nodes.data(), graph_.n_nodes);
  const Eigen::VectorXd values = factor_->laplacian.solve(given);
  std::vector<std::pair<GlobalIndex, double>> result;
  for (const auto& link : graph_.rim)
    if (link.unknown != no_index)
      result.emplace_back(link.unknown, values[link.node]);
  return result;
}

void HarmonicExtension::add_drained(std::vector<double> at_nodes, Vector& result) const {
  sum_over_ranks(map_->getComm(), at_nodes);
  for (const auto& [unknown, value] : drained(at_nodes))
    if (map_->isNodeGlobalElement(unknown))
      result.sumIntoGlobalValue(unknown, value);
}

}  // namespace lockstep
