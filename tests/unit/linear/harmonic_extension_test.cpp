// Harmonic extension over a graph: linear along a chain between two unknowns, the mean at a star.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/harmonic_extension.hpp"

namespace lockstep::test {

namespace {
/// Unknowns 0, 1, ...: two on each rank.
RCP<const Map> two_a_rank() {
  return make_map(2, Tpetra::getDefaultComm());
}

/// Nodes 0 to n - 1 in a row between two unknowns.
HangingGraph chain(int n, GlobalIndex first, GlobalIndex last) {
  HangingGraph graph;
  graph.n_nodes = n;
  for (int node = 0; node + 1 < n; ++node)
    graph.links.push_back({node, node + 1});
  graph.rim = {{0, first}, {n - 1, last}};
  return graph;
}
}  // namespace

TEST(HarmonicExtension, IsLinearAlongAChain) {
  const auto map = two_a_rank();
  const GlobalIndex last = map->getMaxAllGlobalIndex();
  Vector x(map);
  x.putScalar(100);
  if (map->isNodeGlobalElement(0))
    x.replaceGlobalValue(0, 3);
  if (map->isNodeGlobalElement(last))
    x.replaceGlobalValue(last, 9);
  const HarmonicExtension extension(chain(5, 0, last), map);
  const std::vector<double> values = extension.extended(x);
  for (int node = 0; node < 5; ++node)
    EXPECT_NEAR(values[node], 4 + node, 1e-13);
}

TEST(HarmonicExtension, DrainsByTheSameWeights) {
  const auto map = two_a_rank();
  const GlobalIndex last = map->getMaxAllGlobalIndex();
  const HarmonicExtension extension(chain(3, 0, last), map);
  Vector result(map);
  const int n_ranks = map->getComm()->getSize();
  extension.add_drained({1, 0, 0.5}, result);  // on every rank
  const auto expect = [&](GlobalIndex unknown, double value) {
    if (const int local = map->getLocalElement(unknown); local >= 0) {
      EXPECT_NEAR(result.getData()[local], n_ranks * value, 1e-13);
    }
  };
  expect(0, 0.75 + 0.125);
  expect(last, 0.25 + 0.375);
}

// A node between an unknown and the ground has half of it; one that hangs on nothing has zero.
TEST(HarmonicExtension, KnowsTheGroundAndWhatHangsOnNothing) {
  HangingGraph graph;
  graph.n_nodes = 3;
  graph.rim = {{0, 1}, {0, no_index}};
  graph.links = {{1, 2}};
  const HarmonicExtension extension(graph, two_a_rank());
  const std::vector<double> values = extension.extended(std::vector<double>{8, 0});
  EXPECT_NEAR(values[0], 4, 1e-14);
  EXPECT_EQ(values[1], 0);
  double drained = 0;
  for (const auto& [unknown, value] : extension.drained({1, 1, 1}))
    drained += value;
  EXPECT_NEAR(drained, 0.5, 1e-14);
}

}  // namespace lockstep::test
