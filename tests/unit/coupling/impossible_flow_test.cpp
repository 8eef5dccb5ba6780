// Fluxes that may not be pushed into a closed region, and inaccuracies of the grid that may.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/impossible_flow.hpp"

namespace lockstep::test {
namespace {

constexpr int n_per_rank = 20;

/// One closed region of all cells.
struct Tank {
  Communicator comm = Tpetra::getDefaultComm();
  RCP<const Map> map = make_map(n_per_rank, comm);
  RCP<Vector> level = rcp(new Vector(map));

  Tank() { level->putScalar(1 / std::sqrt(map->getGlobalNumElements())); }
  std::string judge(const PrescribedFluxes& fluxes, GlobalIndex smallest = 9) const {
    return impossible_flow(null_space_of({level}), fluxes, smallest, 0, "m^2/s");
  }
  /// Makes a source on rank 0 alone; the last unknown is another rank's.
  PrescribedFlux source(const std::string& name, const std::vector<double>& rates) const {
    PrescribedFlux flux{name, {}};
    for (std::size_t k = 0; k < rates.size() && is_root(comm); ++k)
      flux.into.emplace_back(map->getMaxAllGlobalIndex() - static_cast<GlobalIndex>(k), rates[k]);
    return flux;
  }
};

TEST(ImpossibleFlow, NamesTheInflowAndItsRate) {
  const Tank tank;
  const std::string message =
      tank.judge({{tank.source("the inflow \"x lower\"", {0.25, 0.5})}, {}});
  EXPECT_NE(message.find("the inflow \"x lower\" pushes in 0.75 m^2/s"), std::string::npos)
      << message;
  EXPECT_NE(message.find(std::to_string(n_per_rank * tank.comm->getSize()) + " cells"),
            std::string::npos)
      << message;
  EXPECT_EQ(tank.judge({{tank.source("in", {0.25, 0.5}), tank.source("out", {-0.75})}, {}}), "");
  EXPECT_NE(tank.judge({{tank.source("in", {0.25, 0.5}), tank.source("out", {-0.7})}, {}}), "");
}

TEST(ImpossibleFlow, APistonPushesAndAStirrerDoesNot) {
  const Tank tank;
  EXPECT_NE(tank.judge({{}, {tank.source("the solid \"Piston\"", {0.1, 0.1, 0.1})}}), "");
  EXPECT_EQ(tank.judge({{}, {tank.source("the solid \"Stirrer\"", {1, -0.9, 1, -0.8})}}), "");
  // A stirrer does not hide an inflow, however strong it is.
  EXPECT_NE(tank.judge({{tank.source("in", {0.01})}, {tank.source("Stirrer", {9, -9.5})}}), "");
  // A piston of voxels gives way to what comes in, but for a tenth.
  EXPECT_EQ(tank.judge({{tank.source("in", {0.3})}, {tank.source("Piston", {-0.1, -0.19})}}), "");
  EXPECT_NE(tank.judge({{tank.source("in", {0.3})}, {tank.source("Piston", {-0.1, -0.1})}}), "");
}

TEST(ImpossibleFlow, PocketsOfTheGridAreLetBe) {
  const Tank tank;
  const PrescribedFluxes fluxes{{}, {tank.source("Piston", {1})}};
  EXPECT_EQ(tank.judge(fluxes, tank.map->getGlobalNumElements()), "");
  EXPECT_EQ(impossible_flow({}, fluxes, 9, 0, "m^2/s"), "");  // an open side
}

}  // namespace
}  // namespace lockstep::test
